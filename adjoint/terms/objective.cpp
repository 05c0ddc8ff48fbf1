#include "hbar/adjoint/terms/objective.h"

#include "hbar/core/base/error.h"

namespace hbar {

TrajectoryPartials::TrajectoryPartials(const TrajectoryValues& shape)
    : Measured{Eigen::MatrixXd::Zero(shape.measured.rows(), shape.measured.cols()),
               shape.measured_rows},
      q(Eigen::MatrixXd::Zero(shape.q.rows(), shape.q.cols())),
      qdot(Eigen::MatrixXd::Zero(shape.qdot.rows(), shape.qdot.cols())),
      u(Eigen::MatrixXd::Zero(shape.u.rows(), shape.u.cols())),
      p(Eigen::VectorXd::Zero(shape.p.size())) {}

std::vector<SecondPlace> ObjectiveTerm::second_places(const TrajectoryValues&) const {
  throw InvalidInput(concat("objective term '", name(),
                            "' has no second partials; give them, or use the limited-memory "
                            "Hessian"));
}

void ObjectiveTerm::second_partials(const TrajectoryValues& values,
                                    Eigen::Ref<Eigen::VectorXd>) const {
  static_cast<void>(second_places(values));  // says so
}

double Objective::value(const TrajectoryValues& values) const {
  double sum = 0.0;
  for (const auto& term : terms_) {
    const double value = term->value(values);
    if (!std::isfinite(value)) {
      throw NumericalFailure(concat("objective term '", term->name(), "' is ", value));
    }
    sum += value;
  }
  return sum;
}

TrajectoryPartials Objective::partials(const TrajectoryValues& values) const {
  TrajectoryPartials sum(values);
  for (const auto& term : terms_) {
    term->add_partials(values, sum);
    if (!sum.q.allFinite() || !sum.qdot.allFinite() || !sum.measured.allFinite() ||
        !sum.u.allFinite() || !sum.p.allFinite()) {
      throw NumericalFailure(
          concat("objective term '", term->name(), "' gave a partial that is not finite"));
    }
  }
  return sum;
}

std::vector<SecondPlace> Objective::second_places(const TrajectoryValues& shape) const {
  std::vector<SecondPlace> all;
  for (const auto& term : terms_) {
    const std::vector<SecondPlace> places = term->second_places(shape);
    all.insert(all.end(), places.begin(), places.end());
  }
  return all;
}

Eigen::VectorXd Objective::second_partials(const TrajectoryValues& values) const {
  Eigen::VectorXd all;
  for (const auto& term : terms_) {
    const Eigen::Index first = all.size();
    const auto count = static_cast<Eigen::Index>(term->second_places(values).size());
    all.conservativeResize(first + count);
    term->second_partials(values, all.tail(count));
    if (!all.tail(count).allFinite()) {
      throw NumericalFailure(
          concat("objective term '", term->name(), "' gave a second partial that is not finite"));
    }
  }
  return all;
}

}  // namespace hbar
