// What the hbar command says: help, version, and every refusal with its exit code and whole line.

#include <algorithm>

#include "tests/tool/running.h"

namespace hbar::tool {
namespace {

using Usage = ToolTest;

TEST_F(Usage, HelpAndVersionGoToStandardOutput) {
  const Outcome version = hbar({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out, "hbar " HBAR_VERSION "\n");
  const Outcome help = hbar({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* command : {"info", "simulate", "gradient", "check"}) {
    EXPECT_NE(help.out.find(command), std::string::npos);
    const Outcome own = hbar({command, "--help"});
    EXPECT_EQ(own.code, 0);
    EXPECT_NE(own.out.find("SCENE"), std::string::npos);
    EXPECT_EQ(own.err, "");
  }
  const std::string options = hbar({"gradient", "--help"}).out;
  for (const char* option :
       {"--steps", "--dt", "--integrator", "--q0", "--qdot0", "--controls", "--params",
        "--objective", "--newton-tol", "--linear-solver", "--out", "--csv"}) {
    EXPECT_NE(options.find(option), std::string::npos) << option;
  }
}

struct RefusedLine {
  std::vector<std::string> arguments;
  std::string message;
};

TEST_F(Usage, EveryMistakeIsNamed) {
  const std::string file = scene("pendulum");
  const std::vector<RefusedLine> refusals = {
      {{},
       "a command is needed: info, simulate, gradient, check, solvers, corpus (see: hbar --help)"},
      {{"simulat", file},
       "there is no command \"simulat\"; did you mean 'simulate'? (see: hbar --help)"},
      {{"simulate"}, "simulate: SCENE is required (see: hbar simulate --help)"},
      {{"simulate", file, "--step", "3"},
       "simulate: there is no option --step; did you mean '--steps'? (see: hbar simulate --help)"},
      {{"simulate", file, "other.xml"},
       "simulate: what is \"other.xml\" for? One scene is enough (see: hbar simulate --help)"},
      {{"simulate", file, "--steps", "1.5x"}, "--steps: \"1.5x\" is not a whole number"},
      {{"simulate", file, "--steps", "0"}, "--steps: 0 is not at least 1"},
      {{"simulate", file, "--steps", "1000000001"},
       "--steps: 1000000001 is above 1000000000, the largest that is allowed"},
      {{"simulate", file, "--dt", "1.5x"}, "--dt: \"1.5x\" is not a finite number"},
      {{"simulate", file, "--dt", "nan"}, "--dt: \"nan\" is not a finite number"},
      {{"simulate", file, "--dt", "-0.1"}, "--dt: -0.1 is not positive"},
      {{"gradient", file, "--linear-solver", "kul"},
       "--linear-solver: there is no \"kul\"; did you mean 'klu'?"},
      {{"simulate", file, "--newton-tol", "0"}, "--newton-tol: 0 is not positive"},
      {{"simulate", file, "--q0", "1 x"}, "--q0: entry 2: \"x\" is not a finite number"},
      {{"simulate", file, "--q0", "1,,2"}, "--q0: entry 2 is missing between commas"},
      {{"simulate", file, "--q0", "1 2"}, "--q0: 2 entries; one per coordinate is needed: hinge"},
      {{"simulate", file, "--qdot0", ""},
       "--qdot0: 0 entries; one per coordinate is needed: hinge"},
      {{"simulate", file, "--integrator", "bdf3"},
       "--integrator: there is no \"bdf3\"; did you mean 'bdf1'?"},
      {{"simulate", file, "--objective", "variable"},
       "--objective: there is no \"variable\"; did you mean 'variables'?"},
      {{"gradient", file, "--objective", "variables"},
       "objective variables: the scene has none; add an <endeffector>, or take final-position"},
      {{"gradient", file, "--objective", "tactile"},
       "objective tactile: the scene has no sensor; add a <tactile>, or take another objective"},
      {{"gradient", file, "--params", " "}, "--params: it is empty; give mask, all, none or names"},
      {{"simulate", file, "--out", "-", "--csv", "-"},
       "--out and --csv cannot both go to standard output"},
  };
  for (const RefusedLine& refusal : refusals) {
    SCOPED_TRACE(refusal.message);
    const Outcome outcome = hbar(refusal.arguments);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "hbar: " + refusal.message + "\n");
  }
}

TEST_F(Usage, AnUnknownParameterIsAUsageErrorThatSuggests) {
  const Outcome outcome = hbar({"gradient", scene("pendulum"), "--params", "body.rot.mass"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("body.rot.mass"), std::string::npos);
  EXPECT_NE(outcome.err.find("body.rod.mass"), std::string::npos);
}

TEST_F(Usage, TooManyStepsForTheMemoryAreRefusedUpFront) {
  const Outcome outcome = hbar({"simulate", scene("pendulum"), "--steps", "1000000000"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("GB"), std::string::npos) << outcome.err;
  // The trajectory would fit, its text in a file would not.
  const std::vector<std::string> many = {"simulate", scene("pendulum"), "--steps", "12000000"};
  std::vector<std::string> with_file = many;
  with_file.insert(with_file.end(), {"--out", path("r.json")});
  const Outcome text = hbar(with_file);
  EXPECT_EQ(text.code, 2);
  EXPECT_EQ(
      text.err,
      "hbar: --steps: 12000000 steps and their results take about 4.67 GB; the limit is 4 GB: "
      "take fewer steps\n");
}

TEST_F(Usage, TooManyContactPointsAreRefusedAtOnce) {
  const std::string file = write(
      "points.xml",
      "<redmax>\n<robot>\n<link name=\"a\"><joint type=\"free3d-exp\"/>\n<body type=\"cuboid\" "
      "size=\"1 1 1\" general_contact_resolution=\"3000 3000 "
      "3000\"/></link>\n</robot>\n</redmax>\n");
  const Outcome outcome = hbar({"info", file});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err,
            "hbar: points.xml:4: <body general_contact_resolution=\"3000 3000 3000\">: that makes "
            "5.3964e+07 contact points; a body has at most 1000000\n");
}

TEST_F(Usage, DeepTreesAreShownWithDepthsInNumbers) {
  std::string text = "<redmax>\n<robot>\n";
  for (int i = 0; i < 30; ++i) {
    const std::string name = "l" + std::to_string(i);
    text +=
        "<link name=\"" + name + "\"" +
        (i > 0 ? " parent=\"l" + std::to_string(i - 1) + "\"" : "") +
        "><joint type=\"revolute\" axis=\"0 1 0\"/><body type=\"sphere\" radius=\"1\"/></link>\n";
  }
  const Outcome outcome =
      hbar({"info", write("deep.xml", text + "</robot>\n</redmax>\n"), "--params", "none"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::string indent(40, ' ');
  EXPECT_NE(outcome.out.find("\n  " + indent + "l20  "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\n  " + indent + "l29 (depth 29)  "), std::string::npos);
}

TEST_F(Usage, BadScenesAndControlsExitWithThree) {
  const std::string bad = write("bad.xml", "<redmax>\n<robot>\n<lnk/>\n</robot>\n</redmax>\n");
  const Outcome outcome = hbar({"info", bad});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err.find("hbar: bad.xml:3: "), 0U) << outcome.err;

  const std::string arm = scene("arm");
  const std::vector<std::pair<std::string, std::string>> files = {
      {"1 2 3\n1 2.5x 3\n", ":2: entry 2: \"2.5x\" is not a finite number"},
      {"1 2 3\n1 nan 3\n", ":2: entry 2: \"nan\" is not a finite number"},
      {"1 2 3\n1,,3\n", ":2: entry 2 is missing between commas"},
      {"yaw,shoulder,elbow\n1 2\n",
       ":2: 2 entries; one per control is needed: yaw, shoulder, elbow"},
      {"1 2 3\n", ": 1 row of controls; one per step is needed: 2"},
      {"1 2 3\n1 2 3\n1 2 3\n", ": 3 rows of controls; one per step is needed: 2"},
      {"", ": 0 rows of controls; one per step is needed: 2"},
  };
  for (const auto& [text, message] : files) {
    SCOPED_TRACE(message);
    const std::string controls = write("u.csv", text);
    const Outcome refused = hbar({"simulate", arm, "--steps", "2", "--controls", controls});
    EXPECT_EQ(refused.code, 3);
    EXPECT_EQ(refused.err, "hbar: " + controls + message + "\n");
  }
  const std::string controls = write("u.csv", "1\n1\n");
  const Outcome none =
      hbar({"simulate", scene("pendulum"), "--steps", "2", "--controls", controls});
  EXPECT_EQ(none.code, 3);
  EXPECT_EQ(none.err, "hbar: " + controls + ": the scene has no motor, hence no control to set\n");
}

TEST_F(Usage, InfoListsAllThatHasAName) {
  const Outcome outcome = hbar({"info", scene("arm")});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* part :
       {"arm: 3 coordinates, units m-kg", "links (4)", "revolute", "q2 elbow", "controls (3)", "u1",
        "position, P 40, D 4, implicit, force in [-20, 20]", "variables (3)", "hand.z",
        "* selected: 12", "*  body.forearm.mass", "joint.yaw.rotation.x", "motor.elbow.P",
        "gravity.z"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << '\n' << outcome.out;
  }
  const std::string selected = hbar({"info", scene("arm"), "--params", "gravity"}).out;
  EXPECT_NE(selected.find("* selected: 3"), std::string::npos);
  EXPECT_NE(selected.find("*  gravity.z"), std::string::npos);
}

TEST_F(Usage, InfoListsContactsAndSensors) {
  const Outcome outcome = hbar({"info", kSource / "tests/golden/scenes/tactile_small.xml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part :
       {"contacts (2): name, points, against, coefficients, law\n"
        "  ball-ground  deepest point of ball  ground: plane through 0 0 0.0075, normal 0 0 1  "
        "kn 500, kt 4, mu 0.5, damping 0  linear\n"
        "  pad-ball     72 points of pad       ball                                            "
        "kn 50, kt 1, mu 1, damping 2     document, reaction at the surface\n",
        "sensors (1): name, points, bodies it feels, coefficients\n"
        "  pad  20 points of pad  ball  kn 1, kt 0.03125, mu 2, damping 0.0625\n"}) {
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << '\n' << outcome.out;
  }
  const std::string none = hbar({"info", scene("arm")}).out;
  EXPECT_NE(none.find("\ncontacts (0): "), std::string::npos) << none;
  EXPECT_NE(none.find("\nsensors (0): "), std::string::npos) << none;
}

TEST_F(Usage, NoticesOfTheSceneAppearOnceOnStandardError) {
  std::string text = read_file(scene("pendulum"));
  const std::size_t end = text.find("</redmax>");
  text.insert(end, "<contact><ground_contact body=\"rod\" kn=\"1\"/></contact>\n");
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(end), '\n');
  const Outcome outcome = hbar({"simulate", write("ground.xml", text), "--steps", "2"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err,
            "hbar: ground.xml:" + std::to_string(line) +
                ": <ground_contact>: the scene has no <ground>, so it is the plane z = 0\n");
}

}  // namespace
}  // namespace hbar::tool
