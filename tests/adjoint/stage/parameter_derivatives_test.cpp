#include "hbar/adjoint/stage/parameter_derivatives.h"

#include <gtest/gtest.h>

#include <set>

#include "hbar/core/parameters/parameter_kinds.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Random;
using testing::relative_gap;

class EveryModelsParameters : public ::testing::TestWithParam<unsigned> {
 protected:
  /// Linearises at a random point.
  void linearize() {
    point = testing::random_point(model, random);
    apply_parameters<double>(model, set, p, mechanism);
    VectorXd g = VectorXd::Zero(model.dof());
    stage.linearize(mechanism, point, g);
  }
  MatrixXd columns() const {
    MatrixXd out = MatrixXd::Zero(model.dof(), set.size());
    parameter_columns<double>({mechanism, set, p}, stage, point, out);
    return out;
  }
  VectorXd residual_at(const VectorXd& values) {
    Mechanism<double> other = mechanism;
    apply_parameters<double>(model, set, values, other);
    VectorXd g = VectorXd::Zero(model.dof());
    StageResidual<double>(model).residual(other, point, g);
    return g;
  }
  MatrixXd by_duals() const {
    auto dual = nominal_mechanism<Dual>(model);
    StageResidual<Dual> residual(model);
    const StagePoint<Dual> at = testing::as_dual(model, point);
    return testing::dual_jacobian(
        [&](const VectorX<Dual>& values) -> VectorX<Dual> {
          apply_parameters<Dual>(model, set, values, dual);
          VectorX<Dual> g = VectorX<Dual>::Zero(model.dof());
          residual.residual(dual, at, g);
          return g;
        },
        p);
  }
  /// Expects each kind's columns to agree, relative to the largest entry of that kind.
  void expect_kinds_agree(const MatrixXd& found, const MatrixXd& expected, double tolerance) const {
    for (const ParameterKindRow& row_of_kind : parameter_kinds()) {
      const ParameterKind kind = row_of_kind.kind;
      std::vector<int> mine;
      for (int i = 0; i < set.size(); ++i) {
        if (set[i].kind == kind) {
          mine.push_back(i);
        }
      }
      ASSERT_FALSE(mine.empty()) << kind_name(kind);
      const MatrixXd part = expected(Eigen::all, mine);
      EXPECT_GT(testing::largest(part), 0.0) << kind_name(kind);
      EXPECT_LT(relative_gap(found(Eigen::all, mine), part), tolerance) << kind_name(kind);
    }
  }

  const Model model = testing::random_contact_model(GetParam());
  const ParameterSet set = ParameterSet::all(model);
  Random random{GetParam()};
  VectorXd p = testing::random_parameters(set, random);
  Mechanism<double> mechanism = nominal_mechanism<double>(model);
  StageResidual<double> stage{model};
  StagePoint<double> point{model};
};

TEST_P(EveryModelsParameters, HaveTheColumnsThatDualsGiveKindByKind) {
  for (int k = 0; k < 3; ++k) {
    linearize();
    expect_kinds_agree(columns(), by_duals(), 1e-12);
  }
}

TEST_P(EveryModelsParameters, HaveTheColumnsThatDualsGiveAtNominalValues) {
  p = set.nominal();
  linearize();
  expect_kinds_agree(columns(), by_duals(), 1e-12);
}

TEST_P(EveryModelsParameters, HaveTheColumnsThatDifferencesGive) {
  linearize();
  const MatrixXd expected =
      testing::differences([&](const VectorXd& values) { return residual_at(values); }, p, 1e-3);
  // A motor whose saturation lies within the step is left to the duals.
  MatrixXd found = columns();
  expect_kinds_agree(found, expected, 1e-8);
}

TEST_P(EveryModelsParameters, HaveARemainderOfSecondOrder) {
  linearize();
  const VectorXd z = random.vector(model.dof());
  VectorXd d = VectorXd::Zero(set.size());
  for (int i = 0; i < set.size(); ++i) {
    d[i] = random.between(-0.05, 0.05);
  }
  const auto along = [&](double e) { return z.dot(residual_at(p + e * d)); };
  // Small enough that no contact starts, ends or slips on the way.
  EXPECT_NEAR(testing::taylor_slope(along, z.dot(columns() * d), 1e-2), 2.0, 0.05);
}

