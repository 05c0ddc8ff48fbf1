#pragma once

#include <vector>

#include "hbar/adjoint/trajectory/trajectory.h"
#include "hbar/core/model/model.h"

namespace hbar {

/// How a stage's q̇, q̈ and step start depend on the coordinates of one stage (doc/integrators.md).
/// Weight is a number, or a 3 x 3 block for exponential coordinates that changed chart in between.
template <typename Weight>
struct StencilEntry {
  int stage = 0;
  Weight qdot;        ///< ∂q̇/∂q_stage
  Weight a;           ///< ∂q̈/∂q_stage
  Weight start_q;     ///< ∂(q at the step's start)/∂q_stage
  Weight start_qdot;  ///< ∂(q̇ at the step's start)/∂q_stage
};

/// A stage's rates in terms of coordinates alone: earlier rates are replaced by their own stencils,
/// down to the initial rate q̇₀. This is what makes a row of H̄.
template <typename Weight>
struct FlatStencil {
  std::vector<StencilEntry<Weight>> entries;  ///< ascending by stage; the stage itself is last
  Weight a_by_qdot0;                          ///< ∂q̈/∂q̇₀
  Weight start_qdot_by_qdot0;                 ///< ∂(q̇ at the step's start)/∂q̇₀
  bool reaches_start = false;                 ///< whether stage 0 is reached at all
};

/// Weights for all coordinates that did not change chart.
[[nodiscard]] FlatStencil<double> flat_stencil(const Timeline& timeline, int stage);

/// Weights for one exponential node whose chart changed somewhere along the stencil.
[[nodiscard]] FlatStencil<Eigen::Matrix3d> flat_stencil(const Model& model,
                                                        const Trajectory& trajectory, int stage,
                                                        int node);

/// Nodes that need the second form at a stage.
[[nodiscard]] std::vector<int> nodes_with_chart_switch(const Trajectory& trajectory, int stage);

}  // namespace hbar
