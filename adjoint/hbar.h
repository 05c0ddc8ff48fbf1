#pragma once

// All of hbar that needs no optional component: models and scenes, trajectories, objectives and
// constraints, designs, gradients, and the nonlinear programs for an optimiser. The components have
// headers of their own: hbar/ipopt.h, hbar/nlopt.h, hbar/study.h, hbar/suite.h, hbar/umfpack.h.

// Models: built in C++ or read from a scene, and their parameters.
#include "hbar/core/model/model_builder.h"
#include "hbar/core/parameters/parameters.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/load_model.h"
#include "hbar/core/scene/write_xml.h"

// Trajectories, and what is read from them.
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"

// What is wanted of them.
#include "hbar/adjoint/terms/check_terms.h"
#include "hbar/adjoint/terms/constraint_terms.h"
#include "hbar/adjoint/terms/generic_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/terms/place.h"

// Derivatives, and the systems behind them as sparse matrices.
#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#include "hbar/adjoint/derivatives/check_gradient.h"
#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/second_order.h"
#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/systems/periodic.h"
#include "hbar/adjoint/systems/trajectory_system.h"

// Designs and programs.
#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/design/check_design_map.h"
#include "hbar/adjoint/design/composed_map.h"
#include "hbar/adjoint/design/formula_map.h"
#include "hbar/adjoint/programs/load_problem.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/solvers/linear/solver_catalogue.h"
#include "hbar/solvers/nlp/gradient_check.h"
#include "hbar/solvers/nlp/hessian_check.h"
