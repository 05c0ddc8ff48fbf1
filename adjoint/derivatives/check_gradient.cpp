#include "hbar/adjoint/derivatives/check_gradient.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <random>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/contact/contact_forces.h"
#include "hbar/core/parameters/parameter_kinds.h"

namespace hbar {
namespace {

/// Flat view of inputs: p, then u step by step, then q0, then q̇0.
Eigen::VectorXd flatten(const Eigen::VectorXd& p, const Eigen::MatrixXd& u,
                        const Eigen::VectorXd& q0, const Eigen::VectorXd& qdot0) {
  Eigen::VectorXd flat(p.size() + u.size() + q0.size() + qdot0.size());
  flat << p, u.reshaped(), q0, qdot0;
  return flat;
}

Inputs unflatten(const Inputs& shape, const Eigen::VectorXd& flat) {
  Inputs out = shape;
  Eigen::Index at = 0;
  const auto take = [&](auto&& part) {
    part = flat.segment(at, part.size());
    at += part.size();
  };
  take(out.p.reshaped());
  take(out.u.reshaped());
  take(out.q0.reshaped());
  take(out.qdot0.reshaped());
  return out;
}

/// The entries of the flat inputs that belong to one class, and a typical size of each.
struct InputClass {
  std::string name;
  std::vector<Eigen::Index> entries;
  std::vector<double> scales;
};

/// How far a parameter may be moved: a fraction of its nominal value; moments only as far as the
/// triangle inequality allows.
double probe_size(const Model& model, const Parameter& parameter) {
  double size = std::abs(parameter.nominal);
  if (parameter.kind == ParameterKind::kContactPoint) {
    // A coordinate may be zero, so the body's extent counts.
    size = model.link(parameter.owner).body.contact_points.cwiseAbs().maxCoeff();
    return size > 0.0 ? 0.1 * size : 1.0;
  }
  if (parameter.kind == ParameterKind::kInertia) {
    const Eigen::Vector3d& I = model.link(parameter.owner).body.inertia;
    size = std::min(size, I.sum() - 2.0 * I.maxCoeff());
  }
  return size > 0.0 ? 0.3 * size : 1.0;
}

std::vector<InputClass> input_classes(const Problem& problem) {
  const ParameterSet& set = problem.horizon.parameters();
  std::vector<InputClass> classes;
  for (const ParameterKindRow& kind : parameter_kinds()) {
    InputClass next{std::string(kind.name), {}, {}};
    for (int i = 0; i < set.size(); ++i) {
      if (set[i].kind == kind.kind) {
        next.entries.push_back(i);
        next.scales.push_back(probe_size(problem.horizon.model(), set[i]));
      }
    }
    classes.push_back(std::move(next));
  }
  Eigen::Index at = set.size();
  const auto add = [&](const char* name, Eigen::Index size) {
    InputClass next{name, {}, {}};
    for (Eigen::Index i = 0; i < size; ++i) {
      next.entries.push_back(at + i);
      next.scales.push_back(1.0);
    }
    at += size;
    classes.push_back(std::move(next));
  };
  add("controls", problem.inputs.u.size());
  add("initial position", problem.inputs.q0.size());
  add("initial velocity", problem.inputs.qdot0.size());
  std::erase_if(classes, [](const InputClass& c) { return c.entries.empty(); });
  return classes;
}

Directions as_directions(const Horizon& horizon, const Inputs& shape, const Eigen::VectorXd& flat) {
  const Inputs parts = unflatten(shape, flat);
  Directions out = Directions::zero(horizon, 1);
  out.p.col(0) = parts.p;
  out.u.col(0) = parts.u.reshaped();
  out.q0.col(0) = parts.q0;
  out.qdot0.col(0) = parts.qdot0;
  return out;
}

/// Least-squares slope of log y over log x.
double log_slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0.0;
  double sy = 0.0;
  double sxx = 0.0;
  double sxy = 0.0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = std::log(x[i]);
    const double v = std::log(y[i]);
    sx += u;
    sy += v;
    sxx += u * u;
    sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Distinguishes the smooth pieces of Ψ. Contact puts a kink wherever, at some stage, a point
/// begins to touch, to slide or to sense another face, and halved steps and changes of chart make Ψ
/// jump: differences across such a place mix the derivatives of both sides.
class PieceReader {
 public:
  explicit PieceReader(const Horizon& horizon)
      : horizon_(horizon),
        motion_(horizon.model().tree()),
        contacts_(horizon.model()),
        none_(Eigen::VectorXd::Zero(horizon.model().dof())) {}

