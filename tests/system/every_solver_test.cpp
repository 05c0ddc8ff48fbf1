// Every solver of the suite on the systems of real trajectories, and the gradients they give.

#include <gtest/gtest.h>

#include <fstream>

#include "examples/solver_benchmark/cases.h"
#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#include "hbar/adjoint/programs/load_problem.h"
#include "hbar/adjoint/systems/periodic.h"
#include "hbar/adjoint/systems/trajectory_system.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/core/scene/read_xml.h"
#include "hbar/core/scene/vocabulary.h"
#include "hbar/solvers/linear/accuracy.h"
#include "hbar/suite.h"
#include "tests/support/input_vector.h"
#include "tests/support/periodic_problems.h"
#include "tests/support/small_problems.h"

namespace hbar {
namespace {

using solvers::SolverEntry;
using solvers::Structure;
using testing::contact_problem;
using testing::driven_pendulum;
using testing::flatten;
using testing::small_problem;

/// Names of the solvers that claim a structure, and "auto".
std::vector<std::string> solvers_for(Structure structure) {
  std::vector<std::string> names = {"auto"};
  for (const SolverEntry& entry : solvers::available_solvers()) {
    if (entry.claims(structure)) {
      names.push_back(entry.name);
    }
  }
  return names;
}

/// The normal equations have their own, weaker promise.
double backward_error_bound(const std::string& solver) {
  return solver == "cholmod_normal" ? 1e-8 : 1e-14;
}

TEST(EverySolver, CountsTheEntriesOfBothFactorsAndTheirDiagonalOnce) {
  // Without fill: a diagonal, and a tridiagonal matrix in its own order; filled: a whole one.
  constexpr int kRows = 40;
  std::vector<Eigen::Triplet<double>> band;
  for (int i = 0; i < kRows; ++i) {
    band.emplace_back(i, i, 4.0);
    if (i > 0) {
      band.emplace_back(i, i - 1, 1.0);
      band.emplace_back(i - 1, i, 1.0);
    }
  }
  solvers::SparseMatrix tridiagonal(kRows, kRows);
  tridiagonal.setFromTriplets(band.begin(), band.end());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Constant(kRows, kRows, 0.5);
  whole.diagonal().array() += kRows;
  solvers::SparseMatrix diagonal(kRows, kRows);
  diagonal.setIdentity();
  for (const SolverEntry& entry : solvers::available_solvers()) {
    const Structure structure =
        entry.claims(Structure::kDefinite) ? Structure::kDefinite : Structure::kGeneral;
    if (!entry.claims(structure) || entry.name == "lapack_band" || entry.name == "spqr" ||
        entry.name == "cholmod_normal") {
      continue;  // whole bands; reflections; A Aᵀ
    }
    const auto entries_of = [&](const solvers::SparseMatrix& A) {
      const auto solver = solvers::make_solver(entry.name, {.structure = structure}, A);
      solver->analyze(A);
      solver->factorize(A);
      return solver->factor_info().entries;
    };
    EXPECT_EQ(entries_of(whole.sparseView()), kRows * kRows) << entry.name;
    if (entry.name != "block_banded") {  // whose blocks count whole
      EXPECT_EQ(entries_of(diagonal), kRows) << entry.name;
      EXPECT_GE(entries_of(tridiagonal), tridiagonal.nonZeros()) << entry.name;
      EXPECT_LE(entries_of(tridiagonal), 1.5 * static_cast<double>(tridiagonal.nonZeros()))
          << entry.name;
    }
  }
}

// With UMFPACK's own threshold the pivots of this one grow to 3e13, and refinement does not mend
// the solution of the transposed system.
TEST(EverySolver, SolvesAPeriodicSystemWhosePivotsGrow) {
  solver_benchmark::CaseAssembler assembler;
  const solver_benchmark::BenchmarkMatrix matrix = assembler.assemble(
      {.family = "tree", .joints = 7, .steps = 50, .system = SystemKind::kPeriodic});
  for (const std::string& name : solvers_for(matrix.options.structure)) {
    const auto solver = solvers::make_solver(name, matrix.options, matrix.A);
    solver->analyze(matrix.A);
    solver->factorize(matrix.A);
    Eigen::MatrixXd x(matrix.b.size(), 1);
    for (const solvers::System system : {solvers::System::kTransposed, solvers::System::kPlain}) {
      solver->solve(system, matrix.b, x);
      EXPECT_LT(solvers::normwise_backward_error(matrix.A, system, x.col(0), matrix.b),
                backward_error_bound(name))
          << name;
    }
    if (name == "umfpack") {
      EXPECT_EQ(solver->statistics().factorizations, 2);
    }
  }
}

struct SystemCase {
  SystemKind kind;
  bool contact;
  std::string integrator;
};

std::vector<SystemCase> every_system() {
  std::vector<SystemCase> cases;
  for (const SystemKind kind :
       {SystemKind::kAdjoint, SystemKind::kPeriodic, SystemKind::kGaussNewton, SystemKind::kKkt}) {
    for (const bool contact : {false, true}) {
      for (const std::string integrator : {"bdf1", "bdf2"}) {
        cases.push_back({kind, contact, integrator});
      }
    }
  }
  return cases;
}

/// What floats freely can close its motion anywhere, which makes the periodic system singular.
Problem problem_of(const SystemCase& c) {
  if (c.kind == SystemKind::kPeriodic) {
    return driven_pendulum(c.integrator, 40, c.contact);
  }
  return c.contact ? contact_problem(c.integrator, 0.01, 40) : small_problem(c.integrator);
}

class EverySolverOnEverySystem : public ::testing::TestWithParam<SystemCase> {};

TEST_P(EverySolverOnEverySystem, HasABackwardErrorAtRounding) {
  const SystemCase& c = GetParam();
  Problem problem = problem_of(c);
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const TrajectorySystem system = assemble_system(c.kind, problem.horizon, trajectory);
  const std::vector<std::string> names = solvers_for(system.options.structure);
  EXPECT_GE(names.size(), 4U);
  for (const std::string& name : names) {
    const auto solver = solvers::make_solver(name, system.options, system.A);
    if (name == "cholmod_normal") {
      solver->set_residual_bounds({.refuse_above = 1e-6});
    }
    solver->analyze(system.A);
    solver->factorize(system.A);
    Eigen::VectorXd x(system.b.size());
    solver->solve(system.b, x);
    EXPECT_LE(solvers::normwise_backward_error(system.A, solvers::System::kPlain, x, system.b),
              backward_error_bound(name))
        << name;
    solver->solve_transposed(system.b, x);
    EXPECT_LE(solvers::normwise_backward_error(system.A, solvers::System::kTransposed, x, system.b),
              backward_error_bound(name))
        << name;
    if (name == "cholmod_ldlt" && c.kind == SystemKind::kKkt) {
      const int multipliers = problem.horizon.model().dof() * trajectory.timeline.last_stage();
      EXPECT_EQ(solver->factor_info().inertia->negative, multipliers);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, EverySolverOnEverySystem, ::testing::ValuesIn(every_system()),
                         [](const auto& c) {
                           return std::string(name_of(c.param.kind)) +
                                  (c.param.contact ? "_contact_" : "_") + c.param.integrator;
                         });

TEST(EverySolver, GivesTheSweepsGradient) {
  for (const bool contact : {false, true}) {
    Problem problem = contact ? contact_problem("bdf2", 0.01, 40) : small_problem("bdf2");
    const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    const Eigen::VectorXd swept = flatten(gradient(problem.horizon, trajectory, problem.objective));
    for (const std::string& name : solvers_for(Structure::kBlockTriangular)) {
      if (name == "cholmod_normal") {
        continue;  // below: never for a gradient
      }
      AssembledAdjoint assembled(problem.horizon, solvers::solver_factory(name));
      const Eigen::VectorXd ours = flatten(assembled.gradient(trajectory, problem.objective));
      EXPECT_LT((ours - swept).norm(), 1e-9 * swept.norm()) << name;
    }
  }
}

TEST(EverySolver, GivesThePeriodicGradientOfKlu) {
  Problem problem = driven_pendulum("bdf2", 30);
  PeriodicSolver by_klu(problem.horizon);
  const PeriodicOrbit orbit = by_klu.solve(problem.inputs);
  const Eigen::VectorXd expected = flatten(by_klu.gradient(orbit.trajectory, problem.objective));
  for (const std::string& name : solvers_for(Structure::kPeriodic)) {
    if (name == "cholmod_normal") {
      continue;
    }
    PeriodicSolver solver(problem.horizon, {.solver = solvers::solver_factory(name)});
    const Trajectory found = solver.solve(problem.inputs).trajectory;
    EXPECT_LT((found.q - orbit.trajectory.q).norm(), 1e-9 * found.q.norm()) << name;
    const Eigen::VectorXd ours = flatten(solver.gradient(found, problem.objective));
    EXPECT_LT((ours - expected).norm(), 1e-9 * expected.norm()) << name;
  }
}

TEST(EverySolver, AnalysesOnceInAHundredIterationsOfADescent) {
  for (const std::string& name : solvers_for(Structure::kBlockTriangular)) {
    if (name == "cholmod_normal") {
      continue;
    }
    Problem problem = driven_pendulum("bdf1", 10);
    AssembledAdjoint assembled(problem.horizon, solvers::solver_factory(name));
    double first = 0.0;
    double last = 0.0;
    for (int i = 0; i < 100; ++i) {
      const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
      const Gradient g = assembled.gradient(trajectory, problem.objective);
      problem.inputs.u -= 0.02 * g.u;
      (i == 0 ? first : last) = g.value;
    }
    EXPECT_LT(last, first) << name;
    EXPECT_EQ(assembled.solver().statistics().analyses, 1) << name;
    EXPECT_EQ(assembled.solver().statistics().factorizations, 100) << name;
  }
}

TEST(NormalEquations, LoseDigitsWithTheLengthOfTheTrajectory) {
  const auto forward_error = [](int steps) {
    Problem problem = driven_pendulum("bdf2", steps);
    const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
    const TrajectorySystem system =
        assemble_system(SystemKind::kAdjoint, problem.horizon, trajectory);
    const auto reference = solvers::make_solver("klu", system.options, system.A);
    reference->analyze(system.A);
    reference->factorize(system.A);
    const Eigen::VectorXd exact = solvers::refined_solution(*reference, system.A, system.b);
    const auto normal = solvers::make_solver("cholmod_normal", system.options, system.A);
    // As they are, without refinement.
    normal->set_residual_bounds({.refine_above = 1.0, .refuse_above = 1.0, .max_refinements = 0});
    normal->analyze(system.A);
    normal->factorize(system.A);
    Eigen::VectorXd x(exact.size());
    normal->solve(system.b, x);
    return (x - exact).norm() / exact.norm();
  };
  const double at_20 = forward_error(20);
  const double at_200 = forward_error(200);
  EXPECT_GT(at_20, 1e-14);
  EXPECT_GT(at_200, 1e2 * at_20);
}

TEST(SceneFile, NamesEverySolverThatTheGradientMayTake) {
  for (const std::string& name : solvers_for(Structure::kBlockTriangular)) {
    const std::string text =
        "<redmax model=\"m\"><solver_option linear_solver=\"" + name +
        "\"/><robot><link name=\"l\"><joint type=\"revolute\" axis=\"0 1 0\" pos=\"0 0 "
        "0\" quat=\"1 0 0 0\"/><body type=\"sphere\" radius=\"1\" pos=\"0 0 "
        "-2\" quat=\"1 0 0 0\" density=\"1\"/></link></robot></redmax>";
    EXPECT_EQ(scene::read_scene_text(text, "m.xml").description.solver_options.linear_solver, name);
  }
}

}  // namespace
}  // namespace hbar
