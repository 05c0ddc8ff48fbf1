// Runs of an independent implementation of differentiable RedMax (tests/golden/README.md), scene by
// scene and integrator by integrator: trajectories, variables, tactile readings, objective and
// every gradient.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/terms/objective_terms.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar {
namespace {

using nlohmann::json;

const std::filesystem::path kGolden = std::filesystem::path(HBAR_SOURCE_DIR) / "tests/golden";

std::vector<std::string> run_names() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kGolden / "runs")) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Eigen::VectorXd vector_of(const json& array) {
  const auto values = array.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Rows of numbers as the columns of a matrix.
Eigen::MatrixXd columns_of(const json& rows) {
  Eigen::MatrixXd out(rows.at(0).size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    out.col(static_cast<Eigen::Index>(k)) = vector_of(rows[k]);
  }
  return out;
}

double relative_norm(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / std::max(b.norm(), 1e-300);
}

/// One golden run, repeated by hbar.
class GoldenRun : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    std::ifstream file(kGolden / "runs" / (GetParam() + ".json"));
    golden_ = json::parse(file);
    const auto scene = scene::read_scene(kGolden / "scenes" / golden_.at("scene"));
    const Model model = scene::build_model(scene);
    SimulationOptions options;
    options.integrator = golden_.at("integrator");
    options.h = golden_.at("h");
    options.steps = golden_.at("steps");
    options.newton.tol = golden_.at("newton_tol");
    horizon_ = std::make_unique<Horizon>(model, ParameterSet::masked(model), options);
    inputs_ = horizon_->nominal_inputs();
    inputs_.q0 = vector_of(golden_.at("q0"));
    inputs_.qdot0 = vector_of(golden_.at("qdot0"));
    const double amplitude = golden_.at("control").at("amp");
    for (int k = 0; k < options.steps; ++k) {
      for (int i = 0; i < model.control_count(); ++i) {
        inputs_.u(i, k) = amplitude * std::sin(0.1 * k + i);
      }
    }
    tolerance_ = GetParam().find("mesh") == std::string::npos ? 1e-9 : 1e-6;
  }

  Objective objective() const {
    const std::string kind = golden_.at("objective_kind");
    if (kind.find("tactile") != std::string::npos) {
      return Objective(squared_tactile());
    }
    const bool variables = horizon_->model().variable_count() > 0;
    return Objective(variables ? squared_variables() : squared_final_position());
  }

  /// Whether a golden gradient is one of the same function. Meanings differ in two: raw 12-number
  /// gradients are consistent along rigid motions only, and the reference's s leaves contact
  /// damping alone where ours (13) scales it.
  bool comparable(const std::string& name) const {
    const auto damped = [](const Contact& contact) { return contact.coefficients.damping != 0.0; };
    const std::vector<Contact>& contacts = horizon_->model().contacts();
    return name != "dp1" && name != "dp2" &&
           (name != "dp6" || std::none_of(contacts.begin(), contacts.end(), damped));
  }

  /// What a gradient is held to. Where only differences are right, and those with steps 1e-5 and
  /// 1e-6 disagree by more than rounding, a point starts or stops sliding within the step: the
  /// force's slope jumps there, and differences mix both sides. They are worth no more than that.
  double gradient_bound(const std::string& name) const {
    const json& check = golden_.at("fd_check").at(name);
    if (check.at("pass")) {
      return std::max(tolerance_, 1e-7);
    }
    const double self_gap = check.at("fd_self_rel_err_1e-5_vs_1e-6");
    return std::max(1e-5, 2.0 * self_gap);
  }

  json golden_;
  std::unique_ptr<Horizon> horizon_;
  Inputs inputs_;
  double tolerance_ = 1e-9;
};

