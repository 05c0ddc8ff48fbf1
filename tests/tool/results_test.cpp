// What the hbar command computes: against the library, against golden runs, file by file.

#include <cmath>

#include "hbar/adjoint/derivatives/gradient.h"
#include "hbar/adjoint/programs/load_problem.h"
#include "hbar/adjoint/trajectory/simulator.h"
#include "hbar/adjoint/trajectory/value_reader.h"
#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using nlohmann::json;

Eigen::VectorXd vector_of(const json& array) {
  const auto values = array.get<std::vector<double>>();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Rows of numbers as the columns of a matrix.
Eigen::MatrixXd columns_of(const json& rows) {
  Eigen::MatrixXd out(rows.empty() ? 0 : rows.at(0).size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    out.col(static_cast<Eigen::Index>(k)) = vector_of(rows[k]);
  }
  return out;
}

double relative_gap(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) {
    return 1.0;
  }
  return (a - b).norm() / std::max(b.norm(), 1e-300);
}

std::string text_of(const Eigen::MatrixXd& columns, const char* separator) {
  std::ostringstream text;
  text.precision(17);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    for (Eigen::Index i = 0; i < columns.rows(); ++i) {
      text << (i == 0 ? "" : separator) << columns(i, k);
    }
    text << '\n';
  }
  return text.str();
}

using ToolResults = ToolTest;

