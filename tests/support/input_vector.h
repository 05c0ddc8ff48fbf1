#pragma once

#include <limits>
#include <string>
#include <vector>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/parameters/parameter_kinds.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"

namespace hbar::testing {

/// (p, u, q0, qdot0) of Inputs or a Gradient as one vector.
template <typename T>
[[nodiscard]] Eigen::VectorXd flatten(const T& x) {
  Eigen::VectorXd out(x.p.size() + x.u.size() + x.q0.size() + x.qdot0.size());
  out << x.p, x.u.reshaped(), x.q0, x.qdot0;
  return out;
}

/// The inverse of flatten.
[[nodiscard]] inline Inputs unflatten(const Eigen::VectorXd& x, const Inputs& shape) {
  const Eigen::Index p = shape.p.size();
  const Eigen::Index u = shape.u.size();
  const Eigen::Index n = shape.q0.size();
  return {x.head(p), x.segment(p, u).reshaped(shape.u.rows(), shape.u.cols()), x.segment(p + u, n),
          x.tail(n)};
}

/// Inputs of one class: a ParameterKind, the controls or the initial state.
struct InputClass {
  std::string name;
  std::vector<Eigen::Index> entries;  ///< in the flattened vector
};

/// Every class that the horizon's inputs have entries of.
[[nodiscard]] inline std::vector<InputClass> input_classes(const Horizon& horizon,
                                                           const Inputs& inputs) {
  std::vector<InputClass> classes;
  for (const ParameterKindRow& row_of_kind : parameter_kinds()) {
    const ParameterKind kind = row_of_kind.kind;
    InputClass of_kind{std::string(kind_name(kind)), {}};
    for (int i = 0; i < horizon.parameters().size(); ++i) {
      if (horizon.parameters()[i].kind == kind) {
        of_kind.entries.push_back(i);
      }
    }
    classes.push_back(std::move(of_kind));
  }
  Eigen::Index first = inputs.p.size();
  const auto append = [&](std::string name, Eigen::Index size) {
    InputClass next{std::move(name), {}};
    for (Eigen::Index i = 0; i < size; ++i) {
      next.entries.push_back(first++);
    }
    classes.push_back(std::move(next));
  };
  append("u", inputs.u.size());
  append("q0", inputs.q0.size());
  append("qdot0", inputs.qdot0.size());
  std::erase_if(classes, [](const InputClass& c) { return c.entries.empty(); });
  return classes;
}

/// Ψ of a simulation.
[[nodiscard]] inline double objective_of(const Horizon& horizon, const Objective& objective,
                                         const Inputs& inputs) {
  const Trajectory trajectory = simulate(horizon, inputs).trajectory();
  return objective.value(read_values(horizon, trajectory));
}

/// dΨ/dx_i by central differences, extrapolated once. Steps are relative where |x_i| > 1.
[[nodiscard]] inline double difference_quotient(const Horizon& horizon, const Objective& objective,
                                                const Inputs& inputs, Eigen::Index i, double step) {
  const Eigen::VectorXd x = flatten(inputs);
  const double scale = std::max(1.0, std::abs(x[i]));
  const auto along = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    Eigen::VectorXd at = x;
    at[i] += scale * e[0];
    const double psi = objective_of(horizon, objective, unflatten(at, inputs));
    return Eigen::VectorXd::Constant(1, psi);
  };
  return differences(along, Eigen::VectorXd::Zero(1), step)(0, 0) / scale;
}

/// Gap of a gradient's entries of one class to central differences, relative to the largest entry:
/// the bottom of the V that it draws over the given steps.
[[nodiscard]] inline double gap_to_differences(const Horizon& horizon, const Objective& objective,
                                               const Inputs& inputs, const Gradient& gradient,
                                               const InputClass& entries,
                                               const std::vector<double>& steps) {
  const Eigen::VectorXd exact = flatten(gradient)(entries.entries);
  double smallest = std::numeric_limits<double>::infinity();
  for (const double step : steps) {
    Eigen::VectorXd quotients(exact.size());
    for (Eigen::Index k = 0; k < exact.size(); ++k) {
      const Eigen::Index i = entries.entries[static_cast<std::size_t>(k)];
      quotients[k] = difference_quotient(horizon, objective, inputs, i, step);
    }
    smallest = std::min(smallest, relative_gap(exact, quotients));
  }
  return smallest;
}

/// Slope of the Taylor remainder along a random direction within one class: of log |f(ε) − f(0) −
/// ε f'(0)| over log ε, over the two smallest decades in which rounding is below a hundredth of it.
/// NaN if there are none.
[[nodiscard]] inline double taylor_slope_in(const Horizon& horizon, const Objective& objective,
                                            const Inputs& inputs, const Gradient& gradient,
                                            const InputClass& entries, double largest_e) {
  Random random(3);
  const Eigen::VectorXd x = flatten(inputs);
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(x.size());
  direction(entries.entries) = random.vector(static_cast<Eigen::Index>(entries.entries.size()));
  const double slope = flatten(gradient).dot(direction);
  std::vector<double> remainders;
  for (double e = largest_e; e > 1e-7; e /= 10.0) {
    const double psi = objective_of(horizon, objective, unflatten(x + e * direction, inputs));
    const double remainder = std::abs(psi - gradient.value - e * slope);
    if (remainder < 100.0 * 1e-14 * std::abs(gradient.value)) {
      break;
    }
    remainders.push_back(remainder);
  }
  const std::size_t n = remainders.size();
  return n < 3 ? std::numeric_limits<double>::quiet_NaN()
               : 0.5 * std::log10(remainders[n - 3] / remainders[n - 1]);
}

}  // namespace hbar::testing
