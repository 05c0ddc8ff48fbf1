// What the hbar command says of contact and of tactile sensors.

#include <cmath>
#include <numbers>

#include "hbar/adjoint/programs/load_problem.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using nlohmann::json;

const std::string kBall = kSource / "tests/golden/scenes/ground_sphere_stick.xml";
const std::string kPad = kSource / "tests/golden/scenes/tactile_small.xml";

// The ball of ground_sphere_stick.xml: radius 1/16 m, 500 kg/m³, kn 1000 N/m, mu 0.5.
const double kWeight = 9.8125 * 500.0 * 4.0 / 3.0 * std::numbers::pi / 4096.0;
constexpr double kStiffness = 1000.0;
constexpr double kFriction = 0.5;

class ToolContact : public ToolTest {
 protected:
  /// The results of a run that goes well.
  [[nodiscard]] json run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--out", path("r.json")});
    const Outcome outcome = hbar(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return result("r.json");
  }
};

TEST_F(ToolContact, ABallAtRestIsCarriedByItsDepth) {
  const json r = run({"simulate", kBall, "--steps", "800"});
  EXPECT_EQ(r.at("contacts"), json({"a-ground"}));
  ASSERT_EQ(r.at("contact").size(), 1U);
  const json& contact = r.at("contact").at("a-ground");
  for (const char* member :
       {"active", "sticking", "penetration", "normal_force", "friction_force"}) {
    EXPECT_EQ(contact.at(member).size(), 800U) << member;
  }
  // BDF1 takes 5 % off the bouncing at each step: nothing is left of it after 800.
  EXPECT_EQ(contact.at("active").at(799), 1);
  EXPECT_EQ(contact.at("sticking").at(799), 1);
  EXPECT_NEAR(contact.at("normal_force").at(799), kWeight, 1e-10 * kWeight);
  EXPECT_NEAR(contact.at("penetration").at(799), kWeight / kStiffness,
              1e-10 * kWeight / kStiffness);
  EXPECT_NEAR(contact.at("friction_force").at(799), 0.0, 1e-12);
}

TEST_F(ToolContact, ABallThatSlidesIsHeldByFrictionAtItsBound) {
  const json r = run({"simulate", kBall, "--steps", "4", "--qdot0", "3 0 0 0 0 0"});
  const json& contact = r.at("contact").at("a-ground");
  for (std::size_t k = 0; k < 4; ++k) {
    const double normal_force = contact.at("normal_force").at(k);
    EXPECT_GT(normal_force, 0.0);
    EXPECT_EQ(contact.at("active").at(k), 1);
    EXPECT_EQ(contact.at("sticking").at(k), 0);
    EXPECT_NEAR(normal_force, kStiffness * contact.at("penetration").at(k).get<double>(), 1e-14);
    EXPECT_NEAR(contact.at("friction_force").at(k), kFriction * normal_force, 1e-14);
  }
}

TEST_F(ToolContact, ABallInTheAirTouchesNothing) {
  const json r = run({"simulate", kBall, "--steps", "3", "--q0", "0 0 1 0 0 0"});
  for (const auto& [member, values] : r.at("contact").at("a-ground").items()) {
    EXPECT_EQ(values, json({0, 0, 0})) << member;
  }
  const Outcome summary = hbar({"simulate", kBall, "--steps", "3", "--q0", "0 0 1 0 0 0"});
  EXPECT_NE(summary.out.find("  a-ground  no touch\n"), std::string::npos) << summary.out;
}

TEST_F(ToolContact, ResultsHoldWhatTheLibraryComputes) {
  LoadOptions options;
  options.steps = 20;
  options.objective = ObjectiveChoice::kTactile;
  LoadedProblem loaded = load_problem(kPad, options);
  const Horizon& horizon = loaded.problem.horizon;
  const Trajectory trajectory = simulate(horizon, loaded.problem.inputs).trajectory();
  const Eigen::MatrixXd tactile = read_values(horizon, trajectory).tactile();
  const auto contact = contact_history(horizon, trajectory);

  const json r = run({"simulate", kPad, "--steps", "20", "--objective", "tactile"});
  EXPECT_EQ(r.at("contacts"), json({"ball-ground", "pad-ball"}));
  int touched = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const json& found = r.at("contact").at(r.at("contacts").at(i).get<std::string>());
    for (std::size_t k = 1; k <= 20; ++k) {
      const ContactSummary& expected = contact.at(k).at(i);
      EXPECT_EQ(found.at("active").at(k - 1), expected.active);
      EXPECT_EQ(found.at("sticking").at(k - 1), expected.sticking);
      EXPECT_EQ(found.at("penetration").at(k - 1), expected.penetration);
      EXPECT_EQ(found.at("normal_force").at(k - 1), expected.normal_force);
      EXPECT_EQ(found.at("friction_force").at(k - 1), expected.friction_force);
      touched += expected.active;
    }
  }
  EXPECT_GT(touched, 0);

  const json& names = r.at("tactile_names");
  ASSERT_EQ(names.size(), 60U);
  EXPECT_EQ(names.at(0), "pad.0.shear0");
  EXPECT_EQ(names.at(1), "pad.0.shear1");
  EXPECT_EQ(names.at(59), "pad.19.normal");
  ASSERT_EQ(r.at("tactile").size(), 20U);
  for (Eigen::Index k = 1; k <= 20; ++k) {
    const json& row = r.at("tactile").at(static_cast<std::size_t>(k - 1));
    ASSERT_EQ(row.size(), 60U);
    for (Eigen::Index i = 0; i < 60; ++i) {
      EXPECT_EQ(row.at(static_cast<std::size_t>(i)), tactile(i, k));
    }
  }
  EXPECT_EQ(r.at("objective_kind"), "tactile");
  EXPECT_GT(tactile.cwiseAbs().maxCoeff(), 0.0);
  const double objective = 0.5 * tactile.rightCols(20).squaredNorm();
  EXPECT_NEAR(r.at("objective"), objective, 1e-14 * objective);
}

