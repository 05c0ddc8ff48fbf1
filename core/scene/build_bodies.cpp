#include "hbar/core/scene/build_bodies.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "hbar/core/base/error.h"
#include "hbar/core/geometry/mesh_overlap.h"
#include "hbar/core/geometry/surface_points.h"
#include "hbar/core/model/model_builder.h"
#include "hbar/core/scene/principal_axes.h"
#include "hbar/core/scene/read_mesh.h"
#include "hbar/core/scene/read_points.h"
#include "hbar/core/scene/spread_vertices.h"
#include "hbar/core/scene/xml_element.h"

namespace hbar::scene {
namespace {

using Pose = RigidTransform<double>;

/// Points in another frame.
Eigen::Matrix3Xd transformed(const Pose& X_AB, const Eigen::Matrix3Xd& points) {
  return (X_AB.R * points).colwise() + X_AB.p;
}

/// Makes one body of a scene.
class BodyMaker {
 public:
  BodyMaker(const Scene& scene, const Body& body, const Pose& X_WJ)
      : scene_(scene), body_(body), X_WJ_(X_WJ) {}

  [[nodiscard]] BuiltBody make() const {
    return std::visit([this](const auto& shape) { return make(shape); }, body_.shape);
  }

 private:
  [[nodiscard]] BuiltBody make(const CuboidBody& shape) const {
    return solid(Cuboid{vector(shape.size)}, {.cuboid = shape.general_contact_resolution});
  }
  [[nodiscard]] BuiltBody make(const SphereBody& shape) const {
    return solid(Sphere{shape.radius},
                 {.sphere = shape.general_contact_resolution.value_or(std::array<int, 2>{0, 0})});
  }
  [[nodiscard]] BuiltBody make(const CylinderBody& shape) const {
    return solid(Cylinder{shape.radius, shape.length},
                 {.cylinder = {shape.general_contact_angle_resolution,
                               shape.general_contact_radius_resolution}});
  }
  [[nodiscard]] BuiltBody make(const CapsuleBody& shape) const {
    return solid(Capsule{shape.radius, shape.length},
                 {.capsule = shape.general_contact_resolution});
  }
  [[nodiscard]] BuiltBody solid(const Shape& shape, const SurfaceResolution& resolution) const {
    BuiltBody built{solid_body(body_.name, shape, body_.density, pose(body_.pos, body_.quat))};
    built.body.contact_points = surface_points(shape, resolution);
    return built;
  }

  [[nodiscard]] BuiltBody make(const AbstractBody& shape) const {
    const Pose X_JG = pose(body_.pos, body_.quat);
    BuiltBody built{hbar::Body{body_.name, X_JG, shape.mass, {}, NoShape{}, {}}};
    if (shape.inertia.size() == 3) {
      built.body.inertia = Eigen::Vector3d(shape.inertia[0], shape.inertia[1], shape.inertia[2]);
    } else {
      const PrincipalAxes principal = principal_axes(symmetric_matrix(shape.inertia));
      built.body.inertia = principal.moments;
      built.body.X_JB.R = X_JG.R * principal.axes;
      built.X_BG.R = principal.axes.transpose();
    }
    Eigen::Matrix3Xd& points = built.body.contact_points;
    points.resize(3, 0);
    if (shape.contacts) {
      points = transformed(built.X_BG, contacts("body", body_.line, *shape.contacts, shape.scale));
    }
    if (shape.collision) {
      const Collision& more = *shape.collision;
      const Eigen::Matrix3Xd others =
          transformed(built.X_BG * pose(more.pos, more.quat),
                      contacts("collision", more.line, more.contacts, shape.scale));
      points.conservativeResize(3, points.cols() + others.cols());
      points.rightCols(others.cols()) = others;
    }
    return built;
  }

