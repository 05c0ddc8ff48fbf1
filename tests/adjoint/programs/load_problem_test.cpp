#include "hbar/adjoint/programs/load_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "tests/support/message_of.h"

namespace hbar {
namespace {

/// A scene file of one hinge in a folder of its own.
class LoadProblem : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "hbar_load.XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path scene(const std::string& joint, const std::string& variables) const {
    std::ofstream(folder_ / "scene.xml")
        << "<redmax model=\"one\">\n"
           "<option integrator=\"SDIRK2\" timestep=\"0.125\"/>\n"
           "<solver_option tol=\"1e-7\" max_iter=\"7\" max_ls=\"3\"/>\n"
           "<robot><link name=\"a\" design_params=\"16\">"
        << joint << "<body type=\"sphere\" radius=\"1\"/></link></robot>\n"
        << variables << "</redmax>\n";
    return folder_ / "scene.xml";
  }
  std::filesystem::path hinge() const {
    return scene("<joint name=\"j\" type=\"revolute\" axis=\"0 0 1\"/>", "");
  }

  std::filesystem::path folder_;
};

TEST_F(LoadProblem, TakesWhatTheSceneSays) {
  const LoadedProblem loaded = load_problem(hinge());
  const SimulationOptions& options = loaded.problem.horizon.options();
  EXPECT_EQ(options.integrator, "sdirk2");
  EXPECT_EQ(options.h, 0.125);
  EXPECT_EQ(options.steps, 100);
  EXPECT_EQ(options.newton.tol, 1e-7);
  EXPECT_EQ(options.newton.max_iter, 7);
  EXPECT_EQ(options.newton.max_ls, 3);
  EXPECT_EQ(loaded.problem.horizon.parameters().size(), 2);
  EXPECT_EQ(loaded.objective, ObjectiveChoice::kFinalPosition);
  EXPECT_EQ(loaded.problem.inputs.q0.size(), 1);
  EXPECT_EQ(loaded.files, std::vector<std::filesystem::path>{folder_ / "scene.xml"});
}

TEST_F(LoadProblem, OptionsWin) {
  LoadOptions options;
  options.integrator = "bdf2";
  options.h = 0.5;
  options.steps = 3;
  options.newton_tol = 1e-3;
  options.parameters = ParameterChoice::kNone;
  const LoadedProblem loaded = load_problem(hinge(), options);
  EXPECT_EQ(loaded.problem.horizon.options().integrator, "bdf2");
  EXPECT_EQ(loaded.problem.horizon.options().h, 0.5);
  EXPECT_EQ(loaded.problem.horizon.options().steps, 3);
  EXPECT_EQ(loaded.problem.horizon.options().newton.tol, 1e-3);
  EXPECT_EQ(loaded.problem.horizon.parameters().size(), 0);
  options.parameters = ParameterChoice::kNamed;
  options.parameter_names = {"gravity.x"};
  EXPECT_EQ(load_problem(hinge(), options).problem.horizon.parameters()[0].name, "gravity.x");
  options.parameters = ParameterChoice::kAll;
  EXPECT_GT(load_problem(hinge(), options).problem.horizon.parameters().size(), 10);
}

TEST_F(LoadProblem, HandsMemoryFactorsAndTheStopFlagOn) {
  std::atomic<bool> stop = false;
  LoadOptions options;
  options.keep_factors = false;
  options.max_memory = 1e6;
  options.stop = &stop;
  const SimulationOptions given = load_problem(hinge(), options).problem.horizon.options();
  EXPECT_FALSE(given.keep_factors);
  EXPECT_EQ(given.max_memory, 1e6);
  EXPECT_EQ(given.stop, &stop);
  options.steps = 1'000'000;
  EXPECT_THROW(static_cast<void>(load_problem(hinge(), options)), InvalidOption);
  options.max_memory = std::numeric_limits<double>::infinity();
  EXPECT_EQ(load_problem(hinge(), options).problem.horizon.steps(), 1'000'000);
  stop = true;
  EXPECT_EQ(
      testing::message_of<Interrupted>([&] { static_cast<void>(load_problem(hinge(), options)); }),
      "scene.xml: loading interrupted at link 'a'");
}

TEST_F(LoadProblem, ObjectiveFollowsTheVariables) {
  const std::string point = "<variable><endeffector joint=\"j\"/></variable>\n";
  const auto file = scene("<joint name=\"j\" type=\"prismatic\" axis=\"0 0 1\"/>", point);
  EXPECT_EQ(load_problem(file).objective, ObjectiveChoice::kVariables);
  LoadOptions options;
  options.objective = ObjectiveChoice::kFinalPosition;
  EXPECT_EQ(load_problem(file, options).objective, ObjectiveChoice::kFinalPosition);
  options.objective = ObjectiveChoice::kVariables;
  EXPECT_THROW(static_cast<void>(load_problem(hinge(), options)), InvalidOption);
}

