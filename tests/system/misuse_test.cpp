// Things that do not belong together: each is refused, with what was expected instead.
#include "tests/system/misuse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "hbar/adjoint/derivatives/assembled_adjoint.h"
#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/derivatives/second_order.h"
#include "hbar/adjoint/derivatives/tangent.h"
#include "hbar/adjoint/design/affine_map.h"
#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/adjoint/systems/trajectory_system.h"
#include "hbar/adjoint/terms/constraint_terms.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/base/error.h"
#include "hbar/core/model/model_builder.h"
#include "tests/support/message_of.h"

namespace hbar {
namespace {

using testing::misuse::chain;
using testing::misuse::failed;
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

/// Everything that takes a trajectory, given one that is not of `of`.
void use(const Horizon& of, const Trajectory& other, int way) {
  switch (way) {
    case 0:
      static_cast<void>(gradient(of, other, objective()));
      break;
    case 1:
      static_cast<void>(gradient(of, other, objective(), solver_factory("klu")));
      break;
    case 2:
      static_cast<void>(TangentSweep(of).push_forward(other, Directions::zero(of, 1)));
      break;
    case 3:
      HessianProduct(of, objective()).set_point(other);
      break;
    case 4:
      static_cast<void>(Linearizer(of).linearize(other));
      break;
    default:
      static_cast<void>(read_values(of, other));
  }
}

std::vector<Misuse> of_models_and_options() {
  return {{"AnotherModelsParameters", [] { Horizon(two(), ParameterSet::all(three()), options()); },
           "the parameter set is of another model: 'two' has no parameter"},
          {"ParametersOfAHeavierTwin",
           [] {
             Horizon(chain(2, "two", 100.0), ParameterSet::named(two(), {"body.b0.mass"}),
                     options());
           },
           "the parameter set is of another model: body.b0.mass is 1 there and 0.125 in 'two'"},
          {"NoModel", [] { Horizon(std::shared_ptr<const Model>(), ParameterSet(), options()); },
           "horizon: there is no model (a null pointer)"},
          {"EmptyModel", [] { Horizon(Model(), ParameterSet(), options()); },
           "the model has no coordinate"},
          {"LinkOutOfRange", [] { static_cast<void>(two().link(9)); },
           "there is no link 9; they are 0 to 1"},
          {"LinkBelowRange", [] { static_cast<void>(two().link(-1)); }, "there is no link -1"},
          {"ContactOutOfRange", [] { static_cast<void>(two().contact(0)); },
           "there is no contact 0, as there is none at all"},
          {"ParameterOutOfRange", [] { static_cast<void>(set_of_two()[9]); },
           "there is no parameter 9; they are 0 to 1"},
          {"ToleranceThatIsNotFinite",
           [] {
             SimulationOptions wrong = options();
             wrong.newton.tol = std::numeric_limits<double>::quiet_NaN();
             Horizon(two(), ParameterSet(), wrong);
           },
           "newton: tol is nan"},
          {"NegativeRelativeTolerance",
           [] {
             SimulationOptions wrong = options();
             wrong.newton.rtol = -1e-12;
             Horizon(two(), ParameterSet(), wrong);
           },
           "rtol -1e-12"}};
}

std::vector<Misuse> of_problems() {
  return {{"NoObjectiveTerm", [] { Objective(nullptr); }, "objective: there is no term"},
          {"NoConstraint",
           [] {
             TrajectoryProblem wrong = problem();
             wrong.constraints = {variable_at_step(two(), "tip", 3, {0.0, 0.0, -1.0}), nullptr};
             static_cast<void>(transcribe(wrong));
           },
           "TrajectoryProblem: there is no constraint 1"},
          {"NoMap",
           [] {
             TrajectoryProblem wrong = problem();
             wrong.map = nullptr;
             static_cast<void>(transcribe(wrong));
           },
           "TrajectoryProblem: there is no map from designs to parameters"},
          {"MapOfAnotherSet",
           [] {
             TrajectoryProblem wrong = problem();
             wrong.map = parameter_map(ParameterSet::all(three()));
             static_cast<void>(transcribe(wrong));
           },
           "the horizon has 2"},
          {"TermWithoutFunctions", [] { static_cast<void>(user_term("mine", {}, {})); },
           "user_term 'mine': there is no function of its value"},
          {"TermWithoutPartials",
           [] {
             static_cast<void>(user_term(
                 "mine", [](const TrajectoryValues& values) { return values.q.sum(); }, {}));
           },
           "user_term 'mine': there is no function of its partials"},
          {"ConstraintWithoutFunctions",
           [] {
             static_cast<void>(user_constraint(
                 {{"row"}, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)}, {}, {}, {}));
           },
           "user_constraint: there is no function of its values"}};
}

std::vector<Misuse> of_objects() {
  return {{"MovedFromSimulator",
           [] {
             Simulator simulator(horizon());
             const Simulator other = std::move(simulator);
             static_cast<void>(simulator.rollout(inputs(horizon())));  // NOLINT: what is tested
           },
           "Simulator: this object was moved from"},
          {"MovedFromSweep",
           [] {
             AdjointSweep sweep(horizon());
             const AdjointSweep other = std::move(sweep);
             static_cast<void>(sweep.gradient(trajectory(horizon()), objective()));  // NOLINT
           },
           "AdjointSweep: this object was moved from"},
          {"MovedFromTrajectory",
           [] {
             Trajectory moved = trajectory(horizon());
             const Trajectory other = std::move(moved);
             static_cast<void>(gradient(horizon(), moved, objective()));  // NOLINT
           },
           "the trajectory does not belong to this horizon: it is empty, or was moved from"},
          {"ProductWithoutAPoint",
           [] {
             const Horizon of = horizon();
             static_cast<void>(HessianProduct(of, Objective(effort())).along(inputs(of)));
           },
           "second order: there is no point yet; call set_point first"},
          {"ProductWithoutADirection",
           [] {
             const Horizon of = horizon();
             SecondOrderSweep sweep(of);
             const Trajectory at = trajectory(of);
             sweep.set_point(at, objective().partials(read_values(of, at)));
             static_cast<void>(sweep.product());
           },
           "second order: there is no direction yet; call push_forward first"},
          {"TamperedParameters",
           [] {
             Trajectory tampered = trajectory(horizon());
             tampered.inputs.p.resize(0);
             static_cast<void>(gradient(horizon(), tampered, objective()));
           },
           "its inputs are 0 parameters"}};
}

/// Trajectories of another horizon, or parts of one, given to all that takes one.
std::vector<Misuse> of_trajectories() {
  std::vector<Misuse> all;
  const std::vector<std::pair<std::string, std::function<void(int)>>> trajectories = {
      {"OfAnotherModel",
       [](int way) { use(horizon(), trajectory(Horizon(three(), {}, options())), way); }},
      {"OfOtherParameters",
       [](int way) { use(horizon(), trajectory(Horizon(two(), {}, options())), way); }},
      {"OfAsManyOthers",
       [](int way) {
         const auto others = ParameterSet::named(two(), {"body.b1.mass", "joint.j0.damping"});
         use(horizon(), trajectory(Horizon(two(), others, options())), way);
       }},
      {"OfAnotherTimeStep",
       [](int way) { use(horizon(), trajectory(horizon().with(options(0.05))), way); }},
      {"OfAnotherMethod",
       [](int way) {
         SimulationOptions other = options();
         other.integrator = "bdf1";
         use(horizon(), trajectory(horizon().with(other)), way);
       }},
      {"OfMoreSteps",
       [](int way) { use(horizon(), trajectory(horizon().with(options(0.01, 30))), way); }}};
  const std::vector<std::string> said = {"it is of another model, 'three'",
                                         "with 0 free parameters",
                                         "2 others",
                                         "20 steps end at 1, ",
                                         "its steps are bdf1's, the "
                                         "horizon's are bdf2's",
                                         "it has 30 steps"};
  const char* const ways[] = {"Gradient",       "AssembledGradient", "Tangent",
                              "HessianProduct", "Linearizer",        "Values"};
  for (int way = 0; way < 6; ++way) {
    for (std::size_t i = 0; i < trajectories.size(); ++i) {
      all.push_back({concat(ways[way], trajectories[i].first),
                     [call = trajectories[i].second, way] { call(way); }, said[i]});
    }
    if (way < 5) {  // values can be read of a part
      all.push_back({concat(ways[way], "OfAPart"),
                     [way] {
                       SimulationOptions wide = options(0.5);
                       use(horizon().with(wide), failed().partial(), way);
                     },
                     "steps; this needs a whole one"});
    }
  }
  return all;
}

/// Points, directions and multipliers of another program.
std::vector<Misuse> of_points() {
  const auto program = [](Formulation formulation) {
    TrajectoryProblem its = problem();
    its.constraints = {joint_limits(two(), {1}, 0.0)};
    return transcribe(its, {.formulation = formulation});
  };
  const auto shooting = [program] { return program(Formulation::kShooting); };
  const Eigen::VectorXd none;
  std::vector<Misuse> all = {
      {"DesignOfAShortPoint", [=] { static_cast<void>(shooting()->design(none)); },
       "transcription: x has 0 entries; it must have"},
      {"InputsOfALongPoint",
       [=] {
         const auto its = shooting();
         Eigen::VectorXd x = its->variables().start;
         x.conservativeResize(x.size() + 1);
         static_cast<void>(its->inputs(x));
       },
       "entries; it must have"},
      {"DirectionsOfAnotherCount",
       [=] {
         const Horizon of = horizon();
         Directions along = Directions::zero(of, 2);
         along.q0.resize(2, 1);
         static_cast<void>(TangentSweep(of).push_forward(trajectory(of), along));
       },
       "tangent: the directions by q0 are 2 x 1; they must be 2 x 2"},
      {"DirectionsOfAnotherModel",
       [=] {
         const Horizon of = horizon();
         Directions along = Directions::zero(of, 1);
         along.qdot0.resize(3, 1);
         static_cast<void>(TangentSweep(of).push_forward(trajectory(of), along));
       },
       "tangent: the directions by qdot0 are 3 x 1; they must be 2 x 1"}};
  for (const Formulation formulation : {Formulation::kShooting, Formulation::kAllAtOnce}) {
    all.push_back({concat("MultipliersOfAnotherProgramIn", all.size()),
                   [=] {
                     const auto its = program(formulation);
                     Eigen::VectorXd values;
                     its->lagrangian_hessian(its->variables().start, 1.0, Eigen::VectorXd(99),
                                             solvers::HessianKind::kExact, values);
                   },
                   "transcription: 99 multipliers; the program has"});
  }
  return all;
}

std::vector<Misuse> misuses() {
  std::vector<Misuse> all = of_models_and_options();
  for (const auto& more : {of_problems(), of_objects(), of_trajectories(), of_points()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

class EveryMisuse : public ::testing::TestWithParam<Misuse> {};

TEST_P(EveryMisuse, IsRefused) {
  const std::string message = testing::message_of<InvalidInput>(GetParam().call);
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << "message: " << message;
}

INSTANTIATE_TEST_SUITE_P(All, EveryMisuse, ::testing::ValuesIn(misuses()),
                         [](const auto& c) { return c.param.name; });

TEST(Ownership, WorksWithWhatItsOwnersAreGoneFrom) {
  auto of = std::make_unique<Horizon>(horizon());
  auto at = std::make_unique<Trajectory>(trajectory(*of));
  AdjointSweep sweep(*of);
  HessianProduct product(*of, Objective(effort()));
  const double expected = gradient(*of, *at, objective()).p[0];
  product.set_point(*at);
  const Inputs direction = inputs(*of);
  const double before = product.along(direction).value;
  EXPECT_NE(before, 0.0);
  const Trajectory copy = *at;
  at.reset();
  of.reset();
  EXPECT_EQ(sweep.gradient(copy, objective()).p[0], expected);
  EXPECT_EQ(product.along(direction).value, before);
}

TEST(Ownership, AMovedHorizonIsWhatItWas) {
  Horizon from = horizon();
  const Horizon to = std::move(from);
  EXPECT_EQ(trajectory(from).q, trajectory(to).q);  // NOLINT: a move is a copy
}

}  // namespace
}  // namespace hbar