  /// Numbers that agree for two trajectories exactly if no such place separates them.
  std::vector<int> read(const Trajectory& trajectory, const TrajectoryValues& values) {
    const Model& model = horizon_.model();
    std::vector<int> piece;
    for (int k = 0; k <= trajectory.step_count(); ++k) {
      piece.push_back(trajectory.timeline.step_end(k));
    }
    for (const ChartSwitch& change : trajectory.chart_switches) {
      piece.insert(piece.end(), {change.stage, change.node});
    }
    if (model.contact_count() > 0) {
      const int first = values.declared_count() > 0 ? 0 : 1;  // measured at the start, too
      for (int stage = first; stage < trajectory.timeline.stage_count(); ++stage) {
        read_contacts(trajectory, stage, piece);
      }
    }
    read_sensors(values, piece);
    return piece;
  }

 private:
  void read_contacts(const Trajectory& trajectory, int stage, std::vector<int>& piece) {
    const Model& model = horizon_.model();
    compute_motion<double>(model.tree(), *trajectory.mechanism, trajectory.q.col(stage),
                           trajectory.qdot.col(stage), none_, motion_);
    contacts_.linearize(*trajectory.mechanism, motion_);
    for (const ActivePair<double>& pair : contacts_.active()) {
      const Contact& contact = model.contact(pair.contact);
      const bool own = std::holds_alternative<OwnShape>(contact.surface);
      const Shape& shape = model.link(std::max(contact.other, 0)).body.shape;
      for (const TouchingPoint<double>& point : contacts_.points(pair)) {
        const double normal = point.force.normal;
        piece.insert(piece.end(),
                     {pair.contact, point.index, point.force.sticks ? 1 : 0,
                      static_cast<int>(normal > 0.0) - static_cast<int>(normal < 0.0),
                      own ? face(shape, pair.motion.b.X_WB.R.transpose() * point.n) : 0});
      }
    }
    piece.push_back(-1);
  }

  /// Which face of a solid with edges has the normal n, in its frame.
  static int face(const Shape& shape, const Eigen::Vector3d& n) {
    if (std::holds_alternative<Cylinder>(shape)) {
      return std::abs(n.z()) > 0.5 ? 1 : 0;
    }
    int axis = 0;
    if (std::holds_alternative<Cuboid>(shape) && n.cwiseAbs().maxCoeff(&axis) > 0.5) {
      return n[axis] > 0.0 ? axis + 1 : -axis - 1;
    }
    return 0;
  }

  /// Which points of sensors touch and, of these, which slide: their shear is at its bound.
  void read_sensors(const TrajectoryValues& values, std::vector<int>& piece) const {
    for (Eigen::Index k = 0; k < values.tactile().cols(); ++k) {
      Eigen::Index at = 0;
      for (const TactileSensor& sensor : horizon_.model().tactile_sensors()) {
        for (Eigen::Index i = 0; i < sensor.points.cols(); ++i, at += 3) {
          const Eigen::Vector3d reading = values.tactile().col(k).segment<3>(at);
          const double bound = sensor.coefficients.mu * std::abs(reading[2]);
          const bool slides = reading.head<2>().norm() > (1.0 - 1e-9) * bound;
          piece.push_back(reading[2] == 0.0 ? 0 : slides ? 1 : 2);
        }
      }
    }
  }