TEST_F(LoadProblem, SensorsMayBeAnObjectiveAndAreNeverTheUsualOne) {
  const auto file = scene("<joint name=\"j\" type=\"prismatic\" axis=\"0 0 1\"/>",
                          "<sensor><tactile body=\"a\" name=\"skin\" type=\"rect_array\" "
                          "rect_pos0=\"0 0 0\" rect_pos1=\"1 1 0\" axis0=\"1 0 0\" "
                          "axis1=\"0 1 0\" resolution=\"2 3\"/></sensor>\n");
  const LoadedProblem usual = load_problem(file);
  EXPECT_EQ(usual.problem.horizon.model().tactile_count(), 18);
  EXPECT_EQ(usual.objective, ObjectiveChoice::kFinalPosition);
  LoadOptions options;
  options.objective = ObjectiveChoice::kTactile;
  const LoadedProblem asked = load_problem(file, options);
  EXPECT_EQ(asked.objective, ObjectiveChoice::kTactile);
  TrajectoryValues values;
  values.measured = Eigen::MatrixXd::Constant(18, 3, 2.0);
  values.measured_rows = {0, 18};
  values.q = Eigen::MatrixXd::Constant(1, 3, 7.0);
  EXPECT_EQ(asked.problem.objective.value(values), 0.5 * 2 * 18 * 4.0);  // the start is no step
  try {
    static_cast<void>(load_problem(hinge(), options));
    ADD_FAILURE() << "was loaded";
  } catch (const InvalidOption& error) {
    EXPECT_EQ(std::string(error.what()),
              "objective tactile: the scene has no sensor; add a <tactile>, or take another "
              "objective");
  }
}

TEST_F(LoadProblem, NamesEveryFileItReads) {
  const auto write = [this](const char* name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  };
  write("box.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  for (const char* name : {"corners.txt", "own.txt", "more.txt"}) {
    write(name, "1\n0 0 0\n");
  }
  write("skin.txt", "1\n0 0 0 1 0 0 0 1 0\n");
  write("files.xml",
        "<redmax><robot>"
        "<link name=\"a\"><joint name=\"j\" type=\"prismatic\" axis=\"0 0 1\"/>"
        "<body name=\"m\" type=\"mesh\" filename=\"box.obj\" contacts=\"corners.txt\"/>"
        "<link name=\"b\"><joint name=\"k\" type=\"fixed\"/>"
        "<body name=\"n\" type=\"mesh\" filename=\"box.obj\"/></link>"
        "<link name=\"c\"><joint name=\"l\" type=\"fixed\"/>"
        "<body name=\"o\" type=\"abstract\" mass=\"1\" inertia=\"1 1 1\" contacts=\"own.txt\" "
        "mesh=\"drawn.obj\"><collision contacts=\"more.txt\"/></body></link>"
        "</link></robot>"
        "<sensor><tactile body=\"o\" name=\"skin\" type=\"abstract\" spec=\"skin.txt\"/></sensor>"
        "</redmax>");
  std::vector<std::string> names;
  for (const std::filesystem::path& file : load_problem(folder_ / "files.xml").files) {
    EXPECT_EQ(file.parent_path(), folder_);
    names.push_back(file.filename());
  }
  ASSERT_FALSE(names.empty());
  EXPECT_EQ(names.front(), "files.xml");
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"box.obj", "corners.txt", "files.xml", "more.txt",
                                             "own.txt", "skin.txt"}));
}

TEST_F(LoadProblem, TellsOptionsFromScenes) {
  const auto with = [this](const auto& change) {
    LoadOptions options;
    change(options);
    static_cast<void>(load_problem(hinge(), options));
  };
  EXPECT_THROW(with([](LoadOptions& o) { o.integrator = "rk4"; }), InvalidOption);
  EXPECT_THROW(with([](LoadOptions& o) { o.h = 0.0; }), InvalidOption);
  EXPECT_THROW(with([](LoadOptions& o) { o.steps = 0; }), InvalidOption);
  EXPECT_THROW(with([](LoadOptions& o) { o.newton_tol = -1.0; }), InvalidOption);
  EXPECT_THROW(with([](LoadOptions& o) {
                 o.parameters = ParameterChoice::kNamed;
                 o.parameter_names = {"nothing"};
               }),
               InvalidOption);
  EXPECT_THROW(static_cast<void>(load_problem(folder_ / "none.xml")), IoError);
  try {
    static_cast<void>(load_problem(scene("<joint name=\"j\" type=\"fixed\"/>", "")));
    ADD_FAILURE() << "was loaded";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.what(),
              std::string("scene.xml") + ": no joint has a coordinate: there is nothing to move");
    EXPECT_EQ(dynamic_cast<const InvalidOption*>(&error), nullptr);
  }
}

}  // namespace
}  // namespace hbar
