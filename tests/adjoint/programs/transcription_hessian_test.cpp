// What every transcription's Hessian begins with, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hbar/adjoint/programs/transcribe.h"
#include "hbar/core/base/error.h"
#include "tests/adjoint/programs/transcription_problems.h"
#include "tests/support/dense_nlp.h"
#include "tests/support/message_of.h"

namespace hbar {
namespace {

using solvers::HessianKind;
using testing::message_of;

class EveryFormulationsHessian : public ::testing::TestWithParam<Formulation> {
 protected:
  [[nodiscard]] std::unique_ptr<Transcription> transcribed(const TrajectoryProblem& problem) const {
    return transcribe(problem, {.formulation = GetParam(), .segments = 2, .threads = 1});
  }
};

/// With T the derivatives of every number of the trajectory by x, from the Jacobian of rows that
/// are these numbers, and S the objective's second partials: Tᵀ S T and the design's own weight.
TEST_P(EveryFormulationsHessian, OfGaussNewtonIsBuiltOfPartialsAndDerivatives) {
  TrajectoryProblem problem = testing::small_transcription("bdf2", 5, true);
  problem.constraints = {testing::every_number(problem.horizon)};
  const auto nlp = transcribed(problem);
  const Eigen::VectorXd x = testing::near_start(*nlp, 1e-2, 9);
  const TrajectoryValues values = nlp->trajectory_values(x);
  const std::vector<ValuePlace> places = all_places(values);
  const auto count = static_cast<Eigen::Index>(places.size());
  const auto place_of = [&](const ValuePlace& place) {
    return std::find(places.begin(), places.end(), place) - places.begin();
  };
  const std::vector<SecondPlace> second_places = problem.objective.second_places(values);
  const Eigen::VectorXd second = problem.objective.second_partials(values);
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(count, count);
  for (std::size_t i = 0; i < second_places.size(); ++i) {
    const Eigen::Index a = place_of(second_places[i].a);
    const Eigen::Index b = place_of(second_places[i].b);
    S(a, b) += second[static_cast<Eigen::Index>(i)];
    S(b, a) += a != b ? second[static_cast<Eigen::Index>(i)] : 0.0;
  }
  const Eigen::MatrixXd T = testing::dense_jacobian(*nlp, x).topRows(count);
  const double sigma = 0.6;
  Eigen::MatrixXd expected = sigma * T.transpose() * S * T;
  const DesignVariables& design = problem.map->variables();
  expected.diagonal().head(design.size()) +=
      sigma * problem.design_weight * design.scale.cwiseAbs2().cwiseInverse();
  const Eigen::VectorXd lambda =
      Eigen::VectorXd::Constant(nlp->constraint_limits().lower.size(), 3.0);  // not read
  EXPECT_LT(
      testing::relative_gap(
          testing::dense_hessian(*nlp, x, sigma, lambda, HessianKind::kGaussNewton), expected),
      1e-12);
}

TEST_P(EveryFormulationsHessian, IsRefusedWhereATermHasNoSecondPartials) {
  TrajectoryProblem problem = testing::small_transcription("bdf1", 6, false);
  problem.objective.add(user_term(
      "handmade", [](const TrajectoryValues& values) { return std::cos(values.q(6, 6)); },
      [](const TrajectoryValues& values, TrajectoryPartials& partials) {
        partials.q(6, 6) -= std::sin(values.q(6, 6));
      }));
  const auto nlp = transcribed(problem);
  for (const HessianKind kind : {HessianKind::kExact, HessianKind::kGaussNewton}) {
    EXPECT_NE(message_of<InvalidInput>([&] {
                static_cast<void>(nlp->hessian_pattern(kind));
              }).find("'handmade'"),
              std::string::npos);
  }
  EXPECT_NO_THROW(solvers::validate_hessian(*nlp, HessianKind::kLimitedMemory));
  EXPECT_TRUE(testing::gradient_of(*nlp, nlp->variables().start).allFinite());
}

TEST_P(EveryFormulationsHessian, OfGaussNewtonDoesNotAskConstraintsAndTheDesignMap) {
  TrajectoryProblem problem = testing::small_transcription("bdf1", 6, false);
  const ConstraintRows rows{
      {"handmade row"}, Eigen::VectorXd::Constant(1, -9.0), Eigen::VectorXd::Constant(1, 9.0)};
  const ConstraintPointer row = user_constraint(
      rows, {{0, ValueField::kQ, 6, 6}},
      [](const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> c) {
        c[0] = std::cos(values.q(6, 6));
      },
      [](const TrajectoryValues& values, Eigen::Ref<Eigen::VectorXd> partials) {
        partials[0] = -std::sin(values.q(6, 6));
      });
  problem.constraints.push_back(row);
  const auto with_row = transcribed(problem);
  EXPECT_NO_THROW(static_cast<void>(with_row->hessian_pattern(HessianKind::kGaussNewton)));
  EXPECT_NE(message_of<InvalidInput>([&] {
              static_cast<void>(with_row->hessian_pattern(HessianKind::kExact));
            }).find("handmade row"),
            std::string::npos);

  /// Parameters as they are, of which nobody says how they bend.
  class Unbent final : public DesignMap {
   public:
    explicit Unbent(const ParameterSet& set) : map_(parameter_map(set)) {}
    [[nodiscard]] const DesignVariables& variables() const override { return map_->variables(); }
    [[nodiscard]] Eigen::Index parameter_count() const override { return map_->parameter_count(); }
    [[nodiscard]] Eigen::VectorXd parameters(const Eigen::VectorXd& d) const override { return d; }
    [[nodiscard]] Eigen::MatrixXd jacobian(const Eigen::VectorXd& d) const override {
      return map_->jacobian(d);
    }

   private:
    DesignMapPointer map_;
  };
  problem.constraints.pop_back();
  problem.map = std::make_shared<Unbent>(problem.horizon.parameters());
  const auto with_map = transcribed(problem);
  EXPECT_NO_THROW(static_cast<void>(with_map->hessian_pattern(HessianKind::kGaussNewton)));
  EXPECT_NE(message_of<InvalidInput>([&] {
              static_cast<void>(with_map->hessian_pattern(HessianKind::kExact));
            }).find("design map"),
            std::string::npos);
}

TEST_P(EveryFormulationsHessian, OfLimitedMemoryIsTheOptimisersOwn) {
  const auto nlp = transcribed(testing::small_transcription("bdf1", 6, false));
  EXPECT_EQ(message_of<InvalidInput>(
                [&] { static_cast<void>(nlp->hessian_pattern(HessianKind::kLimitedMemory)); }),
            "transcription: a limited-memory Hessian is the optimiser's own");
}

INSTANTIATE_TEST_SUITE_P(All, EveryFormulationsHessian,
                         ::testing::Values(Formulation::kShooting, Formulation::kMultipleShooting,
                                           Formulation::kAllAtOnce));

}  // namespace
}  // namespace hbar