  [[nodiscard]] BuiltBody make(const MeshBody& shape) const {
    MendedMesh file = mesh_of(shape);  // in the file's frame O
    TriangleMesh& mesh = file.mesh;
    if (!shape.contacts) {
      check_choice(shape.contact_count, mesh);
    }
    const SolidMoments moments = solid_moments(mesh);
    const PrincipalAxes principal = principal_axes(moments.inertia);
    const Pose X_OB = {principal.axes, moments.centre};
    const Pose X_BO = inverse(X_OB);
    Pose X_JB = pose(body_.pos, body_.quat);
    if (shape.transform_type == MeshTransform::kObjToJoint) {
      X_JB = X_JB * X_OB;
    }
    if (shape.transform_type == MeshTransform::kObjToWorld) {
      X_JB = inverse(X_WJ_) * X_JB * X_OB;
    }
    BuiltBody built{hbar::Body{body_.name,
                               X_JB,
                               body_.density * moments.volume,
                               body_.density * principal.moments,
                               NoShape{},
                               {}},
                    X_BO};
    built.body.contact_points = transformed(
        X_BO, shape.contacts ? contacts("body", body_.line, *shape.contacts, shape.scale)
                             : spread_vertices(mesh, moments.centre, shape.contact_count));
    for (Eigen::Vector3d& vertex : mesh.vertices) {
      vertex = X_BO.R * vertex + X_BO.p;
    }
    built.mesh = BodyMesh{std::move(mesh), scene_.find(shape.filename), shape.distance_cells};
    for (const std::string& notice : file.notices) {
      built.notices.push_back(place("body", body_.line, "filename", shape.filename) + notice);
    }
    return built;
  }

  /// The solid's surface in the OBJ's frame, scaled.
  [[nodiscard]] MendedMesh mesh_of(const MeshBody& shape) const {
    return with_place(place("body", body_.line, "filename", shape.filename), [&] {
      MendedMesh file = read_mesh(scene_.find(shape.filename));
      for (Eigen::Vector3d& point : file.mesh.vertices) {
        point = point.cwiseProduct(vector(shape.scale));
      }
      if (vector(shape.scale).prod() < 0.0) {  // mirrored: the outside is the other side
        for (std::array<int, 3>& triangle : file.mesh.triangles) {
          std::swap(triangle[1], triangle[2]);
        }
      }
      check_solid(file.mesh);
      check_overlap(file.mesh);
      return file;
    });
  }

  /// Refuses a choice of contact points that would take minutes: each is compared with all
  /// vertices.
  void check_choice(int count, const TriangleMesh& mesh) const {
    constexpr double kMostComparisons = 1e9;
    const auto vertices = static_cast<double>(mesh.vertices.size());
    const double most = kMostComparisons / std::max(vertices, 1.0);
    if (std::min<double>(count, vertices) > most) {
      throw InvalidInput(place("body", body_.line, "contact_count", concat(count)) +
                         concat("of the ", mesh.vertices.size(), " vertices of ", mesh_name(),
                                " at most ", static_cast<int>(most),
                                " can be chosen; give fewer, or the points in a file: contacts"));
    }
  }

  [[nodiscard]] const std::string& mesh_name() const {
    return std::get<MeshBody>(body_.shape).filename;
  }

  /// The points of a file, scaled.
  [[nodiscard]] Eigen::Matrix3Xd contacts(const char* element, SourceLine line,
                                          const std::string& file, const Vec3& scale) const {
    return with_place(place(element, line, "contacts", file), [&] {
      const std::vector<Eigen::Vector3d> points = read_contacts(scene_.find(file));
      Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
      for (std::size_t i = 0; i < points.size(); ++i) {
        columns.col(static_cast<Eigen::Index>(i)) = points[i].cwiseProduct(vector(scale));
      }
      return columns;
    });
  }

  /// The beginning of messages about a file the scene names.
  [[nodiscard]] std::string place(const char* element, SourceLine line, const char* attribute,
                                  const std::string& file) const {
    return attribute_place({scene_.file, {}, {}}, line.number, element, attribute, file);
  }

  const Scene& scene_;
  const Body& body_;
  const Pose& X_WJ_;
};

}  // namespace

int BuiltBodies::find(const std::string& body) const {
  const auto place = link_of.find(body);
  if (place == link_of.end()) {
    throw InvalidInput(concat("no body is named '", body, "'"));
  }
  return place->second;
}

Eigen::Vector3d vector(const Vec3& v) { return {v[0], v[1], v[2]}; }

RigidTransform<double> pose(const Vec3& pos, const Quat& quat) {
  const Eigen::Quaterniond rotation(quat[0], quat[1], quat[2], quat[3]);
  return {rotation.toRotationMatrix(), vector(pos)};
}

BuiltBody build_body(const Scene& scene, const Body& body, const RigidTransform<double>& X_WJ) {
  return BodyMaker(scene, body, X_WJ).make();
}

}  // namespace hbar::scene
