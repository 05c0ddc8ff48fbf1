#include "hbar/adjoint/programs/all_at_once_hessian.h"

#include <set>
#include <variant>

#include "hbar/core/model/drives.h"
#include "hbar/core/parameters/sparsity.h"

namespace hbar {
namespace {

/// Visits the pairs of a stage's runs of x that have second derivatives: f(a, b), b not after a.
/// Coordinates pair with those of another run at their own stage, rates with each other.
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

std::vector<std::vector<int>> listed(const std::vector<std::set<int>>& sets) {
  std::vector<std::vector<int>> out;
  for (const std::set<int>& set : sets) {
    out.emplace_back(set.begin(), set.end());
  }
  return out;
}

}  // namespace

AllAtOnceHessian::AllAtOnceHessian(const TrajectoryProblem& problem, const InputVariables& head,
                                   const StageLayout& layout, const ValueDependence& values)
    : map_(problem.map),
      head_(head),
      layout_(layout),
      stage_(problem.horizon, head.design_count()) {
  lay_out_pairs(problem.horizon, values);
  lay_out_gains(problem.horizon);
}

/// Lists the pairs that have second derivatives: pairs of coordinates (from the residual, and where
/// measurements read bodies of two branches), and of a control and a rate (a motor's power).
void AllAtOnceHessian::lay_out_pairs(const Horizon& horizon, const ValueDependence& values) {
  std::vector<std::set<int>> pairs;
  for (const std::vector<int>& others : residual_pattern(horizon.model())) {
    pairs.emplace_back(others.begin(), others.end());
  }
  std::vector<std::set<int>> own = pairs;
  const auto couple = [](const std::vector<int>& coordinates, std::vector<std::set<int>>& all) {
    for (const int c : coordinates) {
      all[static_cast<std::size_t>(c)].insert(coordinates.begin(), coordinates.end());
    }
  };
  std::set<std::pair<int, int>> powers;
  int row = 0;
  for (const Measurement& measurement : horizon.measurements()) {
    const int end = row + static_cast<int>(row_names(horizon.model(), measurement).size());
    if (row == end) {
      continue;
    }
    const MeasuredReads& reads = values.reads(row);
    reads_controls_ = reads_controls_ || !reads.controls.empty();
    if (std::holds_alternative<BodyDistance>(measurement)) {
      couple(reads.q, own);
    } else if (std::holds_alternative<TactileReading>(measurement)) {
      couple(reads.q, own);
      couple(reads.q, pairs);
    } else if (std::holds_alternative<MotorPower>(measurement)) {
      for (std::size_t i = 0; i < reads.controls.size(); ++i) {
        powers.emplace(reads.controls[i], reads.qdot[i]);  // once, if measured twice
      }
    }
    row = end;
  }
  pairs_ = listed(pairs);
  own_pairs_ = listed(own);
  control_rates_.assign(powers.begin(), powers.end());
}

/// Likewise pairs of a design variable and a control: a motor's P.
void AllAtOnceHessian::lay_out_gains(const Horizon& horizon) {
  std::set<std::pair<Eigen::Index, int>> gains;
  for (int m = 0; m < static_cast<int>(horizon.model().motors().size()); ++m) {
    const int gain = horizon.parameters().index(ParameterKind::kMotorP, m, 0);
    if (gain >= 0) {
      for (const Eigen::Index i : head_.designs_of(gain)) {
        for_each_drive(horizon.model(), m, [&](int, int control) { gains.emplace(i, control); });
      }
    }
  }
  gain_controls_.assign(gains.begin(), gains.end());
}

const std::vector<int>& AllAtOnceHessian::pairs_of(const StageRun& a, const StageRun& b,
                                                   int coordinate) const {
  const bool own = a.q != 0.0 && b.q != 0.0;
  return (own ? own_pairs_ : pairs_)[static_cast<std::size_t>(coordinate)];
}

void AllAtOnceHessian::add(EntryPlan& entries) const {
  for (int s = 0; s < layout_.stage_count(); ++s) {
    add_stage(s, entries);
  }
  for (Eigen::Index j = 0; j < head_.design_count(); ++j) {
    for (Eigen::Index i = j; i < head_.design_count(); ++i) {
      entries.add(i, j);
    }
  }
}

void AllAtOnceHessian::add_stage(int stage, EntryPlan& entries) const {
  const std::vector<StageRun>& runs = layout_.runs(stage);
  const int n = layout_.dof();
  const int step = layout_.step_ended_by(stage);
  const bool reads_controls = step >= 0 && reads_controls_;
  const Eigen::Index control =
      head_.control_place(head_.block_of_step(measured_step(step > 0 ? step : 0)));
  for_each_pair(runs, [&](const StageRun& a, const StageRun& b) {
    for (int c = 0; c < n; ++c) {
      for (const int other : pairs_of(a, b, c)) {
        if (a.place != b.place || other <= c) {
          entries.add_lower(a.place + c, b.place + other);
        }
      }
    }
  });
  for (const StageRun& run : runs) {
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
    for (const auto& [i, k] : gain_controls_) {
      entries.add_lower(head_.control_place(head_.block_of_step(layout_.step_of(stage))) + k, i);
    }
  }
}

void AllAtOnceHessian::put_stage(int stage, const StageCurvature& h, EntryPlan& entries) const {
  const std::vector<StageRun>& runs = layout_.runs(stage);
  const int n = layout_.dof();
  const int step = layout_.step_ended_by(stage);
  const bool reads_controls = step >= 0 && reads_controls_;
  for_each_pair(runs, [&](const StageRun& a, const StageRun& b) {
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
  for (const StageRun& run : runs) {
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

void AllAtOnceHessian::put(const Trajectory& trajectory, const Eigen::VectorXd& d,
                           const Eigen::MatrixXd& map_jacobian, const Eigen::VectorXd& z,
                           const TrajectoryPartials& weights, EntryPlan& entries) {
  const Eigen::Index n = layout_.dof();
  stage_.set_parameters(trajectory.inputs.p, map_jacobian);
  Eigen::MatrixXd dd = Eigen::MatrixXd::Zero(d.size(), d.size());
  Eigen::VectorXd by_p = weights.p;
  Eigen::VectorXd y;
  for (int s = 0; s < layout_.stage_count(); ++s) {
    const int step = layout_.step_ended_by(s);
    if (step >= 0) {
      y = weights.measured.col(step);
    }
    const StageCurvature& curvature =
        s == 0
            ? stage_.evaluate_start(trajectory, y)
            : stage_.evaluate(trajectory, s, z.segment((s - 1) * n, n), step >= 0 ? &y : nullptr);
    put_stage(s, curvature, entries);
    dd += curvature.dd;
    by_p += curvature.by_p;
  }
  if (d.size() > 0) {
    dd += map_->hessian(d, by_p);
  }
  for (Eigen::Index j = 0; j < dd.cols(); ++j) {
    for (Eigen::Index i = j; i < dd.rows(); ++i) {
      entries.put(dd(i, j));
    }
  }
}

}  // namespace hbar
