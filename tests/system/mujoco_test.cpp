/// MuJoCo as an independent reference: mass matrices, bias forces and inverse dynamics of the same
/// trees.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <sstream>

#include "hbar/core/base/rotation.h"
#include "hbar/core/dynamics/dynamics.h"
#include "hbar/core/model/model_builder.h"
#include "tests/support/duals.h"
#include "tests/support/numerics.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"

namespace hbar {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::Random;
using testing::relative_gap;

constexpr int kStates = 100;
constexpr double kTolerance = 1e-10;

/// A link as both sides are told it. MuJoCo's body frame is hbar's joint frame.
struct Part {
  int parent = -1;
  JointKind kind;
  Eigen::Quaterniond q_PJ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_PJ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_JB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_JB = Eigen::Vector3d::Zero();
  double mass = 1.0;
  Eigen::Vector3d inertia = Eigen::Vector3d::Ones();
};

struct TreeOfParts {
  std::string name;
  std::vector<Part> parts;
  Eigen::Vector3d gravity;
};

Part random_part(int parent, const JointKind& kind, Random& random) {
  const auto turn = [&random] {
    return Eigen::Quaterniond(Eigen::AngleAxisd(random.between(-3.0, 3.0), random.direction()));
  };
  Part part{parent,
            kind,
            turn(),
            random.vector3(0.5),
            turn(),
            random.vector3(0.3),
            random.between(0.5, 2.0)};
  const Eigen::Vector3d spread(random.between(0.05, 0.3), random.between(0.05, 0.3),
                               random.between(0.05, 0.3));
  part.inertia = Eigen::Vector3d::Constant(spread.sum()) - spread;
  return part;
}

TreeOfParts serial_chain() {
  Random random(1);
  TreeOfParts tree{"serial chain", {}, random.vector3(9.81)};
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d axis = random.direction();
    const JointKind kind =
        i % 3 == 2 ? JointKind(PrismaticJoint{axis}) : JointKind(RevoluteJoint{axis});
    tree.parts.push_back(random_part(i - 1, kind, random));
  }
  return tree;
}

/// A wrist of three hinges and five fingers of four.
TreeOfParts hand() {
  Random random(2);
  TreeOfParts tree{"hand", {}, random.vector3(9.81)};
  for (int i = 0; i < 3; ++i) {
    tree.parts.push_back(random_part(i - 1, RevoluteJoint{random.direction()}, random));
  }
  for (int i = 0; i < 20; ++i) {
    const int parent = i % 4 == 0 ? 2 : i + 2;
    tree.parts.push_back(random_part(parent, RevoluteJoint{random.direction()}, random));
  }
  return tree;
}

TreeOfParts floating_tree() {
  Random random(3);
  TreeOfParts tree{"floating tree", {}, random.vector3(9.81)};
  const std::vector<std::pair<int, JointKind>> shape = {
      {-1, Free3dExpJoint{}},
      {0, SphericalExpJoint{}},
      {1, RevoluteJoint{random.direction()}},
      {2, SphericalEulerJoint{}},
      {0, PrismaticJoint{random.direction()}},
      {4, SphericalExpJoint{}},
      {4, FixedJoint{}},
      {6, RevoluteJoint{random.direction()}},
  };
  for (const auto& [parent, kind] : shape) {
    tree.parts.push_back(random_part(parent, kind, random));
  }
  tree.parts[0].q_PJ.setIdentity();
  tree.parts[0].p_PJ.setZero();
  return tree;
}

std::string name_of(std::size_t part) { return "part" + std::to_string(part); }

Model hbar_model(const TreeOfParts& tree) {
  ModelBuilder builder(tree.name);
  builder.set_gravity(tree.gravity);
  for (std::size_t i = 0; i < tree.parts.size(); ++i) {
    const Part& part = tree.parts[i];
    Joint joint{.name = name_of(i), .kind = part.kind};
    joint.X_PJ = {part.q_PJ.toRotationMatrix(), part.p_PJ};
    const Body body{.name = name_of(i),
                    .X_JB = {part.q_JB.toRotationMatrix(), part.p_JB},
                    .mass = part.mass,
                    .inertia = part.inertia};
    builder.add_link(part.parent, joint, body);
  }
  return builder.build();
}

std::string text(const Eigen::Vector3d& v) {
  std::ostringstream out;
  out.precision(17);
  out << v.x() << ' ' << v.y() << ' ' << v.z();
  return out.str();
}

std::string text(const Eigen::Quaterniond& q) {
  std::ostringstream out;
  out.precision(17);
  out << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z();
  return out.str();
}

