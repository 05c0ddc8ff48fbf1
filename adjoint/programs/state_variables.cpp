#include "hbar/adjoint/programs/state_variables.h"

#include "hbar/core/base/error.h"

namespace hbar {

std::vector<std::string> state_names(const Model& model) {
  std::vector<std::string> out;
  for (const char* what : {"", " rate"}) {
    for (int c = 0; c < model.dof(); ++c) {
      out.push_back(concat(model.coordinate_name(c), what));
    }
  }
  return out;
}

Eigen::VectorXd state_scale(const TrajectoryProblem& problem) {
  const Eigen::Index dof = problem.horizon.model().dof();
  const Eigen::VectorXd q = filled(problem.q_scale, dof, 1.0, "q_scale");
  const Eigen::VectorXd qdot = filled(problem.qdot_scale, dof, 1.0, "qdot_scale");
  Eigen::VectorXd out(2 * dof);
  out << q, qdot;
  return out;
}

Eigen::VectorXd filled(const Eigen::VectorXd& vector, Eigen::Index count, double value,
                       const char* name) {
  if (vector.size() == 0) {
    return Eigen::VectorXd::Constant(count, value);
  }
  if (vector.size() != count) {
    throw InvalidInput(concat("TrajectoryProblem: ", name, " has ", vector.size(),
                              " entries; it must have ", count));
  }
  return vector;
}

}  // namespace hbar