  Horizon horizon_;
  Motion<double> motion_;
  ContactForces<double> contacts_;
  Eigen::VectorXd none_;
};

/// State shared by all probes of one problem.
class Prober {
 public:
  Prober(const Problem& problem, const GradientCheckOptions& options)
      : problem_(problem),
        options_(options),
        horizon_(tightened(problem.horizon)),
        pieces_(horizon_),
        random_(options.seed) {
    trajectory_ = simulate(horizon_, problem.inputs).trajectory();
    const TrajectoryValues values = read_values(horizon_, trajectory_);
    partials_ = std::make_unique<TrajectoryPartials>(problem.objective.partials(values));
    value_ = problem.objective.value(values);
    AdjointSweep sweep(horizon_);
    const Gradient g = sweep.pull_back(trajectory_, *partials_);
    adjoint_norm_ = sweep.adjoint().norm();
    gradient_ = flatten(g.p, g.u, g.q0, g.qdot0);
    x_ = flatten(problem.inputs.p, problem.inputs.u, problem.inputs.q0, problem.inputs.qdot0);
    piece_ = pieces_.read(trajectory_, values);
    tangent_ = std::make_unique<TangentSweep>(horizon_);
  }

  GradientCheckRow check(const InputClass& inputs) {
    GradientCheckRow row;
    row.name = inputs.name;
    row.size = static_cast<int>(inputs.entries.size());
    row.taylor_slope = std::numeric_limits<double>::infinity();
    row.remainder_vanishes = true;
    for (int i = 0; i < options_.directions; ++i) {
      probe(inputs, row);
    }
    // A wrong gradient leaves a remainder of first order. One of third order is that of a class
    // whose second derivative happens to be small.
    const bool slope_fits =
        row.remainder_vanishes || row.taylor_slope >= 2.0 - options_.slope_tolerance;
    row.passed = row.difference_gap <= options_.difference_bound && slope_fits &&
                 row.dot_gap <= options_.dot_bound;
    return row;
  }

 private:
  static Horizon tightened(const Horizon& horizon) {
    SimulationOptions options = horizon.options();
    options.newton.rtol = std::min(options.newton.rtol, 1e-13);
    return horizon.with(options);
  }

  /// Ψ; nothing where the simulation fails or x is on another smooth piece than the nominal inputs.
  std::optional<double> value_at(const Eigen::VectorXd& x) {
    const Rollout rollout = simulate(horizon_, unflatten(problem_.inputs, x));
    if (!rollout.converged()) {
      return std::nullopt;
    }
    const TrajectoryValues values = read_values(horizon_, rollout.trajectory());
    if (pieces_.read(rollout.trajectory(), values) != piece_) {
      return std::nullopt;
    }
    return problem_.objective.value(values);
  }

  void probe(const InputClass& inputs, GradientCheckRow& row) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Eigen::VectorXd d = Eigen::VectorXd::Zero(x_.size());
    double class_norm = 0.0;
    for (std::size_t i = 0; i < inputs.entries.size(); ++i) {
      d[inputs.entries[i]] = uniform(random_) * inputs.scales[i];
      // Measured in the class's own typical sizes, so that a mass and a moment count equally.
      class_norm += std::pow(gradient_[inputs.entries[i]] * inputs.scales[i], 2);
    }
    class_norm = std::sqrt(class_norm);
    const double slope = gradient_.dot(d);
    // A class that Ψ hardly depends on is measured relative to Ψ: differences resolve no more.
    double scale = std::max(class_norm, 1e-4 * std::abs(value_));
    if (scale == 0.0) {
      scale = 1.0;  // at rest and at the optimum: absolute figures
    }
    row.dot_gap = std::max(row.dot_gap, dot_gap(d, slope, scale));
    differences(d, slope, scale, row);
  }

  /// |⟨z̄, b⟩ − ⟨ȳ, H̄⁻¹ b⟩| over the larger of the two sides' norm products, b = ∂ḡ·d.
  double dot_gap(const Eigen::VectorXd& d, double slope, double scale) {
    const Directions directions = as_directions(horizon_, problem_.inputs, d);
    const Tangents tangents = tangent_->push_forward(trajectory_, directions);
    const double product = norm_product(*partials_, tangents);
    const double dual_product = adjoint_norm_ * tangent_->right_hand_sides().norm();
    const double forward = directional_derivative(*partials_, tangents, directions, 0);
    return std::abs(slope - forward) / std::max({scale, product, dual_product});
  }

