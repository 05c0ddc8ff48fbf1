#include "hbar/adjoint/load_problem.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace hbar {
namespace {

/// A scene file of one hinge in a folder of its own.
class LoadProblem : public testing::Test {
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
  const SimulationOptions& options = loaded.problem.simulator.options();
  EXPECT_EQ(options.integrator, "sdirk2");
  EXPECT_EQ(options.h, 0.125);
  EXPECT_EQ(options.steps, 100);
  EXPECT_EQ(options.newton.tol, 1e-7);
  EXPECT_EQ(options.newton.max_iter, 7);
  EXPECT_EQ(options.newton.max_ls, 3);
  EXPECT_EQ(loaded.problem.simulator.parameters().size(), 2);
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
  EXPECT_EQ(loaded.problem.simulator.options().integrator, "bdf2");
  EXPECT_EQ(loaded.problem.simulator.options().h, 0.5);
  EXPECT_EQ(loaded.problem.simulator.options().steps, 3);
  EXPECT_EQ(loaded.problem.simulator.options().newton.tol, 1e-3);
  EXPECT_EQ(loaded.problem.simulator.parameters().size(), 0);
  options.parameters = ParameterChoice::kNamed;
  options.parameter_names = {"gravity.x"};
  EXPECT_EQ(load_problem(hinge(), options).problem.simulator.parameters()[0].name, "gravity.x");
  options.parameters = ParameterChoice::kAll;
  EXPECT_GT(load_problem(hinge(), options).problem.simulator.parameters().size(), 10);
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