TEST_P(GoldenRun, HasTheSameTrajectoryVariablesAndObjective) {
  const Trajectory trajectory = simulate(*horizon_, inputs_).trajectory();
  const TrajectoryValues values = read_values(*horizon_, trajectory);
  const Eigen::Index steps = values.q.cols() - 1;
  EXPECT_TRUE(trajectory.chart_switches.empty());
  EXPECT_LT(relative_norm(values.q.rightCols(steps), columns_of(golden_.at("q"))), tolerance_);
  EXPECT_LT(relative_norm(values.qdot.rightCols(steps), columns_of(golden_.at("qdot"))),
            tolerance_);
  if (values.v().rows() > 0) {
    EXPECT_LT(relative_norm(values.v().rightCols(steps), columns_of(golden_.at("variables"))),
              tolerance_);
  }
  if (values.tactile().rows() > 0) {
    EXPECT_LT(relative_norm(values.tactile().rightCols(steps), columns_of(golden_.at("tactile"))),
              tolerance_);
  }
  const double golden_objective = golden_.at("objective");
  EXPECT_NEAR(objective().value(values), golden_objective, tolerance_ * std::abs(golden_objective));
}

TEST_P(GoldenRun, HasTheSameMassProperties) {
  for (const json& body : golden_.at("bodies")) {
    const std::string name = body.at("name");
    const Body& ours = horizon_->model().link(horizon_->model().find_body(name)).body;
    EXPECT_NEAR(ours.mass, body.at("mass"), tolerance_ * ours.mass) << name;
    EXPECT_LT(relative_norm(ours.inertia, vector_of(body.at("inertia"))), tolerance_) << name;
    const Eigen::VectorXd frame = vector_of(body.at("E_ji_R_rowmajor_p"));
    EXPECT_LT((ours.X_JB.p - frame.tail<3>()).norm(), tolerance_) << name;
  }
}

/// A gradient by its name in the golden files. The reference lists its p by type, in our order.
Eigen::VectorXd gradient_part(const Gradient& gradient, const ParameterSet& set,
                              const std::string& name) {
  if (name == "du") {
    return gradient.u.reshaped();
  }
  if (name == "dq0") {
    return gradient.q0;
  }
  if (name == "dqdot0") {
    return gradient.qdot0;
  }
  const auto wanted = [&](ParameterKind kind) {
    const bool transform =
        kind == ParameterKind::kJointTransform || kind == ParameterKind::kBodyTransform;
    const bool inertial = kind == ParameterKind::kMass || kind == ParameterKind::kInertia;
    const bool passive = kind == ParameterKind::kStiffness || kind == ParameterKind::kDamping;
    return (name == "dp12_tangent" && transform) || (name == "dp4" && inertial) ||
           (name == "dp5" && passive) || (name == "dp6" && kind == ParameterKind::kContactScale);
  };
  std::vector<double> part;
  for (int i = 0; i < set.size(); ++i) {
    if (wanted(set[i].kind)) {
      part.push_back(gradient.p[i]);
    }
  }
  return Eigen::Map<Eigen::VectorXd>(part.data(), static_cast<Eigen::Index>(part.size()));
}

TEST_P(GoldenRun, HasTheSameGradients) {
  const Trajectory trajectory = simulate(*horizon_, inputs_).trajectory();
  const Gradient ours = gradient(*horizon_, trajectory, objective());
  int compared = 0;
  for (const auto& [name, differences] : golden_.at("fd_gradients").items()) {
    if (!comparable(name)) {
      continue;
    }
    const Eigen::VectorXd part = gradient_part(ours, horizon_->parameters(), name);
    const bool good = golden_.at("fd_check").at(name).at("pass");
    const json& reference = good ? golden_.at("gradients").at(name) : differences;
    const Eigen::VectorXd expected = vector_of(reference);
    ASSERT_EQ(part.size(), expected.size()) << name;
    EXPECT_LT(relative_norm(part, expected), gradient_bound(name))
        << name << (good ? "" : " (differences)");
    ++compared;
  }
  EXPECT_GE(compared, 2);
}

INSTANTIATE_TEST_SUITE_P(All, GoldenRun, ::testing::ValuesIn(run_names()), [](const auto& run) {
  std::string name = run.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
});

}  // namespace
}  // namespace hbar