TEST_P(EveryModelsParameters, HaveAGradientThatIsTheTransposeOfTheirColumns) {
  for (int k = 0; k < 3; ++k) {
    linearize();
    const VectorXd z = random.vector(model.dof());
    stage.pull_back(z);
    const VectorXd before = random.vector(set.size());
    VectorXd gradient = before;
    add_parameter_gradient<double>({mechanism, set, p}, stage, point, z, -2.5, gradient);
    const VectorXd expected = -2.5 * columns().transpose() * z;
    EXPECT_LT(testing::largest((gradient - before - expected).eval()),
              1e-13 * (testing::largest(expected) + 1.0));
  }
}

TEST_P(EveryModelsParameters, TouchExactlyTheRowsTheyOwn) {
  std::vector<std::set<int>> touched(set.blocks().size());
  for (int k = 0; k < 8; ++k) {
    linearize();
    const MatrixXd exact = by_duals();
    for (std::size_t b = 0; b < touched.size(); ++b) {
      const ParameterBlock& block = set.blocks()[b];
      for (int l = 0; l < model.dof(); ++l) {
        if (testing::largest(exact.row(l).segment(block.first, block.size)) != 0.0) {
          touched[b].insert(l);
        }
      }
    }
  }
  for (std::size_t b = 0; b < touched.size(); ++b) {
    const ParameterBlock& block = set.blocks()[b];
    const std::vector<int> rows = parameter_rows(model, block);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    const std::string name = set[block.first].name;
    for (const int l : touched[b]) {
      EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), l)) << name << " row " << l;
    }
    // Which contacts happen to touch is not for rows to know.
    const bool contact =
        block.kind != ParameterKind::kStiffness && block.kind != ParameterKind::kDamping &&
        block.kind != ParameterKind::kMass && block.kind != ParameterKind::kInertia &&
        block.kind != ParameterKind::kMotorP && block.kind != ParameterKind::kMotorD &&
        block.kind != ParameterKind::kGravity;
    if (contact) {
      continue;
    }
    for (const int l : rows) {
      // A moment of inertia gives no force, so that a translation never feels it.
      const bool never =
          block.kind == ParameterKind::kInertia &&
          model.tree().node(model.tree().node_of(l)).motion == MotionKind::kTranslation;
      if (!never) {
        EXPECT_TRUE(touched[b].contains(l)) << name << " row " << l;
      }
    }
  }
}

TEST_P(EveryModelsParameters, LeaveOtherRowsAlone) {
  linearize();
  MatrixXd out = MatrixXd::Constant(model.dof(), set.size(), 123.0);
  parameter_columns<double>({mechanism, set, p}, stage, point, out);
  for (const ParameterBlock& block : set.blocks()) {
    const std::vector<int> rows = parameter_rows(model, block);
    for (int l = 0; l < model.dof(); ++l) {
      if (!std::binary_search(rows.begin(), rows.end(), l)) {
        EXPECT_EQ(out(l, block.first), 123.0);
      }
    }
  }
}

TEST_P(EveryModelsParameters, KeepTheirDerivativesInASmallerSet) {
  // Components alone, in blocks that are not whole, at the same values.
  linearize();
  const std::vector<std::string> names = {"joint.j3.rotation.z", "joint.j3.translation.y",
                                          "body.b5.translation", "body.b5.inertia.y",
                                          "joint.j1.damping",    "gravity.z"};
  const ParameterSet few = ParameterSet::named(model, names);
  p = set.nominal();
  VectorXd p_few = few.nominal();
  for (int i = 0; i < few.size(); ++i) {
    p_few[i] += 0.01 * (i + 1);
    p[set.find(few[i].name)] = p_few[i];
  }
  apply_parameters<double>(model, set, p, mechanism);
  VectorXd g = VectorXd::Zero(model.dof());
  stage.linearize(mechanism, point, g);
  MatrixXd out = MatrixXd::Zero(model.dof(), few.size());
  parameter_columns<double>({mechanism, few, p_few}, stage, point, out);
  const MatrixXd every = columns();
  for (int i = 0; i < few.size(); ++i) {
    EXPECT_EQ(out.col(i), every.col(set.find(few[i].name))) << few[i].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryModelsParameters, ::testing::Values(1U, 2U, 3U));

}  // namespace
}  // namespace hbar