TEST_F(ToolContact, CsvHasTheReadingsLast) {
  const json r = run({"simulate", kPad, "--steps", "20", "--csv", path("q.csv")});
  std::istringstream csv(read_file(path("q.csv")));
  std::string line;
  std::getline(csv, line);
  EXPECT_NE(line.find(",endeffector1.z,pad.0.shear0,pad.0.shear1,pad.0.normal,pad.1.shear0,"),
            std::string::npos)
      << line;
  EXPECT_TRUE(line.ends_with(",pad.19.normal")) << line;
  std::getline(csv, line);
  for (std::size_t k = 0; k < 20; ++k) {
    ASSERT_TRUE(std::getline(csv, line));
    const json row = json::parse("[" + line + "]");
    ASSERT_EQ(row.size(), 1U + 2U * 9U + 6U + 60U);
    EXPECT_EQ(json(std::vector<json>(row.end() - 60, row.end())), r.at("tactile").at(k));
  }
}

TEST_F(ToolContact, ScenesWithoutContactAndSensorsHaveEmptyLists) {
  const json r = run({"simulate", scene("pendulum"), "--steps", "2"});
  EXPECT_EQ(r.at("contacts"), json::array());
  EXPECT_EQ(r.at("contact"), json::object());
  EXPECT_EQ(r.at("tactile_names"), json::array());
  EXPECT_EQ(r.at("tactile"), json({json::array(), json::array()}));
  const std::string summary = hbar({"simulate", scene("pendulum"), "--steps", "2"}).out;
  EXPECT_EQ(summary.find("contacts"), std::string::npos) << summary;
  EXPECT_EQ(summary.find("sensors"), std::string::npos) << summary;
}

TEST_F(ToolContact, TheSummaryTellsWhenHowDeepAndHowHard) {
  const Outcome ball = hbar({"simulate", kBall, "--steps", "800"});
  EXPECT_EQ(ball.code, 0);
  EXPECT_NE(ball.out.find("contacts: first touch, deepest point, largest normal force, points that "
                          "stick\n  a-ground  from t = 0 s  0.00"),
            std::string::npos)
      << ball.out;
  EXPECT_NE(ball.out.find(" N  100 %\n"), std::string::npos) << ball.out;
  const Outcome pad = hbar({"simulate", kPad, "--steps", "20", "--objective", "tactile"});
  EXPECT_NE(pad.out.find("sensors: largest reading\n  pad  "), std::string::npos) << pad.out;
  EXPECT_NE(pad.out.find("\nobjective tactile: "), std::string::npos) << pad.out;
}

TEST_F(ToolContact, TheGradientOfReadingsIsConfirmed) {
  // Pressed on the ball and sliding; no point of the pad comes or goes within these steps.
  const Outcome outcome =
      hbar({"check", kPad, "--steps", "3", "--objective", "tactile", "--params", "none", "--q0",
            "0 0 -.004 0 0 0 0 0 0", "--qdot0", "0.05 0.02 -0.1 0 0 0 0 0 0"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

TEST_F(ToolContact, ARunThatStopsHasWhatItReached) {
  std::string text = read_file(kBall);
  text.replace(text.find("tol=\"1e-15\""), 11, "max_iter=\"1\" max_ls=\"1\"");
  const std::string file = write("wild.xml", text);
  const Outcome outcome =
      hbar({"simulate", file, "--qdot0", "1e3 0 -1e3 0 90 0", "--out", path("r.json")});
  EXPECT_EQ(outcome.code, 4) << outcome.err;
  const json r = result("r.json");
  const std::size_t done = r.at("steps_done");
  EXPECT_LT(done, 100U);
  for (const auto& [member, values] : r.at("contact").at("a-ground").items()) {
    EXPECT_EQ(values.size(), done) << member;
  }
}

}  // namespace
}  // namespace hbar::tool
