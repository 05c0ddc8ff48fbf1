#include "hbar/adjoint/systems/optimality_matrix.h"

#include <algorithm>
#include <cmath>

#include "hbar/adjoint/outputs/measurements.h"
#include "hbar/adjoint/trajectory/horizon.h"
#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/core/base/error.h"

namespace hbar {
namespace {

using solvers::SparseMatrix;

/// A block of unknowns of the KKT system.
struct KktBlock {
  int begin = 0;      // its first row
  int stage = 0;      // 0: the design parameters
  double time = 0.0;  // of the stage
  int controls = 0;   // between its coordinates and its multipliers
};

/// The order of the unknowns of the KKT system: stage by stage q, u of a step that begins there, μ.
class Places {
 public:
  Places(const Horizon& horizon, const Timeline& timeline, bool with_parameters)
      : n_(horizon.model().dof()) {
    const int controls = horizon.model().control_count();
    int next = 0;
    int begun = -1;
    for (int s = 1; s <= timeline.last_stage(); ++s) {
      blocks_.push_back({next, s, timeline.stage(s).time, 0});
      q_.push_back(next);
      next += n_;
      if (timeline.stage(s).step != begun) {
        begun = timeline.stage(s).step;
        u_.push_back(next);
        blocks_.back().controls = controls;
        next += controls;
      }
      mu_.push_back(next);
      next += n_;
    }
    p_ = next;
    const int parameters = with_parameters ? horizon.parameters().size() : 0;
    if (parameters > 0) {
      blocks_.push_back({next, 0, 0.0, 0});
    }
    size_ = next + parameters;
  }

  /// Of a row of q̄, a row of ḡ, a column of ∂ḡ/∂u, a parameter.
  [[nodiscard]] int q(int index) const { return at(q_, index / n_) + index % n_; }
  [[nodiscard]] int mu(int index) const { return at(mu_, index / n_) + index % n_; }
  [[nodiscard]] int u(int index, int controls) const {
    return at(u_, index / controls) + index % controls;
  }
  [[nodiscard]] int p(int index) const { return p_ + index; }
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const std::vector<KktBlock>& blocks() const { return blocks_; }
  [[nodiscard]] std::vector<int> block_sizes() const {
    std::vector<int> sizes;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const int end = b + 1 < blocks_.size() ? blocks_[b + 1].begin : size_;
      sizes.push_back(end - blocks_[b].begin);
    }
    return sizes;
  }

 private:
  static int at(const std::vector<int>& places, int i) {
    return places[static_cast<std::size_t>(i)];
  }

  int n_;
  std::vector<int> q_;   // per stage
  std::vector<int> u_;   // per step
  std::vector<int> mu_;  // per stage
  int p_ = 0;
  int size_ = 0;
  std::vector<KktBlock> blocks_;
};

/// E = ∂(what is tracked)/∂q̄: the variables of every stage, or its coordinates.
SparseMatrix followed_by_q(const Horizon& horizon, const Trajectory& trajectory) {
  const Model& model = horizon.model();
  const int n = model.dof();
  const int stages = trajectory.timeline.last_stage();
  const int variables = model.variable_count();
  if (variables == 0) {
    SparseMatrix identity(stages * n, stages * n);
    identity.setIdentity();
    return identity;
  }
  // E's row is the gradient of one variable.
  std::vector<Measurement> followed = model_measurements(model);
  followed.resize(model.end_effectors().size());  // which come first
  Measurements<double> measurements(model, followed);
  InstantMotion<double> instants(model, measurements.reads_contacts());
  const Applied<double> applied{*trajectory.mechanism, horizon.parameters(), trajectory.inputs.p};
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(measurements.size());
  Eigen::VectorXd by_q(n), by_qdot(n), by_u(model.control_count()), by_p(applied.set.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int s = 1; s <= stages; ++s) {
    const Instant<double> at =
        instants.at(applied, trajectory.q.col(s), none, trajectory.inputs.u.col(0));
    measurements.linearize(at);
    for (int i = 0; i < variables; ++i) {
      by_q.setZero();
      by_qdot.setZero();
      by_u.setZero();
      by_p.setZero();
      InstantGradient<double> by{by_q, by_qdot, by_u, by_p};
      weight[i] = 1.0;
      measurements.pull_back(at, weight, by);
      weight[i] = 0.0;
      for (int j = 0; j < n; ++j) {
        entries.emplace_back((s - 1) * variables + i, (s - 1) * n + j, by_q[j]);
      }
    }
  }
  SparseMatrix E(stages * variables, stages * n);
  E.setFromTriplets(entries.begin(), entries.end());
  return E;
}

/// D: one over the largest magnitude of each row of H̄; rows of zeros keep 1.
Eigen::VectorXd row_scales(const SparseMatrix& H) {
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(H.rows());
  for (int j = 0; j < H.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(H, j); it; ++it) {
      largest[it.row()] = std::max(largest[it.row()], std::abs(it.value()));
    }
  }
  return largest.unaryExpr([](double value) { return value > 0.0 ? 1.0 / value : 1.0; });
}

