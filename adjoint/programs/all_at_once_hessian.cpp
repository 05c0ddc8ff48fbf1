// The Hessian of the Lagrangian of AllAtOnce.
#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/programs/all_at_once.h"

namespace hbar {

void AllAtOnce::add_curvature(EntryPlan& entries) const {
  for (int s = 0; s < trajectory_.timeline.stage_count(); ++s) {
    add_stage(s, entries);
  }
  for (Eigen::Index j = 0; j < head_.design_count(); ++j) {
    for (Eigen::Index i = j; i < head_.design_count(); ++i) {
      entries.add(i, j);
    }
  }
}

/// Visits the pairs of a stage's runs of x that have second derivatives: f(a, b), b not behind a.
/// Coordinates meet those of another run at their own stage, rates each other.
template <typename Entries, typename F>
void for_each_pair(const Entries& entries, const F& f) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const auto moves = [](const auto& entry) {
        return entry.q != 0.0 || entry.qdot != 0.0 || entry.a != 0.0;
      };
      const bool rates = entries[i].qdot != 0.0 && entries[j].qdot != 0.0;
      if ((entries[i].q != 0.0 && moves(entries[j])) ||
          (entries[j].q != 0.0 && moves(entries[i])) || rates) {
        f(entries[i], entries[j]);
      }
    }
  }
}

void AllAtOnce::add_stage(int stage, EntryPlan& entries) const {
  const std::vector<StageEntry>& runs = stages_[static_cast<std::size_t>(stage)];
  const int n = problem_.horizon.model().dof();
  const int step = step_ended_by(stage);
  const bool reads_controls = step >= 0 && problem_.horizon.measured_count() > 0;
  const Eigen::Index control =
      head_.control_place(head_.block_of_step(measured_step(step > 0 ? step : 0)));
  for_each_pair(runs, [&](const StageEntry& a, const StageEntry& b) {
    for (int c = 0; c < n; ++c) {
      for (const int other : pairs_of(a, b, c)) {
        if (a.place != b.place || other <= c) {
          entries.add_lower(a.place + c, b.place + other);
        }
      }
    }
  });
  for (const StageEntry& run : runs) {
    for (int c = 0; c < n; ++c) {
      for (Eigen::Index i = 0; i < head_.design_count(); ++i) {
        entries.add_lower(run.place + c, i);
      }
    }
    if (reads_controls && run.qdot != 0.0) {
      for (const auto& [i, c] : control_rates_) {
        entries.add_lower(run.place + c, control + i);
      }
    }
  }
  if (stage > 0 || reads_controls) {
    const int acting = stage > 0 ? trajectory_.timeline.stage(stage).step : 0;
    for (const auto& [i, k] : gain_controls_) {
      entries.add_lower(head_.control_place(head_.block_of_step(acting)) + k, i);
    }
  }
}

void AllAtOnce::put_stage(int stage, EntryPlan& entries) const {
  const std::vector<StageEntry>& runs = stages_[static_cast<std::size_t>(stage)];
  const StageHessian& h = hessian_;
  const int n = problem_.horizon.model().dof();
  const int step = step_ended_by(stage);
  const bool reads_controls = step >= 0 && problem_.horizon.measured_count() > 0;
  for_each_pair(runs, [&](const StageEntry& a, const StageEntry& b) {
    const double by_qq = a.q * b.q;
    const double by_qv = a.q * b.qdot;
    const double by_vq = a.qdot * b.q;
    const double by_qa = a.q * b.a;
    const double by_aq = a.a * b.q;
    const double by_vv = a.qdot * b.qdot;
    for (int c = 0; c < n; ++c) {
      for (const int other : pairs_of(a, b, c)) {
        if (a.place != b.place || other <= c) {
          entries.put(by_qq * h.qq(c, other) + by_qv * h.qv(c, other) + by_vq * h.qv(other, c) +
                      by_qa * h.qa(c, other) + by_aq * h.qa(other, c) + by_vv * h.vv(c, other));
        }
      }
    }
  });
  for (const StageEntry& run : runs) {
    for (int c = 0; c < n; ++c) {
      for (Eigen::Index i = 0; i < head_.design_count(); ++i) {
        entries.put(run.q * h.dq(i, c) + run.qdot * h.dv(i, c) + run.a * h.da(i, c) +
                    run.start_q * h.dsq(i, c) + run.start_qdot * h.dsv(i, c));
      }
    }
    if (reads_controls && run.qdot != 0.0) {
      for (const auto& [i, c] : control_rates_) {
        entries.put(run.qdot * h.uv(i, c));
      }
    }
  }
  if (stage > 0 || reads_controls) {
    for (const auto& [i, k] : gain_controls_) {
      entries.put(h.du(i, k));
    }
  }
}

OutputRows<double> AllAtOnce::output_weights(const TrajectoryPartials& partials, int k) const {
  return {partials.v.col(k), partials.tactile.col(k), partials.measured.col(k)};
}

void AllAtOnce::lagrangian_hessian(const Eigen::VectorXd& x, double sigma,
                                   const Eigen::VectorXd& lambda, solvers::HessianKind kind,
                                   Eigen::VectorXd& values) {
  const Stopwatch stopwatch(times_.hessian);
  ++times_.hessians;
  HessianPlan& at = plan(kind);
  differentiate(x);
  begin_values(at, values_, sigma, lambda, values);
  if (kind != solvers::HessianKind::kExact) {
    return;
  }
  const Eigen::Index n = problem_.horizon.model().dof();
  const TrajectoryPartials partials = lagrangian_partials(values_, sigma, lambda);
  hessian_.set_parameters(trajectory_.inputs.p, map_jacobian_);
  Eigen::MatrixXd dd = Eigen::MatrixXd::Zero(head_.design_count(), head_.design_count());
  Eigen::VectorXd by_p = partials.p;
  for (int s = 0; s < trajectory_.timeline.stage_count(); ++s) {
    const int step = step_ended_by(s);
    OutputRows<double> y;
    if (step >= 0) {
      y = output_weights(partials, step);
    }
    if (s == 0) {
      hessian_.evaluate_start(trajectory_, y);
    } else {
      const Eigen::Index first = (s - 1) * n;
      hessian_.evaluate(
          trajectory_, s,
          lambda.segment(own_rows() + first, n).cwiseProduct(row_scale_.segment(first, n)),
          step >= 0 ? &y : nullptr);
    }
    put_stage(s, at.entries);
    dd += hessian_.dd;
    by_p += hessian_.by_p;
  }
  if (head_.design_count() > 0) {
    dd += problem_.map->hessian(design(x), by_p);
  }
  for (Eigen::Index j = 0; j < dd.cols(); ++j) {
    for (Eigen::Index i = j; i < dd.rows(); ++i) {
      at.entries.put(dd(i, j));
    }
  }
}

}  // namespace hbar