std::string joint_element(const JointKind& kind, const std::string& name) {
  const std::string head = "<joint name='" + name + "' type=";
  if (const auto* hinge = std::get_if<RevoluteJoint>(&kind)) {
    return head + "'hinge' axis='" + text(hinge->axis) + "'/>";
  }
  if (const auto* slide = std::get_if<PrismaticJoint>(&kind)) {
    return head + "'slide' axis='" + text(slide->axis) + "'/>";
  }
  if (std::holds_alternative<Free3dExpJoint>(kind)) {
    return "<freejoint name='" + name + "'/>";
  }
  return std::holds_alternative<FixedJoint>(kind) ? "" : head + "'ball'/>";
}

void write_bodies(const TreeOfParts& tree, int parent, std::ostream& out) {
  for (std::size_t i = 0; i < tree.parts.size(); ++i) {
    const Part& part = tree.parts[i];
    if (part.parent != parent) {
      continue;
    }
    out << "<body pos='" << text(part.p_PJ) << "' quat='" << text(part.q_PJ) << "'>"
        << joint_element(part.kind, name_of(i)) << "<inertial pos='" << text(part.p_JB)
        << "' quat='" << text(part.q_JB) << "' mass='" << part.mass << "' diaginertia='"
        << text(part.inertia) << "'/>\n";
    write_bodies(tree, static_cast<int>(i), out);
    out << "</body>\n";
  }
}

std::string mjcf(const TreeOfParts& tree) {
  std::ostringstream out;
  out.precision(17);
  out << "<mujoco><compiler angle='radian' inertiafromgeom='false'/><option gravity='"
      << text(tree.gravity) << "'><flag contact='disable' constraint='disable'/></option>"
      << "<worldbody>\n";
  write_bodies(tree, -1, out);
  out << "</worldbody></mujoco>\n";
  return out.str();
}

/// Angular velocity of a joint's frame in its own axes per unit rate.           [3 x 3]
template <Scalar S>
Matrix3<S> ball_map(const JointKind& kind, const Vector3<S>& r) {
  if (!std::holds_alternative<SphericalEulerJoint>(kind)) {
    return right_jacobian(r);
  }
  // R = Rx Ry Rz: each axis seen from behind the rotations that follow it.
  const Matrix3<S> Rz = axis_rotation<S>(Eigen::Vector3d::UnitZ(), r[2]);
  const Matrix3<S> Ry = axis_rotation<S>(Eigen::Vector3d::UnitY(), r[1]);
  Matrix3<S> map;
  map.col(0) = Rz.transpose() * Ry.transpose() * Vector3<S>::UnitX();
  map.col(1) = Rz.transpose() * Vector3<S>::UnitY();
  map.col(2) = Vector3<S>::UnitZ();
  return map;
}

/// One tree in MuJoCo, spoken to in hbar's coordinates.
class Witness {
 public:
  explicit Witness(const TreeOfParts& tree) : tree_(tree), hbar_(hbar_model(tree)) {
    const scene::TemporaryFolder folder;
    const std::string file = folder / "tree.xml";
    std::ofstream(file) << mjcf(tree);
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
    if (!model_) {
      throw std::runtime_error(error.data());
    }
    data_.reset(mj_makeData(model_.get()));
  }

  [[nodiscard]] const Model& hbar() const { return hbar_; }
  [[nodiscard]] int dof() const { return model_->nv; }

  /// MuJoCo's velocities by hbar's rates: v = B(q) q̇.                       [dof x dof]
  template <Scalar S>
  [[nodiscard]] MatrixX<S> velocity_map(const VectorX<S>& q) const {
    MatrixX<S> B = MatrixX<S>::Zero(dof(), dof());
    for_each_joint([&](int link, int joint) {
      const CoordinateRange range = hbar_.coordinates_of_link(link);
      const int row = model_->jnt_dofadr[joint];
      if (range.end - range.begin == 1) {
        B(row, range.begin) = S(1.0);
        return;
      }
      const int first = range.end - 3;
      if (range.end - range.begin == 6) {
        B.template block<3, 3>(row, range.begin).setIdentity();
      }
      B.template block<3, 3>(row + first - range.begin, first) =
          ball_map<S>(hbar_.link(link).joint.kind, q.template segment<3>(first));
    });
    return B;
  }

