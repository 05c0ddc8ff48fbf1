// Numbers, shapes and options that hbar cannot mean: each is refused, with what was expected
// instead.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#include "hbar/adjoint/derivatives/check_gradient.h"
#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/second_order.h"
#include "hbar/adjoint/terms/constraint_terms.h"
#include "hbar/adjoint/terms/generic_terms.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/solvers/linear/solver_choice.h"
#include "hbar/solvers/nlp/ipopt.h"
#include "tests/support/message_of.h"
#include "tests/system/misuse.h"

namespace hbar {
namespace {

using testing::misuse::horizon;
using testing::misuse::inputs;
using testing::misuse::Misuse;
using testing::misuse::objective;
using testing::misuse::options;
using testing::misuse::problem;
using testing::misuse::set_of_two;
using testing::misuse::three;
using testing::misuse::trajectory;
using testing::misuse::two;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Simulates from inputs that `change` has spoiled.
std::function<void()> simulated(void (*change)(Inputs&), const ParameterSet& set = set_of_two()) {
  return [=] {
    const Horizon of(two(), set, options());
    Inputs spoiled = inputs(of);
    change(spoiled);
    static_cast<void>(simulate(of, spoiled));
  };
}
std::function<void()> with_options(void (*change)(SimulationOptions&)) {
  return [=] {
    SimulationOptions wrong = options();
    change(wrong);
    Horizon(two(), set_of_two(), wrong);
  };
}
/// Transcribes a problem that `change` has spoiled, and evaluates it at its start.
std::function<void()> transcribed(void (*change)(TrajectoryProblem&),
                                  const TranscriptionOptions& how = {}) {
  return [=] {
    TrajectoryProblem wrong = problem();
    change(wrong);
    const auto program = transcribe(wrong, how);
    const Eigen::VectorXd x = program->variables().start;
    static_cast<void>(program->objective(x));
  };
}
std::function<void()> differentiated(const std::function<Objective()>& of) {
  return [=] { static_cast<void>(gradient(horizon(), trajectory(horizon()), of())); };
}
std::function<void()> with_guess(Eigen::Index columns, double value) {
  return transcribed([](TrajectoryProblem&) {},
                     {.formulation = Formulation::kAllAtOnce,
                      .q_guess = Eigen::MatrixXd::Constant(2, columns, value)});
}

std::vector<Misuse> of_inputs() {
  const auto spring = ParameterSet::named(two(), {"joint.j1.stiffness"});
  return {{"TooFewControls", simulated([](Inputs& in) { in.u.conservativeResize(2, 10); }),
           "u is 2 x 10; it must be 2 x 20"},
          {"AnotherNumberOfCoordinates", simulated([](Inputs& in) { in.q0.setZero(5); }),
           "q0 is 5 x 1; it must be 2 x 1"},
          {"CoordinateThatIsNaN", simulated([](Inputs& in) { in.q0[1] = kNaN; }),
           "q0(1, 0) is nan; it must be finite"},
          {"ControlThatIsNaN", simulated([](Inputs& in) { in.u(1, 3) = kNaN; }),
           "u(1, 3) is nan; it must be finite"},
          {"NegativeMass", simulated([](Inputs& in) { in.p[0] = -1.0; }),
           "body.b0.mass is -1; it must be positive"},
          {"NegativeDamping", simulated([](Inputs& in) { in.p[1] = -5.0; }),
           "joint.j1.damping is -5; it must be ≥ 0"},
          {"NegativeStiffness", simulated([](Inputs& in) { in.p[0] = -5.0; }, spring),
           "joint.j1.stiffness is -5; it must be ≥ 0"},
          {"GradientAtNaN",
           [] {
             Problem wrong{horizon(), Objective(effort()), inputs(horizon())};
             wrong.inputs.u.setConstant(kNaN);
             static_cast<void>(check_gradient(wrong));
           },
           "u(0, 0) is nan; it must be finite"}};
}

std::vector<Misuse> of_names_and_options() {
  return {{"MisspeltParameter",
           [] { static_cast<void>(ParameterSet::named(two(), {"body.b0.masss"})); },
           "there is no parameter 'body.b0.masss'; did you mean 'body.b0.mass'?"},
          {"MisspeltPrefix", [] { static_cast<void>(ParameterSet::named(two(), {"bodies.b0"})); },
           "there is no parameter 'bodies.b0'; known: joint.j0.rotation.x"},
          {"TimeStepThatIsNaN", with_options([](SimulationOptions& o) { o.h = kNaN; }),
           "time step h is nan; it must be positive"},
          {"NoSteps", with_options([](SimulationOptions& o) { o.steps = 0; }),
           "steps is 0; it must be at least 1"},
          {"UnknownIntegrator", with_options([](SimulationOptions& o) { o.integrator = "rk4"; }),
           "there is no integrator 'rk4'; known: bdf1, sdirk2, bdf2"},
          {"MeasurementOfNoLink", with_options([](SimulationOptions& o) {
             o.measurements = {PointVelocity{"v", 9}};
           }),
           "measurement 'v': link is 9; it must be 0 … 1"},
          {"UnknownSolver", [] { static_cast<void>(solver_factory("pardiso")); },
           "there is no solver \"pardiso\"; known: auto "},
          {"MisspeltIpoptOption",
           [] {
             TrajectoryProblem plain = problem();
             static_cast<void>(solvers::solve_with_ipopt(*transcribe(plain),
                                                         {.number_options = {{"mu_innit", 1e-2}}}));
           },
           "mu_innit"},
          {"IpoptInsideIpopt",
           [] {
             const auto program = transcribe(problem());
             const auto other = transcribe(problem());
             solvers::IpoptOptions nested;
             nested.on_iteration = [&](const auto&) {
               static_cast<void>(solvers::solve_with_ipopt(*other));
               return true;
             };
             static_cast<void>(solvers::solve_with_ipopt(*program, nested));
           },
           "ipopt: solve_with_ipopt was called from inside an optimisation"}};
}

std::vector<Misuse> of_models() {
  const auto with_joint = [](const Joint& joint) {
    ModelBuilder builder("one");
    builder.add_link(-1, joint, solid_body("b", Sphere{1.0}, 1.0));
    static_cast<void>(builder.build());
  };
  return {{"MotorOfNoLink",
           [] {
             ModelBuilder builder("one");
             builder.add_link(-1, {.name = "j", .kind = RevoluteJoint{{0.0, 1.0, 0.0}}},
                              solid_body("b", Sphere{1.0}, 1.0));
             builder.add_motor({.link = 9});
             static_cast<void>(builder.build());
           },
           "motor: link 9 does not exist"},
          {"AxisOfZero",
           [=] {
             with_joint({.name = "j", .kind = RevoluteJoint{{0.0, 0.0, 0.0}}});
           },
           "joint 'j': axis is (0 0 0); it must be a non-zero vector"},
          {"RotationThatScales",
           [=] {
             with_joint({.name = "j",
                         .kind = RevoluteJoint{{0.0, 1.0, 0.0}},
                         .X_PJ = {.R = 2.0 * Eigen::Matrix3d::Identity()}});
           },
           "joint 'j': X_PJ must be a rotation matrix and a finite position"}};
}

std::vector<Misuse> of_programs() {
  return {
      {"MapOfAsManyOthers", transcribed([](TrajectoryProblem& wrong) {
         wrong.map =
             parameter_map(ParameterSet::named(two(), {"body.b1.mass", "joint.j0.damping"}));
       }),
       "the map is of another parameter set: parameter 0 is body.b1.mass there and body.b0.mass in "
       "the "},
      {"MassThatADesignMakesNegative", transcribed([](TrajectoryProblem& wrong) {
         DesignVariables one = design_variables({{.name = "d", .start = -1.0}});
         wrong.map = affine_map(one, Eigen::Vector2d(0.0, 0.1), Eigen::Vector2d(1.0, 0.0));
       }),
       "body.b0.mass is -1; it must be positive"},
      {"DampingThatADesignMakesNegative", transcribed([](TrajectoryProblem& wrong) {
         DesignVariables one = design_variables({{.name = "d", .start = -1.0}});
         wrong.map = affine_map(one, Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0));
       }),
       "joint.j1.damping is -1; it must be ≥ 0"},
      {"DampingThatADesignMakesNegativeAllAtOnce",
       transcribed(
           [](TrajectoryProblem& wrong) {
             DesignVariables one = design_variables({{.name = "d", .start = -1.0}});
             wrong.map = affine_map(one, Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0));
           },
           {.formulation = Formulation::kAllAtOnce}),
       "joint.j1.damping is -1; it must be ≥ 0"},
      {"ConstraintAfterTheLastStep", transcribed([](TrajectoryProblem& wrong) {
         wrong.constraints = {variable_at_step(two(), "tip", 21, {0.0, 0.0, -1.0})};
       }),
       "constraint 'tip.x at step 21' reads measured 0 at step 21; there are 3 x 21 of measured"},
      {"ConstraintOfAnotherModel", transcribed([](TrajectoryProblem& wrong) {
         wrong.constraints = {coordinate_limits(three(), 2, {5}, 0.0, 1.0)};
       }),
       "constraint 'j2 at step 5' reads q 2 at step 5; there are 2 x 21 of q"},
      {"NumberThatIsNotThere", transcribed([](TrajectoryProblem& wrong) {
         wrong.objective = Objective(final_number(ValueField::kMeasured, 17));
       }),
       "final_number: there is no row 17 of measured; it has 3"},
      {"ControlsOfAnotherShape", transcribed([](TrajectoryProblem& wrong) {
         wrong.controls.start = Eigen::MatrixXd::Zero(2, 7);
       }),
       "controls.start is 2 x 7; it must be 2 x 20 or 2 x 1"},
      {"ControlsHeldForNoStep",
       transcribed([](TrajectoryProblem& wrong) { wrong.controls.hold = 0; }),
       "controls.hold is 0; it must be ≥ 1"},
      {"GuessOfAnotherShape", with_guess(20, 0.0),
       "q_guess is 2 x 20; it must be 2 x 21 and finite"},
      {"GuessOfNaN", with_guess(21, kNaN), "it must be 2 x 21 and finite"},
      {"GuessWithAnotherStart", with_guess(21, 0.7),
       "transcription: q_guess begins with 0.7 for 'j0'; the motion begins with q0 = 0"}};
}