SparseMatrix scaled_identity(Eigen::Index size, double value) {
  SparseMatrix out(size, size);
  out.setIdentity();
  out.coeffs() *= value;
  return out;
}

std::function<std::string(int)> kkt_names(const Horizon& horizon, const Places& places) {
  return [model = horizon.shared_model(), blocks = places.blocks()](int index) {
    const auto after =
        std::upper_bound(blocks.begin(), blocks.end(), index,
                         [](int row, const KktBlock& block) { return row < block.begin; });
    const KktBlock& block = *(after - 1);
    const int inner = index - block.begin;
    if (block.stage == 0) {
      return concat("design parameter ", inner);
    }
    const std::string stage = concat("stage ", block.stage, " (t = ", block.time, "), ");
    const int n = model->dof();
    if (inner < n) {
      return concat(stage, "coordinate ", model->coordinate_name(inner));
    }
    if (inner < n + block.controls) {
      return concat(stage, "control ", inner - n);
    }
    return concat(stage, "multiplier of coordinate ",
                  model->coordinate_name(inner - n - block.controls));
  };
}

}  // namespace

void fill_gauss_newton(const Horizon& horizon, const Trajectory& trajectory,
                       const Linearization& linearization, const SystemOptions& weights,
                       AssembledSystem& out) {
  const SparseMatrix& H = linearization.H.matrix();
  const SparseMatrix scaled = row_scales(H).asDiagonal() * H;
  const SparseMatrix E = followed_by_q(horizon, trajectory);
  const SparseMatrix by_forces = SparseMatrix(scaled.transpose()) * scaled;
  const SparseMatrix by_tracking = SparseMatrix(E.transpose()) * E;
  out.A = weights.forces * by_forces + weights.tracking * by_tracking;
  out.A += scaled_identity(H.rows(), weights.damping);
  out.b = weights.tracking * (E.transpose() * Eigen::VectorXd::Ones(E.rows()));
  out.options = {.structure = solvers::Structure::kDefinite,
                 .block_sizes = linearization.block_sizes};
}

void fill_kkt(const Horizon& horizon, const Trajectory& trajectory,
              const Linearization& linearization, const SystemOptions& weights,
              AssembledSystem& out) {
  const SparseMatrix& H = linearization.H.matrix();
  const Places places(horizon, trajectory.timeline, weights.parameters);
  const Eigen::VectorXd scales = row_scales(H);
  const SparseMatrix E = followed_by_q(horizon, trajectory);
  const SparseMatrix by_tracking = SparseMatrix(E.transpose()) * E;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add_jacobian = [&](const SparseMatrix& dg, const auto& place) {
    for (int j = 0; j < dg.outerSize(); ++j) {
      for (SparseMatrix::InnerIterator it(dg, j); it; ++it) {
        const int row = places.mu(static_cast<int>(it.row()));
        const double value = scales[it.row()] * it.value();
        entries.emplace_back(row, place(j), value);
        entries.emplace_back(place(j), row, value);
      }
    }
  };
  for (int j = 0; j < by_tracking.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(by_tracking, j); it; ++it) {
      entries.emplace_back(places.q(static_cast<int>(it.row())), places.q(j),
                           weights.tracking * it.value());
    }
  }
  for (int i = 0; i < H.rows(); ++i) {
    entries.emplace_back(places.q(i), places.q(i), weights.damping);
    entries.emplace_back(places.mu(i), places.mu(i), -weights.slack);
  }
  const int controls = horizon.model().control_count();
  const auto u_place = [&](int j) { return places.u(j, controls); };
  for (int j = 0; j < linearization.dg_du.cols(); ++j) {
    entries.emplace_back(u_place(j), u_place(j), weights.effort + weights.damping);
  }
  add_jacobian(H, [&](int j) { return places.q(j); });
  add_jacobian(linearization.dg_du, u_place);
  if (weights.parameters) {
    for (int j = 0; j < linearization.dg_dp.cols(); ++j) {
      entries.emplace_back(places.p(j), places.p(j), weights.damping);
    }
    add_jacobian(linearization.dg_dp, [&](int j) { return places.p(j); });
  }
  out.A.resize(places.size(), places.size());
  out.A.setFromTriplets(entries.begin(), entries.end());
  out.b.setZero(places.size());
  const Eigen::VectorXd pull = E.transpose() * Eigen::VectorXd::Ones(E.rows());
  for (int i = 0; i < pull.size(); ++i) {
    out.b[places.q(i)] = weights.tracking * pull[i];
  }
  out.options = {.structure = solvers::Structure::kQuasiDefinite,
                 .block_sizes = places.block_sizes()};
  out.name_of_unknown = kkt_names(horizon, places);
}

}  // namespace hbar
