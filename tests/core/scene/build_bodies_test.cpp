#include "hbar/core/scene/build_bodies.h"

#include <Eigen/Geometry>
#include <fstream>

#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_mesh.h"
#include "hbar/core/scene/spread_vertices.h"
#include "tests/core/scene/scene_testing.h"
#include "tests/support/solid_meshes.h"
#include "tests/support/temporary_folder.h"

namespace hbar::scene {
namespace {

/// A folder with files of contact points, for one test.
class MadeBodies : public ::testing::Test {
 protected:
  MadeBodies() {
    std::filesystem::copy_file(std::string(kScenes) + "/wedge.obj", folder_ / "wedge.obj",
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder_ / "two.txt") << "2\n1 2 3\n4 5 6\n";
    std::ofstream(folder_ / "one.txt") << "1\n7 8 9\n";
    std::ofstream(folder_ / "bad.txt") << "1\n7 8\n";
  }

  [[nodiscard]] BuiltBody built(const std::string& body) const {
    const Scene scene = read_scene_text(scene_with_body(body), "a.xml", folder_.path());
    return build_body(scene, scene.description.robots.at(0).links.at(0).body, {});
  }
  [[nodiscard]] std::string refusal(const std::string& body) const {
    try {
      static_cast<void>(built(body));
    } catch (const Error& error) {
      return error.what();
    }
    return "was built";
  }

