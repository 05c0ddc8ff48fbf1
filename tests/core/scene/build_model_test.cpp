#include "hbar/core/scene/build_model.h"

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <fstream>

#include "hbar/core/scene/vocabulary.h"
#include "tests/core/scene/build_refusal.h"
#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

Model recorded(const std::string& name) {
  return build_model(read_scene(std::string(kScenes) + "/" + name + ".xml"));
}

/// What another program found for a body: single precision where it read a mesh.
struct RecordedBody {
  double mass;
  Eigen::Vector3d inertia;
  Eigen::Matrix3d R_JB;
  Eigen::Vector3d p_JB;
};

Eigen::Matrix3d matrix(const std::array<double, 9>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

void expect_body(const hbar::Body& body, const RecordedBody& expected, double relative) {
  EXPECT_NEAR(body.mass, expected.mass, relative * expected.mass);
  EXPECT_LT((body.inertia - expected.inertia).norm(), relative * expected.inertia.norm());
  EXPECT_LT((body.X_JB.R - expected.R_JB).norm(), 10.0 * relative);
  EXPECT_LT((body.X_JB.p - expected.p_JB).norm(), relative);
}

TEST(BuildModel, BuildsEveryRecordedScene) {
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".xml") {
      continue;
    }
    SCOPED_TRACE(entry.path().string());
    const Scene scene = read_scene(entry.path());
    const Model model = build_model(scene);
    std::size_t links = 0;
    for (const Robot& robot : scene.description.robots) {
      links += robot.links.size();
    }
    EXPECT_EQ(model.links().size(), links);
    EXPECT_EQ(model.motors().size(), scene.description.motors.size());
    EXPECT_EQ(model.end_effectors().size(), scene.description.end_effectors.size());
    EXPECT_EQ(model.units() == Units::kMetreKilogram,
              scene.description.options.unit == UnitSystem::kMKg);
  }
}

TEST(BuildModel, PlacesTheMeshFileInTheJointFrame) {
  const Model model = recorded("b_mesh_obj_to_joint");
  expect_body(model.link(0).body,
              {0.5250000365078457,
               {0.0006984244554555354, 0.0010807379040385415, 0.001320962994240878},
               matrix({0.8706574305384909, -0.13621569782427348, -0.4726530676028236,
                       -0.40800466041960426, -0.7367047964193517, -0.5392571186443481,
                       -0.27475049722247313, 0.6623528716620528, -0.6969941446504666}),
               {0.11250000093132258, 0.04022114276399227, 0.0649759541279726}},
              1e-6);
  expect_body(model.link(1).body,
              {0.3500000243385638,
               {0.00037792995785645555, 0.0005865306752978818, 0.0008047895724630698},
               matrix({0.9909152781500823, 0.12406211417761889, 0.05191823720548472,
                       0.0706319806777414, -0.1515613955547856, -0.9859210245668895,
                       -0.11444664623432475, 0.9806312942198333, -0.15894725528441836}),
               {0.3484701852853175, 0.06956703814500657, 0.04750000149011612}},
              1e-6);
}

TEST(BuildModel, PlacesThePrincipalFrameInTheJointFrame) {
  const Model model = recorded("b_mesh_body_to_joint");
  expect_body(model.link(0).body,
              {0.5250000365078457,
               {0.0006984244554555354, 0.0010807379040385415, 0.001320962994240878},
               matrix({1.0, 0.0, 0.0, 0.0, 0.8660254037844387, -0.5, 0.0, 0.5, 0.8660254037844387}),
               {0.05, 0.02, 0.01}},
              1e-6);
}

TEST(BuildModel, DiagonalisesTheSixNumbersOfAnInertia) {
  const Model model = recorded("b_primitives");
  expect_body(model.link(3).body,
              {0.25,
               {0.0019143270821615217, 0.0030368861287443645, 0.004048786789094114},
               matrix({0.977283951084213, -0.14670466012797506, -0.15295038950576448,
                       0.1509671392246907, 0.9883998417319505, 0.01657334421799876,
                       0.1487447539496523, -0.03928734606703193, 0.9880948854292619}),
               {0.075, 0.01, 0.0}},
              1e-12);
  const hbar::Body& can = model.link(0).body;
  EXPECT_NEAR(can.mass, 0.6135923151542565, 1e-14);
  EXPECT_LT((can.inertia -
             Eigen::Vector3d(0.0033455961194120433, 0.0033455961194120433, 0.0002996056226339143))
                .norm(),
            1e-16);
}

/// A scene of two links, the second placed by what differs.
Scene two_links(const std::string& joint, const std::string& body) {
  return read_scene_text(
      "<redmax><robot><link name=\"a\"><joint type=\"revolute\" axis=\"0 0 1\" pos=\"1 2 3\" "
      "quat=\"0.8 0.2 -0.4 0.4\"/><body type=\"sphere\" radius=\"1\"/>\n<link name=\"b\">" +
          joint + body + "</link></link></robot></redmax>",
      "a.xml", kScenes);
}

TEST(BuildModel, PlacesWorldJointsInTheWorld) {
  const Model model =
      build_model(two_links("<joint type=\"revolute\" frame=\"WORLD\" pos=\"4 5 6\" "
                            "quat=\"0.5 0.5 0.5 0.5\" axis=\"0 0 3\"/>",
                            kBall));
  const RigidTransform<double> X_WJ = model.link(0).joint.X_PJ * model.link(1).joint.X_PJ;
  EXPECT_LT((X_WJ.p - Eigen::Vector3d(4.0, 5.0, 6.0)).norm(), 1e-14);
  const Eigen::Matrix3d R = Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5).toRotationMatrix();
  EXPECT_LT((X_WJ.R - R).norm(), 1e-14);
  const Eigen::Vector3d axis = std::get<RevoluteJoint>(model.link(1).joint.kind).axis;
  EXPECT_LT((X_WJ.R * axis - Eigen::Vector3d::UnitZ()).norm(), 1e-14);
}

