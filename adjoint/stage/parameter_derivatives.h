#pragma once

#include "hbar/adjoint/stage/stage_residual.h"
#include "hbar/core/parameters/applied.h"
#include "hbar/core/parameters/sparsity.h"

namespace hbar {

/// grad += factor · zᵀ ∂g/∂p of a stage, after stage.pull_back(z): the contraction of (21) without
/// its matrix, O(1) per parameter block.
///
/// @param point  where the stage was linearised
/// @param z      what was pulled back                                            [dof]
template <Scalar S>
void add_parameter_gradient(const Applied<S>& applied, const StageResidual<S>& stage,
                            const StagePoint<S>& point, const VectorView<S>& z, double factor,
                            Eigen::Ref<VectorX<S>> grad);

/// ∂g/∂p of a stage as explicit columns, after linearize: (23), (26), (27), (29). Rows that a
/// parameter does not affect (parameter_rows) are left unchanged.
///
/// @param columns                                                     [dof x set.size()]
template <Scalar S>
void parameter_columns(const Applied<S>& applied, const StageResidual<S>& stage,
                       const StagePoint<S>& point, Eigen::Ref<MatrixX<S>> columns);

}  // namespace hbar