TEST_F(ToolResults, JsonHoldsWhatTheLibraryComputes) {
  LoadOptions options;
  options.steps = 15;
  options.h = 0.02;
  options.integrator = "sdirk2";
  options.newton_tol = 1e-12;
  options.parameters = ParameterChoice::kAll;
  LoadedProblem loaded = load_problem(scene("arm"), options);
  Problem& problem = loaded.problem;
  problem.inputs.q0 << 0.1, -0.25, 0.5;
  problem.inputs.qdot0 << 1.0, 0.0, -0.125;
  for (Eigen::Index k = 0; k < 15; ++k) {
    problem.inputs.u.col(k) << 0.1 * static_cast<double>(k), -0.3, 0.7;
  }
  const Trajectory trajectory = simulate(problem.horizon, problem.inputs).trajectory();
  const TrajectoryValues values = read_values(problem.horizon, trajectory);
  const Gradient expected = gradient(problem.horizon, trajectory, problem.objective);

  const std::string controls =
      write("u.csv", "yaw, shoulder, elbow\r\n" + text_of(problem.inputs.u, ", "));
  const Outcome outcome =
      hbar({"gradient",     scene("arm"),  "--steps",      "15",           "--dt",       "0.02",
            "--integrator", "sdirk2",      "--newton-tol", "1e-12",        "--params",   "all",
            "--q0",         "0.1 -.25 .5", "--qdot0",      "1, 0, -0.125", "--controls", controls,
            "--objective",  "variables",   "--out",        path("r.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const json r = json::parse(read_file(path("r.json")));
  EXPECT_EQ(r.at("h"), 0.02);
  EXPECT_EQ(r.at("steps"), 15);
  EXPECT_EQ(r.at("steps_done"), 15);
  EXPECT_EQ(r.at("status"), "converged");
  EXPECT_EQ(r.at("units"), "m-kg");
  EXPECT_EQ(r.at("model"), "arm");
  EXPECT_EQ(r.at("integrator"), "sdirk2");
  EXPECT_EQ(r.at("newton_tol"), 1e-12);
  EXPECT_EQ(r.at("linear_solver"), "sweep");
  EXPECT_EQ(r.at("coordinates"), json({"yaw", "shoulder", "elbow"}));
  EXPECT_EQ(r.at("variable_names"), json({"hand.x", "hand.y", "hand.z"}));
  EXPECT_EQ(vector_of(r.at("q").at(0)), problem.inputs.q0);
  EXPECT_LT(relative_gap(columns_of(r.at("q")), values.q), 1e-13);
  EXPECT_LT(relative_gap(columns_of(r.at("qdot")), values.qdot), 1e-13);
  EXPECT_LT(relative_gap(columns_of(r.at("variables")), values.v().rightCols(15)), 1e-13);
  EXPECT_EQ(r.at("newton_iterations").size(), 15U);
  EXPECT_EQ(r.at("newton_iterations").at(3), trajectory.newton_iterations(3));
  EXPECT_NEAR(r.at("objective"), expected.value, 1e-13 * expected.value);
  const json& g = r.at("gradient");
  EXPECT_LT(relative_gap(columns_of(g.at("u")), expected.u), 1e-12);
  EXPECT_LT(relative_gap(vector_of(g.at("q0")), expected.q0), 1e-12);
  EXPECT_LT(relative_gap(vector_of(g.at("qdot0")), expected.qdot0), 1e-12);
  const ParameterSet& parameters = problem.horizon.parameters();
  ASSERT_EQ(g.at("p").size(), static_cast<std::size_t>(parameters.size()));
  for (int i = 0; i < parameters.size(); ++i) {
    const json& p = g.at("p").at(static_cast<std::size_t>(i));
    EXPECT_EQ(p.at("name"), parameters[i].name);
    EXPECT_EQ(p.at("value"), parameters[i].nominal);
    EXPECT_NEAR(p.at("derivative"), expected.p[i], 1e-12 * expected.p.norm());
  }
}

TEST_F(ToolResults, LinearSolversAgreeWhetherOptionOrSceneNamesThem) {
  const auto derivatives = [this](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"gradient", file,    "--steps",      "20",   "--params",
                                          "all",      "--out", path("r.json"), "--q0", "0.4 -0.2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = hbar(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(read_file(path("r.json")));
  };
  const auto vector_of_p = [](const json& r) {
    Eigen::VectorXd p(static_cast<Eigen::Index>(r.at("gradient").at("p").size()));
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      p[i] = r.at("gradient").at("p").at(static_cast<std::size_t>(i)).at("derivative");
    }
    return p;
  };
  const std::string file = scene("double_pendulum");
  const Eigen::VectorXd swept = vector_of_p(derivatives(file, {}));
  for (const char* name : {"auto", "klu", "block_substitution"}) {
    const json r = derivatives(file, {"--linear-solver", name});
    EXPECT_EQ(r.at("linear_solver"), name);
    EXPECT_LT(relative_gap(vector_of_p(r), swept), 1e-10) << name;
  }
  std::string text = read_file(file);
  const std::size_t place = text.find("<option");
  ASSERT_NE(place, std::string::npos);
  text.insert(place, "<solver_option linear_solver=\"klu\"/>");
  const json r = derivatives(write("klu.xml", text), {});
  EXPECT_EQ(r.at("linear_solver"), "klu");
  EXPECT_LT(relative_gap(vector_of_p(r), swept), 1e-10);
}

TEST_F(ToolResults, ParametersAreChosenByMaskOrByName) {
  const auto names = [this](const std::string& choice) {
    std::vector<std::string> arguments = {"gradient", scene("pendulum"), "--steps",
                                          "3",        "--out",           path("r.json")};
    if (!choice.empty()) {
      arguments.insert(arguments.end(), {"--params", choice});
    }
    const Outcome outcome = hbar(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::vector<std::string> out;
    const json r = result("r.json");
    for (const json& p : r.at("gradient").at("p")) {
      out.push_back(p.at("name"));
    }
    return out;
  };
  const std::vector<std::string> masked = {"body.rod.mass",         "body.rod.inertia.x",
                                           "body.rod.inertia.y",    "body.rod.inertia.z",
                                           "joint.hinge.stiffness", "joint.hinge.damping"};
  EXPECT_EQ(names(""), masked);
  EXPECT_EQ(names("mask"), masked);
  EXPECT_EQ(names("none"), std::vector<std::string>());
  EXPECT_EQ(names("all").size(), 24U);
  EXPECT_EQ(names("gravity.z, body.rod.inertia"),
            (std::vector<std::string>{"body.rod.inertia.x", "body.rod.inertia.y",
                                      "body.rod.inertia.z", "gravity.z"}));
}

TEST_F(ToolResults, ObjectivesAreWhatTheirNamesSay) {
  const auto objective = [this](std::vector<std::string> more) {
    more.insert(more.begin(), {"simulate", scene("double_pendulum"), "--steps", "4", "--q0",
                               "0.5,0.25", "--out", path("r.json")});
    EXPECT_EQ(hbar(more).code, 0);
    return result("r.json");
  };
  const json r = objective({});
  double variables = 0.0;
  for (const json& v : r.at("variables")) {
    variables += 0.5 * vector_of(v).squaredNorm();
  }
  EXPECT_NEAR(r.at("objective"), variables, 1e-13);
  EXPECT_EQ(r.at("objective_kind"), "variables");
  const json last = objective({"--objective", "final-position"});
  EXPECT_NEAR(last.at("objective"), 0.5 * vector_of(last.at("q").back()).squaredNorm(), 1e-14);
  EXPECT_FALSE(last.contains("gradient"));
}

TEST_F(ToolResults, CsvHasARowForEveryStepAndTheSameNumbersAsJson) {
  const Outcome outcome = hbar({"simulate", scene("double_pendulum"), "--steps", "5", "--q0",
                                "1 -1", "--out", path("r.json"), "--csv", path("q.csv")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream csv(read_file(path("q.csv")));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "time,q.shoulder,q.elbow,qdot.shoulder,qdot.elbow,tip.x,tip.y,tip.z");
  const json r = result("r.json");
  for (std::size_t k = 0; k <= 5; ++k) {
    ASSERT_TRUE(std::getline(csv, line));
    const json row = json::parse("[" + line + "]");
    EXPECT_NEAR(row.at(0), 0.005 * static_cast<double>(k), 1e-15);
    EXPECT_EQ(row.at(1), r.at("q").at(k).at(0));
    EXPECT_EQ(row.at(4), r.at("qdot").at(k).at(1));
    if (k > 0) {
      EXPECT_EQ(row.at(7), r.at("variables").at(k - 1).at(2));
    }
  }
  EXPECT_FALSE(std::getline(csv, line));
}

TEST_F(ToolResults, StandardOutputHoldsEitherTheSummaryOrTheFile) {
  const Outcome summary = hbar({"gradient", scene("pendulum"), "--steps", "5", "--q0", "0.5"});
  EXPECT_EQ(summary.code, 0);
  EXPECT_EQ(summary.out.find("pendulum: 5 of 5 steps of 0.01 s by bdf2: converged"), 0U);
  EXPECT_NE(summary.out.find("objective final-position: "), std::string::npos);
  EXPECT_NE(summary.out.find("joint.hinge.damping"), std::string::npos);
  const Outcome machine = hbar({"gradient", scene("pendulum"), "--steps", "5", "--out", "-"});
  EXPECT_TRUE(nlohmann::json::accept(machine.out));
  const Outcome csv = hbar({"simulate", scene("pendulum"), "--steps", "5", "--csv", "-"});
  EXPECT_EQ(csv.out.find("time,q.hinge,qdot.hinge\n0,0,0\n"), 0U) << csv.out;
}

TEST_F(ToolResults, CheckConfirmsTheGradientClassByClass) {
  const std::vector<std::string> arguments = {"check", scene("pendulum"), "--steps", "10", "--q0",
                                              "0.5"};
  const Outcome table = hbar(arguments);
  EXPECT_EQ(table.code, 0) << table.out << table.err;
  EXPECT_NE(table.out.find("mass (IV)"), std::string::npos) << table.out;
  std::vector<std::string> with_file = arguments;
  with_file.insert(with_file.end(), {"--out", path("r.json")});
  EXPECT_EQ(hbar(with_file).code, 0);
  const json r = result("r.json");
  EXPECT_EQ(r.at("passed"), true);
  for (const json& row : r.at("classes")) {
    EXPECT_EQ(row.at("passed"), true) << row;
    EXPECT_LT(row.at("difference_gap"), 1e-6) << row;
  }
}

/// A golden run whose p are repeated with their names.
struct Golden {
  const char* run;
  const char* gradient;
  const char* owner;                ///< "joints" or "bodies"
  const char* prefix;               ///< "joint." or "body."
  std::vector<std::string> suffix;  ///< of the scalars that an owner has
};

class GoldenCommand : public ToolTest, public ::testing::WithParamInterface<Golden> {};

TEST_P(GoldenCommand, GivesTheGoldenTrajectoryAndGradient) {
  const Golden& which = GetParam();
  const auto golden_folder = kSource / "tests/golden";
  const json golden = json::parse(read_file(golden_folder / "runs" / which.run));
  const std::string file = golden_folder / "scenes" / golden.at("scene").get<std::string>();
  const int steps = golden.at("steps");
  const int controls = golden.at("ndof").at("u");
  const double amplitude = golden.at("control").at("amp");
  Eigen::MatrixXd u(controls, steps);
  for (int k = 0; k < steps; ++k) {
    for (int i = 0; i < controls; ++i) {
      u(i, k) = amplitude * std::sin(0.1 * k + i);
    }
  }
  const Outcome outcome =
      hbar({"gradient", file, "--steps", std::to_string(steps), "--dt", golden.at("h").dump(),
            "--integrator", std::string(which.run).ends_with("BDF1.json") ? "bdf1" : "bdf2",
            "--newton-tol", golden.at("newton_tol").dump(), "--q0",
            text_of(vector_of(golden.at("q0")), " "), "--qdot0",
            text_of(vector_of(golden.at("qdot0")), ","), "--controls",
            write("u.csv", text_of(u, " ")), "--out", path("r.json")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const json r = result("r.json");
  const Eigen::MatrixXd q = columns_of(r.at("q"));
  EXPECT_LT(relative_gap(q.rightCols(steps), columns_of(golden.at("q"))), 1e-9);
  EXPECT_LT(relative_gap(columns_of(r.at("qdot")).rightCols(steps), columns_of(golden.at("qdot"))),
            1e-9);
  EXPECT_LT(relative_gap(columns_of(r.at("variables")), columns_of(golden.at("variables"))), 1e-9);
  const double objective = golden.at("objective");
  EXPECT_NEAR(r.at("objective"), objective, 1e-9 * std::abs(objective));

  const json& ours = r.at("gradient");
  const json& theirs = golden.at("gradients");
  EXPECT_LT(relative_gap(columns_of(ours.at("u")).reshaped(), vector_of(theirs.at("du"))), 1e-7);
  EXPECT_LT(relative_gap(vector_of(ours.at("q0")), vector_of(theirs.at("dq0"))), 1e-7);
  EXPECT_LT(relative_gap(vector_of(ours.at("qdot0")), vector_of(theirs.at("dqdot0"))), 1e-7);
  const Eigen::VectorXd expected = vector_of(theirs.at(which.gradient));
  std::vector<double> derivatives;
  for (const json& owner : golden.at(which.owner)) {
    for (const std::string& suffix : which.suffix) {
      const std::string name = which.prefix + owner.at("name").get<std::string>() + "." + suffix;
      ASSERT_LT(derivatives.size(), ours.at("p").size());
      const json& entry = ours.at("p").at(derivatives.size());
      EXPECT_EQ(entry.at("name"), name);
      derivatives.push_back(entry.at("derivative"));
    }
  }
  EXPECT_LT(relative_gap(vector_of(derivatives), expected), 1e-7);
}

const std::vector<std::string> kTransform = {"rotation.x",    "rotation.y",    "rotation.z",
                                             "translation.x", "translation.y", "translation.z"};

INSTANTIATE_TEST_SUITE_P(Two, GoldenCommand,
                         ::testing::Values(Golden{"design_1_joints.BDF2.json", "dp12_tangent",
                                                  "joints", "joint.", kTransform},
                                           Golden{
                                               "design_8_joints.BDF1.json",
                                               "dp4",
                                               "bodies",
                                               "body.",
                                               {"mass", "inertia.x", "inertia.y", "inertia.z"}}));

/// A free body and, below it, a hinge.
std::string named_scene(const std::string& free, const std::string& hinge) {
  return "<redmax><option gravity=\"0 0 -9.81\" unit=\"m-kg\"/><robot><link name=\"a\"><joint "
         "name=\"" +
         free +
         "\" type=\"free2d\"/><body name=\"b\" type=\"sphere\" radius=\"1\"/><link "
         "name=\"c\"><joint "
         "name=\"" +
         hinge +
         "\" type=\"revolute\" axis=\"1 0 0\"/><body name=\"d\" type=\"sphere\" "
         "radius=\"1\"/></link></link></robot></redmax>";
}

TEST_F(ToolResults, ColumnsOfAnyNameAreQuoted) {
  const std::string file = write("n.xml", named_scene("f", "j,k &quot;x&quot;"));
  ASSERT_EQ(hbar({"simulate", file, "--steps", "1", "--csv", path("c.csv")}).code, 0);
  const std::string text = read_file(path("c.csv"));
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "time,q.f.x,q.f.y,q.f.theta,\"q.j,k \"\"x\"\"\",qdot.f.x,qdot.f.y,qdot.f.theta,"
            "\"qdot.j,k \"\"x\"\"\"");
}

TEST_F(ToolResults, TwoColumnsOfOneNameAreRefused) {
  const std::string file = write("n.xml", named_scene("j", "j.x"));
  const Outcome outcome = hbar({"simulate", file, "--steps", "1", "--csv", path("c.csv")});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(
      outcome.err,
      "hbar: --csv: two columns would be called \"q.j.x\"; rename a joint, an end effector or a "
      "sensor\n");
  EXPECT_EQ(hbar({"simulate", file, "--steps", "1", "--out", path("r.json")}).code, 0);
}

}  // namespace
}  // namespace hbar::tool
