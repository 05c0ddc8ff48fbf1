#include "gait.h"

#include <algorithm>

#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"

namespace hbar::walker {
namespace {

constexpr int kPowers = 4;  // declared rows before the forces of the feet
constexpr int kForceRows = 4;

double weight_of(const Horizon& horizon, const Eigen::VectorXd& p) {
  Mechanism<double> mechanism = nominal_mechanism<double>(horizon.model());
  apply_parameters<double>(horizon.model(), horizon.parameters(), p, mechanism);
  return mechanism.mass.sum() * horizon.model().gravity().norm();
}

/// Controls of a whole gait: in the second half the legs change places.
Eigen::MatrixXd both_halves(const Eigen::MatrixXd& u) {
  Eigen::MatrixXd out(u.rows(), 2 * u.cols());
  const Eigen::Index leg = u.rows() / 2;
  out << u, (Eigen::MatrixXd(u.rows(), u.cols()) << u.bottomRows(leg), u.topRows(leg)).finished();
  return out;
}

/// Gap of state k to the start, advanced, as it is or mirrored.
StateGap gap_to_start(const TrajectoryValues& values, Eigen::Index k, double advance,
                      const std::vector<int>& places) {
  StateGap gap;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto c = static_cast<Eigen::Index>(i);
    const double wanted = values.q(c, 0) + (i == 0 ? advance : 0.0);
    gap.q = std::max(gap.q, std::abs(values.q(places[i], k) - wanted));
    gap.qdot = std::max(gap.qdot, std::abs(values.qdot(places[i], k) - values.qdot(c, 0)));
  }
  return gap;
}

double friction_use(const TrajectoryValues& values, double weight) {
  double use = 0.0;
  for (Eigen::Index k = 0; k < values.measured.cols(); ++k) {
    for (int foot = 0; foot < 2; ++foot) {
      const auto force = values.declared().col(k).segment<kForceRows>(kPowers + kForceRows * foot);
      if (force[0] > kCarries * weight) {
        use = std::max(use, std::abs(force[1]) / force[0]);
      }
    }
  }
  return use;
}

/// Path of the feet's deepest points along the ground, what rolls taken off, in half a gait.
double slip_of(const TrajectoryValues& values, const Gait& gait, const Model& model, int steps) {
  double slip = 0.0;
  for (int foot = 0; foot < 2; ++foot) {
    const int link = model.find_body(foot == 0 ? "left_foot" : "right_foot");
    const double radius = std::get<Sphere>(model.link(link).body.shape).radius;
    const int hip = 3 + 2 * foot;
    const auto turned = [&](int k) {  // of the ball, against rolling forward
      return values.q(2, k) + values.q(hip, k) + values.q(hip + 1, k);
    };
    for (int k = 1; k <= steps; ++k) {
      if (std::min(gait.load(foot, k), gait.load(foot, k - 1)) > kCarries * gait.weight) {
        const int x = 3 * foot;
        slip += std::abs(values.v()(x, k) - values.v()(x, k - 1) +
                         radius * (turned(k) - turned(k - 1)));
      }
    }
  }
  return slip;
}

}  // namespace

Gait examine(const Plan& plan, const TrajectoryProblem& problem, const TrajectoryValues& values,
             const Eigen::VectorXd& lengths) {
  SimulationOptions options = problem.horizon.options();
  options.steps = 2 * plan.steps;
  options.restarts = plan.restarts;
  options.restarts.push_back(plan.steps);
  for (const int step : plan.restarts) {
    options.restarts.push_back(plan.steps + step);
  }
  Horizon horizon(problem.horizon.shared_model(), problem.horizon.parameters(), options);
  Inputs inputs = horizon.nominal_inputs();
  inputs.p = values.p;
  inputs.u = both_halves(values.u);
  inputs.q0 = values.q.col(0);
  inputs.qdot0 = values.qdot.col(0);
  const Rollout rollout = simulate(horizon, inputs);
  const TrajectoryValues stride = read_values(horizon, rollout.trajectory());

  Gait gait;
  gait.lengths = lengths;
  gait.weight = weight_of(horizon, values.p);
  const auto powers = stride.declared().topRows(kPowers).middleCols(1, plan.steps);
  gait.work = options.h * powers.cwiseAbs().sum();
  gait.cost_of_transport = gait.work / (gait.weight * plan.advance());
  const Eigen::Index half = plan.steps + 1;
  gait.solution = {(stride.q.leftCols(half) - values.q).cwiseAbs().maxCoeff(),
                   (stride.qdot.leftCols(half) - values.qdot).cwiseAbs().maxCoeff()};
  std::vector<int> itself(static_cast<std::size_t>(horizon.model().dof()));
  for (std::size_t i = 0; i < itself.size(); ++i) {
    itself[i] = static_cast<int>(i);
  }
  gait.half = gap_to_start(stride, plan.steps, plan.advance(), mirror(horizon.model()));
  gait.whole = gap_to_start(stride, 2 * plan.steps, 2.0 * plan.advance(), itself);
  gait.load.resize(2, stride.measured.cols());
  gait.load.row(0) = stride.declared().row(kPowers);
  gait.load.row(1) = stride.declared().row(kPowers + kForceRows);
  gait.friction_use = friction_use(stride, gait.weight);
  gait.slip = slip_of(stride, gait, horizon.model(), plan.steps);
  return gait;
}

std::string gait_diagram(const Gait& gait) {
  std::string text;
  for (Eigen::Index foot = 0; foot < 2; ++foot) {
    text += foot == 0 ? "  left   " : "  right  ";
    for (Eigen::Index k = 0; k < gait.load.cols(); k += 2) {
      const double share = gait.load(foot, k) / gait.weight;
      text += share > 0.5 ? '#' : (share > kCarries ? '+' : '.');
    }
    text += '\n';
  }
  return text;
}

}  // namespace hbar::walker