  /// Central differences, extrapolated once, at steps from 2e-2 down; the best one counts. The
  /// Taylor remainder is followed while it is well above rounding. Steps that leave the smooth
  /// piece of Ψ are replaced by smaller ones.
  void differences(const Eigen::VectorXd& d, double slope, double scale, GradientCheckRow& row) {
    constexpr int kSteps = 12;
    constexpr double kSmallestStep = 1e-7;
    const double rounding = 1e-13 * std::max(std::abs(value_), scale);
    std::vector<double> steps;
    std::vector<double> remainders;
    double best = std::numeric_limits<double>::infinity();
    double last_difference = 0.0;
    int taken = 0;
    for (double step = 2e-2; taken < kSteps && step > kSmallestStep; step *= 0.5) {
      const std::optional<double> ahead = value_at(x_ + step * d);
      const std::optional<double> behind = ahead ? value_at(x_ - step * d) : std::nullopt;
      if (!behind) {
        taken = 0;  // larger steps that returned to the piece have left it in between
        steps.clear();
        remainders.clear();
        best = std::numeric_limits<double>::infinity();
        continue;
      }
      const double difference = (*ahead - *behind) / (2.0 * step);
      best = std::min(best, std::abs(difference - slope));
      if (taken > 0) {
        const double extrapolated = (4.0 * difference - last_difference) / 3.0;
        best = std::min(best, std::abs(extrapolated - slope));
      }
      last_difference = difference;
      ++taken;
      // The larger of both sides: one alone may change sign, where it has no order.
      const double remainder = std::max(std::abs(*ahead - value_ - step * slope),
                                        std::abs(*behind - value_ + step * slope));
      if (remainder > 1e3 * rounding) {
        steps.push_back(step);
        remainders.push_back(remainder);
      }
    }
    row.difference_gap = std::max(row.difference_gap, best / scale);
    if (steps.size() >= 4) {
      // The smallest half of the steps: the asymptotic part.
      const auto tail = static_cast<std::ptrdiff_t>(std::max<std::size_t>(4, steps.size() / 2));
      const double order =
          log_slope({steps.end() - tail, steps.end()}, {remainders.end() - tail, remainders.end()});
      row.remainder_vanishes = false;
      row.taylor_slope = std::min(row.taylor_slope, order);
    }
  }

  const Problem& problem_;
  const GradientCheckOptions& options_;
  Horizon horizon_;
  PieceReader pieces_;
  std::mt19937 random_;
  double value_ = 0.0;
  double adjoint_norm_ = 0.0;
  Eigen::VectorXd gradient_;
  Eigen::VectorXd x_;
  Trajectory trajectory_;
  std::vector<int> piece_;
  std::unique_ptr<TrajectoryPartials> partials_;
  std::unique_ptr<TangentSweep> tangent_;
};

}  // namespace

bool GradientCheckReport::passed() const {
  return std::all_of(rows.begin(), rows.end(),
                     [](const GradientCheckRow& row) { return row.passed; });
}

std::string GradientCheckReport::table() const {
  std::ostringstream out;
  out << std::left << std::setw(28) << "class" << std::right << std::setw(6) << "size"
      << std::setw(14) << "differences" << std::setw(12) << "slope" << std::setw(14)
      << "dot product"
      << "  verdict\n";
  for (const GradientCheckRow& row : rows) {
    out << std::left << std::setw(28) << row.name << std::right << std::setw(6) << row.size
        << std::scientific << std::setprecision(1) << std::setw(14) << row.difference_gap;
    if (row.remainder_vanishes) {
      out << std::setw(12) << "affine";
    } else {
      out << std::fixed << std::setprecision(3) << std::setw(12) << row.taylor_slope;
    }
    out << std::scientific << std::setprecision(1) << std::setw(14) << row.dot_gap
        << (row.passed ? "  ok\n" : "  FAILED\n");
  }
  return out.str();
}

GradientCheckReport check_gradient(const Problem& problem, const GradientCheckOptions& options) {
  Prober prober(problem, options);
  GradientCheckReport report;
  for (const InputClass& inputs : input_classes(problem)) {
    report.rows.push_back(prober.check(inputs));
  }
  return report;
}

}  // namespace hbar