std::vector<Misuse> of_terms() {
  return {
      {"NegativeWeight", [] { static_cast<void>(effort(-1.0)); },
       "effort: weight is -1; it must be ≥ 0"},
      {"WeightsOfAnotherNumberOfSteps", differentiated([] {
         StepWeights weights;
         weights.each = Eigen::VectorXd::Ones(3);
         return Objective(effort(1.0, weights));
       }),
       "effort: there are 3 weights of steps; there must be 20 or none"},
      {"TargetOfAnotherShape",
       differentiated([] { return Objective(tracking(Eigen::MatrixXd::Zero(3, 20))); }),
       "tracking: target of q is 3 x 20; it must be 2 x 20 or 2 x 1"},
      {"MeasurementThatIsNotThere", differentiated([] {
         return Objective(
             generic_term("x", {{ValueField::kMeasured, 20, 17}}, [](auto x) { return x[0]; }));
       }),
       "there is no measured 17 at step 20: measured is 3 x 21"},
      {"FormulaThatIsNaN", differentiated([] {
         return Objective(generic_term("root", {{ValueField::kQ, 20, 0}}, [](auto x) {
           using std::sqrt;
           return sqrt(-1.0 - x[0] * x[0]);
         }));
       }),
       "objective term 'root' gave a partial that is not finite"},
      {"DirectionOfAnotherShape",
       [] {
         const Horizon of = horizon();
         HessianProduct product(of, Objective(effort()));
         product.set_point(trajectory(of));
         Inputs along = inputs(of);
         along.u.resize(1, 1);
         static_cast<void>(product.along(along));
       },
       "the direction has 2 parameters, 1 x 1 controls and 2 + 2 initial values; expected 2, 2 x "},
      {"SolutionWithoutAMatrix",
       [] {
         const auto solver = solvers::make_solver("klu", {}, {});
         Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
         solver->solve(x, x);
       },
       "klu: solve: no matrix is factorised; call factorize first"}};
}

std::vector<Misuse> wrong_values() {
  std::vector<Misuse> all = of_inputs();
  for (const auto& more : {of_names_and_options(), of_models(), of_programs(), of_terms()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

class EveryWrongValue : public ::testing::TestWithParam<Misuse> {};

TEST_P(EveryWrongValue, IsRefused) {
  const std::string message = testing::message_of<Error>(GetParam().call);
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << "message: [" << message << "]";
}

INSTANTIATE_TEST_SUITE_P(All, EveryWrongValue, ::testing::ValuesIn(wrong_values()),
                         [](const auto& c) { return c.param.name; });

}  // namespace
}  // namespace hbar