TEST(BuildModel, PlacesWorldMeshesInTheWorld) {
  const std::string joint = "<joint type=\"revolute\" axis=\"1 0 0\" pos=\"0.5 0 0\"/>";
  const auto mesh = [](const std::string& how) {
    return "<body type=\"mesh\" filename=\"wedge.obj\" transform_type=\"" + how + "\"/>";
  };
  const Model world = build_model(two_links(joint, mesh("OBJ_TO_WORLD")));
  const Model local = build_model(two_links(joint, mesh("OBJ_TO_JOINT")));
  const RigidTransform<double> X_WJ = world.link(0).joint.X_PJ * world.link(1).joint.X_PJ;
  const RigidTransform<double> X_WB = X_WJ * world.link(1).body.X_JB;
  EXPECT_LT((X_WB.p - local.link(1).body.X_JB.p).norm(), 1e-14);
  EXPECT_LT((X_WB.R - local.link(1).body.X_JB.R).norm(), 1e-14);
}

TEST(EveryJointType, IsBuilt) {
  for (std::size_t i = 0; i < std::variant_size_v<JointKind>; ++i) {
    Scene scene = two_links("<joint type=\"fixed\"/>", kBall);
    Joint& joint = scene.description.robots[0].links[1].joint;
    joint.type = static_cast<JointType>(i);
    joint.axis = Vec3{0.0, 0.0, 2.0};
    joint.axis0 = Vec3{3.0, 0.0, 0.0};
    joint.axis1 = Vec3{0.0, 4.0, 0.0};
    const hbar::Joint built = build_model(scene).link(1).joint;
    EXPECT_EQ(built.kind.index(), i);
    EXPECT_EQ(joint_dof(built.kind), coordinate_count(joint.type));
    EXPECT_EQ(hbar::joint_type(built.kind), choice_name("joint", "type", i));
  }
}

TEST(BuildModel, TakesForcesMotorsAndEndEffectors) {
  const Scene scene = read_scene_text(
      scene_with_section("<option gravity=\"1 2 3\"/><default><joint damping=\"1\" stiffness=\"2\" "
                         "lim=\"-1 1\" lim_stiffness=\"3\"/></default><actuator><motor joint=\"j\" "
                         "ctrl=\"position\" P=\"4\" D=\"5\" ctrl_range=\"-6 6\" implicit=\"true\"/>"
                         "</actuator><variable><endeffector joint=\"k\" pos=\"7 8 9\" "
                         "name=\"tip\"/></variable>"),
      "a.xml");
  const Model model = build_model(scene);
  EXPECT_EQ(model.gravity(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(model.units(), Units::kCentimetreGram);
  const hbar::Joint& joint = model.link(0).joint;
  EXPECT_EQ(joint.damping, 1.0);
  EXPECT_EQ(joint.stiffness, 2.0);
  EXPECT_EQ(joint.limits, (JointLimits{-1.0, 1.0, 3.0}));
  EXPECT_EQ(model.motors().at(0),
            (hbar::Motor{0, hbar::Motor::Kind::kPosition, -6.0, 6.0, 4.0, 5.0, true}));
  EXPECT_EQ(model.end_effectors().at(0), (hbar::EndEffector{"tip", 1, {7.0, 8.0, 9.0}}));
}

TEST(BuildModel, SaysWhichBodyHasABadMesh) {
  const std::filesystem::path folder = ::testing::TempDir();
  std::ofstream(folder / "hbar_open.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::ofstream(folder / "hbar_bad.obj") << "v 0 0\n";
  const auto scene = [&folder](const std::string& file) {
    return read_scene_text(scene_with_body("<body type=\"mesh\" filename=\"" + file + "\"/>"),
                           "a.xml", folder);
  };
  EXPECT_EQ(
      refusal(scene("hbar_open.obj")),
      "a.xml:5: <body filename=\"hbar_open.obj\">: mesh: the edge from (0, 0, 0) to (1, 0, 0) "
      "has one triangle; a closed surface has two at each edge");
  EXPECT_EQ(
      refusal(scene("hbar_bad.obj")),
      "a.xml:5: <body filename=\"hbar_bad.obj\">: hbar_bad.obj:1: v has 2 numbers; a vertex is "
      "v x y z, with a weight or a colour");
  EXPECT_EQ(refusal(scene("hbar_none.obj")),
            "a.xml:5: <body filename=\"hbar_none.obj\">: " + (folder / "hbar_none.obj").string() +
                ": cannot be opened: No such file or directory");
  std::filesystem::remove(folder / "hbar_open.obj");
  std::filesystem::remove(folder / "hbar_bad.obj");
}

TEST(BuildModel, RefusesDescriptionsNoReaderMade) {
  Scene scene = two_links("<joint type=\"fixed\"/>", kBall);
  scene.description.robots[0].links[1].joint.damping = -1.0;
  EXPECT_EQ(refusal(scene), "a.xml:2: <link name=\"b\">: joint 'b': damping is -1; it must be ≥ 0");
  scene = two_links("<joint type=\"fixed\"/>", kBall);
  scene.description.robots[0].links[1].parent = 1;
  EXPECT_EQ(refusal(scene), "link 'b': its parent must come before it");
  scene = two_links("<joint type=\"fixed\"/>", kBall);
  scene.description.motors.push_back({"none", Control::kForce, {}, {}, 0.0, false, {}});
  EXPECT_EQ(refusal(scene), "no joint is named 'none'");
}

}  // namespace
}  // namespace hbar::scene
