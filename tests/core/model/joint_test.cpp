#include "hbar/core/model/joint.h"

#include <gtest/gtest.h>

#include <set>

#include "hbar/core/base/rotation.h"
#include "tests/core/model/joint_definition.h"
#include "tests/support/numerics.h"
#include "tests/support/random_model.h"

namespace hbar {
namespace {

using testing::Random;
using testing::relative_gap;

struct Row {
  std::string type;
  std::vector<std::string> coordinates;
  std::vector<bool> angles;
};

/// The table of joints in scene_format.md, in the order of every_joint.
const std::vector<Row>& rows() {
  static const std::vector<Row> table = {
      {"fixed", {}, {}},
      {"revolute", {"theta"}, {true}},
      {"prismatic", {"d"}, {false}},
      {"planar", {"d0", "d1"}, {false, false}},
      {"translational", {"x", "y", "z"}, {false, false, false}},
      {"free2d", {"x", "y", "theta"}, {false, false, true}},
      {"spherical-euler", {"a", "b", "c"}, {true, true, true}},
      {"spherical-exp", {"rx", "ry", "rz"}, {true, true, true}},
      {"free3d-euler", {"x", "y", "z", "a", "b", "c"}, {false, false, false, true, true, true}},
      {"free3d-exp", {"x", "y", "z", "rx", "ry", "rz"}, {false, false, false, true, true, true}},
      {"universal", {"a", "b"}, {true, true}},
  };
  return table;
}

/// The pose that a chain of elementary motions reaches at q.
RigidTransform<double> compose(const std::vector<ElementaryMotion>& motions,
                               const Eigen::VectorXd& q) {
  RigidTransform<double> X;
  int c = 0;
  for (const ElementaryMotion& motion : motions) {
    RigidTransform<double> step;
    if (motion.kind == MotionKind::kRotation) {
      step.R = axis_rotation(motion.axis, q[c]);
    } else if (motion.kind == MotionKind::kTranslation) {
      step.p = q[c] * motion.axis;
    } else if (motion.kind == MotionKind::kExponential) {
      step.R = exp_rotation<double>(q.segment<3>(c));
    }
    X = X * step;
    c += motion_dof(motion.kind);
  }
  return X;
}

TEST(EveryJoint, IsARowOfTheSceneFormatWithItsNamesAndUnits) {
  Random random(1);
  const std::vector<JointKind> kinds = testing::every_joint(random);
  ASSERT_EQ(kinds.size(), std::variant_size_v<JointKind>);
  ASSERT_EQ(kinds.size(), rows().size());
  std::set<std::size_t> alternatives;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const Row& row = rows()[i];
    alternatives.insert(kinds[i].index());
    EXPECT_EQ(joint_type(kinds[i]), row.type);
    EXPECT_EQ(coordinate_names(kinds[i]), row.coordinates) << row.type;
    EXPECT_EQ(joint_dof(kinds[i]), static_cast<int>(row.coordinates.size())) << row.type;
    for (std::size_t c = 0; c < row.angles.size(); ++c) {
      EXPECT_EQ(is_angle(kinds[i], static_cast<int>(c)), row.angles[c]) << row.type << ' ' << c;
    }
  }
  EXPECT_EQ(alternatives.size(), kinds.size());
}

TEST(EveryJoint, IsAChainOfElementaryMotionsThatReachesItsDefinition) {
  Random random(2);
  for (int k = 0; k < 10; ++k) {
    for (const JointKind& kind : testing::every_joint(random)) {
      const std::vector<ElementaryMotion> motions = elementary_motions(kind);
      int dof = 0;
      for (const ElementaryMotion& motion : motions) {
        dof += motion_dof(motion.kind);
      }
      ASSERT_EQ(dof, joint_dof(kind)) << joint_type(kind);
      const Eigen::VectorXd q = random.vector(dof, 2.0);
      const RigidTransform<double> X = compose(motions, q);
      const RigidTransform<double> defined = testing::JointDefinition(q).of(kind);
      EXPECT_LT(relative_gap(X.R, defined.R), 1e-14) << joint_type(kind);
      EXPECT_LT(testing::largest((X.p - defined.p).eval()), 1e-15) << joint_type(kind);
    }
  }
}

TEST(EveryJoint, ComparesByKindAndAxes) {
  Random random(3);
  const std::vector<JointKind> kinds = testing::every_joint(random);
  const std::vector<JointKind> others = testing::every_joint(random);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = 0; j < kinds.size(); ++j) {
      EXPECT_EQ(kinds[i] == kinds[j], i == j);
    }
    const bool has_axis = std::visit(
        [](const auto& joint) {
          return requires { joint.axis; }
          || requires { joint.axis0; };
        },
        kinds[i]);
    EXPECT_EQ(kinds[i] == others[i], !has_axis) << joint_type(kinds[i]);
  }
}

TEST(Joint, ComparesEveryField) {
  const Joint joint{.name = "j",
                    .kind = RevoluteJoint{},
                    .X_PJ = {},
                    .damping = 1.0,
                    .stiffness = 2.0,
                    .rest = Eigen::VectorXd::Ones(1),
                    .limits = JointLimits{-1.0, 1.0, 3.0}};
  const auto changed = [&joint](const auto& change) {
    Joint other = joint;
    change(other);
    return other;
  };
  EXPECT_TRUE(joint == changed([](Joint&) {}));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.name = "k"; }));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.kind = PrismaticJoint{}; }));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.X_PJ.p.x() = 1.0; }));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.damping = 0.0; }));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.stiffness = 0.0; }));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.rest[0] = 0.0; }));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.rest = Eigen::VectorXd::Ones(2); }));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.limits->stiffness = 4.0; }));
  EXPECT_FALSE(joint == changed([](Joint& j) { j.limits.reset(); }));
}

}  // namespace
}  // namespace hbar