  TemporaryFolder folder_;
};

/// How many contact points another program found on the bodies of recorded scenes.
struct RecordedCount {
  const char* scene;
  std::vector<Eigen::Index> counts;
};

TEST(EveryRecordedScene, HasItsNumberOfContactPoints) {
  const std::vector<RecordedCount> recorded = {
      {"contact_capsule_stick", {66, 22}},   {"contact_cuboid_slide", {66, 152}},
      {"contact_cylinder_stick", {66, 50}},  {"contact_sphere_slide", {66, 0}},
      {"design_1_contact", {12, 12, 12, 8}}, {"ground_capsule_slide", {26}},
      {"ground_cuboid_stick", {26}},         {"ground_cylinder_slide", {26}},
      {"ground_sphere_stick", {0}},          {"tactile_small", {72, 0}},
  };
  for (const RecordedCount& scene : recorded) {
    SCOPED_TRACE(scene.scene);
    const Model model = build_model(read_scene(std::string(kScenes) + "/" + scene.scene + ".xml"));
    std::vector<Eigen::Index> counts;
    for (const hbar::Link& link : model.links()) {
      counts.push_back(link.body.contact_points.cols());
    }
    EXPECT_EQ(counts, scene.counts);
  }
}

TEST_F(MadeBodies, SolidsHaveThePointsOfTheirResolution) {
  struct Case {
    std::string attributes;
    Shape shape;
    SurfaceResolution resolution;
  };
  const std::vector<Case> cases = {
      {"type=\"cuboid\" size=\"1 2 3\"", Cuboid{{1.0, 2.0, 3.0}}, {}},
      {"type=\"cuboid\" size=\"1 2 3\" general_contact_resolution=\"2 3 4\"",
       Cuboid{{1.0, 2.0, 3.0}},
       {.cuboid = {2, 3, 4}}},
      {"type=\"sphere\" radius=\"2\"", Sphere{2.0}, {}},
      {"type=\"sphere\" radius=\"2\" general_contact_resolution=\"3 4\"",
       Sphere{2.0},
       {.sphere = {3, 4}}},
      {"type=\"cylinder\" radius=\"2\" length=\"3\"", Cylinder{2.0, 3.0}, {}},
      {"type=\"cylinder\" radius=\"2\" length=\"3\" general_contact_angle_resolution=\"4\" "
       "general_contact_radius_resolution=\"5\"",
       Cylinder{2.0, 3.0},
       {.cylinder = {4, 5}}},
      {"type=\"capsule\" radius=\"2\" length=\"3\"", Capsule{2.0, 3.0}, {}},
      {"type=\"capsule\" radius=\"2\" length=\"3\" general_contact_resolution=\"4 7\"",
       Capsule{2.0, 3.0},
       {.capsule = {4, 7}}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.attributes);
    const BuiltBody body =
        built("<body " + c.attributes + " pos=\"1 2 3\" quat=\"0.8 0.6 0 0\" density=\"2\"/>");
    EXPECT_EQ(body.body.contact_points, surface_points(c.shape, c.resolution));
    EXPECT_EQ(body.body.shape, c.shape);
    EXPECT_EQ(body.body.X_JB, pose({1.0, 2.0, 3.0}, {0.8, 0.6, 0.0, 0.0}));
    EXPECT_EQ(body.X_BG, RigidTransform<double>());
    EXPECT_FALSE(body.mesh);
  }
}

TEST_F(MadeBodies, AbstractOnesHaveThePointsOfTheirFiles) {
  EXPECT_EQ(built("<body type=\"abstract\" mass=\"1\" inertia=\"1 1 1\"/>").body.contact_points,
            Eigen::Matrix3Xd(3, 0));
  const BuiltBody body = built(
      "<body type=\"abstract\" mass=\"1\" inertia=\"3 0 0 1 0 2.5\" scale=\"1 10 100\" "
      "pos=\"1 1 1\" contacts=\"two.txt\"><collision contacts=\"one.txt\" pos=\"1 2 3\" "
      "quat=\"1 0 0 1\"/></body>");
  Eigen::Matrix3Xd given(3, 3);   // in the frame of pos and quat: the child turns x to y
  given << 1.0, 4.0, 1.0 - 80.0,  //
      20.0, 50.0, 2.0 + 7.0,      //
      300.0, 600.0, 3.0 + 900.0;
  const RigidTransform<double> X_JG = pose({1.0, 1.0, 1.0}, {1.0, 0.0, 0.0, 0.0});
  const RigidTransform<double> X_GB = inverse(X_JG) * body.body.X_JB;
  EXPECT_EQ(body.body.inertia, Eigen::Vector3d(1.0, 2.5, 3.0)) << "turned to the principal axes";
  EXPECT_LT((X_GB.R * body.body.contact_points - given).norm(), 1e-12);
  EXPECT_LT((body.X_BG.R - inverse(X_GB).R).norm(), 1e-15);
  EXPECT_LT((body.X_BG.p - inverse(X_GB).p).norm(), 1e-15);
}

TEST_F(MadeBodies, MeshesHaveThePointsOfTheirFile) {
  const BuiltBody body = built(
      "<body type=\"mesh\" filename=\"wedge.obj\" scale=\"1 2 3\" contacts=\"two.txt\" "
      "transform_type=\"OBJ_TO_JOINT\"/>");
  Eigen::Matrix3Xd given(3, 2);
  given << 1, 4, 4, 10, 9, 18;
  const RigidTransform<double>& X_JB = body.body.X_JB;  // the OBJ's frame is the joint's
  EXPECT_LT(((X_JB.R * body.body.contact_points).colwise() + X_JB.p - given).norm(), 1e-13);
  EXPECT_LT((X_JB * body.X_BG).p.norm(), 1e-15);
  EXPECT_LT(((X_JB * body.X_BG).R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST_F(MadeBodies, MeshesHaveVerticesWhereThereIsNoFile) {
  const TriangleMesh file = read_mesh(folder_ / "wedge.obj").mesh;
  for (const int count : {1, 3, 64}) {
    const BuiltBody body =
        built(concat("<body type=\"mesh\" filename=\"wedge.obj\" transform_type=\"OBJ_TO_JOINT\" "
                     "contact_count=\"",
                     count, "\"/>"));
    const RigidTransform<double>& X_JB = body.body.X_JB;
    const Eigen::Matrix3Xd expected = spread_vertices(file, X_JB.p, count);
    ASSERT_EQ(body.body.contact_points.cols(), expected.cols());
    EXPECT_LT(((X_JB.R * body.body.contact_points).colwise() + X_JB.p - expected).norm(), 1e-15);
  }
}

TEST_F(MadeBodies, MirroredMeshesHaveTheirOutsideOutside) {
  const auto wedge = [this](const char* scale) {
    return built(
        concat("<body type=\"mesh\" filename=\"wedge.obj\" transform_type=\"OBJ_TO_JOINT\" "
               "scale=\"",
               scale, "\"/>"));
  };
  const BuiltBody straight = wedge("1 1 1");
  const BuiltBody mirrored = wedge("1 -1 1");
  EXPECT_NEAR(mirrored.body.mass, straight.body.mass, 1e-15);
  EXPECT_LT((mirrored.body.inertia - straight.body.inertia).norm(), 1e-15);
  EXPECT_LT(
      (mirrored.body.X_JB.p - straight.body.X_JB.p.cwiseProduct(Eigen::Vector3d(1, -1, 1))).norm(),
      1e-15);
  EXPECT_NO_THROW(check_solid(mirrored.mesh->surface));
}

TEST_F(MadeBodies, WhatWasMendedInAMeshIsTold) {
  // Near a corner of a cube, on the one face only, is another vertex.
  std::ofstream(folder_ / "cube.obj")
      << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
         "v 1 1 1.0000000001\nf 4 3 2 1\nf 5 6 9 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const BuiltBody body = built("<body type=\"mesh\" filename=\"cube.obj\"/>");
  ASSERT_EQ(body.notices.size(), 1U);
  EXPECT_EQ(
      body.notices[0].substr(body.notices[0].find("<body")),
      "<body filename=\"cube.obj\">: a vertex lies within 1e-6 of the bounding box's diagonal "
      "of another: merged");
  EXPECT_NEAR(body.body.mass, 1.0, 1e-9);
}

TEST_F(MadeBodies, MeshesKeepTheirSurfaceInTheBodyFrame) {
  const BuiltBody body =
      built("<body type=\"mesh\" filename=\"wedge.obj\" density=\"3\" distance_cells=\"9\"/>");
  ASSERT_TRUE(body.mesh);
  EXPECT_EQ(body.mesh->cells, 9);
  EXPECT_EQ(body.mesh->file, folder_ / "wedge.obj");
  const SolidMoments moments = solid_moments(body.mesh->surface);
  EXPECT_LT(moments.centre.norm(), 1e-16);
  EXPECT_NEAR(3.0 * moments.volume, body.body.mass, 1e-15);
  const Eigen::Matrix3d principal = body.body.inertia.asDiagonal();
  EXPECT_LT((3.0 * moments.inertia - principal).norm(), 1e-14 * principal.norm());
}

TEST_F(MadeBodies, RefusesFilesOfSomethingElse) {
  EXPECT_EQ(refusal("<body type=\"abstract\" mass=\"1\" inertia=\"1 1 1\" contacts=\"bad.txt\"/>"),
            "a.xml:5: <body contacts=\"bad.txt\">: bad.txt:2: found 2 words; a point is x y z");
  EXPECT_EQ(refusal("<body type=\"abstract\" mass=\"1\" inertia=\"1 1 1\">\n<collision "
                    "contacts=\"none.txt\"/></body>"),
            "a.xml:6: <collision contacts=\"none.txt\">: " + (folder_ / "none.txt").string() +
                ": cannot be opened: No such file or directory");
  EXPECT_EQ(refusal("<body type=\"mesh\" filename=\"wedge.obj\" contacts=\"bad.txt\"/>"),
            "a.xml:5: <body contacts=\"bad.txt\">: bad.txt:2: found 2 words; a point is x y z");
}

TEST_F(MadeBodies, RefusesAChoiceOfPointsThatWouldTakeMinutes) {
  const TriangleMesh ball = icosphere(1.0, 6);
  {
    std::ofstream out(folder_ / "ball.obj");
    for (const Eigen::Vector3d& x : ball.vertices) {
      out << "v " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
    }
    for (const std::array<int, 3>& corner : ball.triangles) {
      out << "f " << corner[0] + 1 << ' ' << corner[1] + 1 << ' ' << corner[2] + 1 << '\n';
    }
  }
  EXPECT_EQ(
      refusal("<body type=\"mesh\" filename=\"ball.obj\" contact_count=\"30000\"/>"),
      "a.xml:5: <body contact_count=\"30000\">: of the 40962 vertices of ball.obj at most 24412 "
      "can be chosen; give fewer, or the points in a file: contacts");
}

TEST(BuiltBodies, AreFoundByName) {
  const BuiltBodies bodies{{}, {{"box", 3}}};
  EXPECT_EQ(bodies.find("box"), 3);
  try {
    static_cast<void>(bodies.find("bxo"));
    ADD_FAILURE() << "was found";
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "no body is named 'bxo'");
  }
}

}  // namespace
}  // namespace hbar::scene