  /// Sets MuJoCo's positions, velocities and accelerations, and computes both directions.
  void evaluate(const VectorXd& q, const VectorXd& v, const VectorXd& v_dot) {
    for_each_joint([&](int link, int joint) {
      const CoordinateRange range = hbar_.coordinates_of_link(link);
      double* at = data_->qpos + model_->jnt_qposadr[joint];
      if (range.end - range.begin == 1) {
        *at = q[range.begin];
        return;
      }
      if (range.end - range.begin == 6) {
        Eigen::Map<Eigen::Vector3d>(at, 3) = q.segment<3>(range.begin);
        at += 3;
      }
      const Eigen::Vector3d r = q.segment<3>(range.end - 3);
      const bool euler = std::holds_alternative<SphericalEulerJoint>(hbar_.link(link).joint.kind);
      const Eigen::Quaterniond turn =
          euler ? Eigen::AngleAxisd(r[0], Eigen::Vector3d::UnitX()) *
                      Eigen::AngleAxisd(r[1], Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(r[2], Eigen::Vector3d::UnitZ())
                : Eigen::Quaterniond(Eigen::AngleAxisd(r.norm(), r.normalized()));
      Eigen::Map<Eigen::Vector4d>(at, 4) << turn.w(), turn.x(), turn.y(), turn.z();
    });
    Eigen::Map<VectorXd>(data_->qvel, dof()) = v;
    mj_forward(model_.get(), data_.get());
    Eigen::Map<VectorXd>(data_->qacc, dof()) = v_dot;
    mj_inverse(model_.get(), data_.get());
  }

  [[nodiscard]] MatrixXd mass_matrix() const {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> M(dof(), dof());
    mj_fullM(model_.get(), M.data(), data_->qM);
    return M;
  }
  [[nodiscard]] VectorXd bias() const { return Eigen::Map<VectorXd>(data_->qfrc_bias, dof()); }
  [[nodiscard]] VectorXd inverse() const {
    return Eigen::Map<VectorXd>(data_->qfrc_inverse, dof());
  }

 private:
  struct Free {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  template <typename Visit>
  void for_each_joint(const Visit& visit) const {
    for (int link = 0; link < hbar_.link_count(); ++link) {
      const auto part = static_cast<std::size_t>(link);
      if (joint_dof(tree_.parts[part].kind) > 0) {
        visit(link, mj_name2id(model_.get(), mjOBJ_JOINT, name_of(part).c_str()));
      }
    }
  }

  const TreeOfParts& tree_;
  Model hbar_;
  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
};

/// hbar's M and ID at a state.
struct Dynamic {
  Dynamic(const Model& model, const VectorXd& q, const VectorXd& qdot, const VectorXd& a)
      : M(MatrixXd::Zero(model.dof(), model.dof())), tau(VectorXd::Zero(model.dof())) {
    const auto mechanism = nominal_mechanism<double>(model);
    Motion<double> motion(model.tree());
    Dynamics<double> dynamics(model);
    compute_motion<double>(model.tree(), mechanism, q, qdot, a, motion);
    subtree_dynamics<double>(model, mechanism, motion, dynamics, tau);
    hbar::mass_matrix<double>(model, motion, dynamics, M);
  }
  MatrixXd M;
  VectorXd tau;
};

class EveryTree : public ::testing::TestWithParam<TreeOfParts> {};

TEST_P(EveryTree, HasMujocosMassMatrixBiasForcesAndInverseDynamics) {
  Witness mujoco(GetParam());
  const Model& model = mujoco.hbar();
  ASSERT_EQ(model.dof(), mujoco.dof());
  Random random(7);
  double worst = 0.0;
  for (int k = 0; k < kStates; ++k) {
    const VectorXd q = random.vector(model.dof(), 1.5);
    const VectorXd qdot = random.vector(model.dof(), 2.0);
    const VectorXd a = random.vector(model.dof(), 3.0);
    // v = B q̇, v̇ = B a + Ḃ q̇, and forces go back by Bᵀ.
    const MatrixXd B = mujoco.velocity_map<double>(q);
    const VectorXd B_dot_qdot =
        testing::slopes(mujoco.velocity_map<Dual>(testing::with_slope(q, qdot))) * qdot;
    mujoco.evaluate(q, B * qdot, B * a + B_dot_qdot);
    const Dynamic moving(model, q, qdot, a);
    const Dynamic coasting(model, q, qdot, VectorXd::Zero(model.dof()));
    const VectorXd bias = B.transpose() * (mujoco.bias() + mujoco.mass_matrix() * B_dot_qdot);
    const double M_gap = relative_gap(moving.M, B.transpose() * mujoco.mass_matrix() * B);
    const double bias_gap = relative_gap(coasting.tau, bias);
    const double inverse_gap = relative_gap(moving.tau, B.transpose() * mujoco.inverse());
    EXPECT_LT(M_gap, kTolerance);
    EXPECT_LT(bias_gap, kTolerance);
    EXPECT_LT(inverse_gap, kTolerance);
    worst = std::max({worst, M_gap, bias_gap, inverse_gap});
  }
  RecordProperty("worst_relative_gap", std::to_string(worst * 1e15) + "e-15");
}

INSTANTIATE_TEST_SUITE_P(Trees, EveryTree,
                         ::testing::Values(serial_chain(), hand(), floating_tree()),
                         [](const auto& instance) {
                           std::string name = instance.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace hbar
