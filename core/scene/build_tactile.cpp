#include "hbar/core/scene/build_tactile.h"

#include <Eigen/Dense>
#include <utility>

#include "hbar/core/base/unit_vector.h"
#include "hbar/core/scene/read_points.h"
#include "hbar/core/scene/xml_element.h"

namespace hbar::scene {
namespace {

using Pose = RigidTransform<double>;

/// Where point i of `count` lies between 0 and 1.
double share(int i, int count) { return count > 1 ? static_cast<double>(i) / (count - 1) : 0.5; }

std::vector<SensorPoint> rectangle_points(const RectArray& rect) {
  Eigen::Matrix<double, 3, 2> axes;
  axes << unit_vector(vector(rect.axis0)), unit_vector(vector(rect.axis1));
  const Eigen::Vector3d origin = vector(rect.rect_pos0);
  // How far the opposite corner lies along each axis: its projection onto their plane, in the basis
  // dual to them.
  const Eigen::Vector3d diagonal = vector(rect.rect_pos1) - origin;
  const Eigen::Vector3d normal = axes.col(0).cross(axes.col(1));
  if (normal.norm() < 1e-9) {
    throw InvalidInput("the axes axis0 and axis1 are zero or parallel; they span a plane");
  }
  const Eigen::Vector2d sides = Eigen::Vector2d(diagonal.cross(axes.col(1)).dot(normal),
                                                axes.col(0).cross(diagonal).dot(normal)) /
                                normal.squaredNorm();
  const auto [n0, n1] = rect.resolution;
  std::vector<SensorPoint> points;
  for (int i = 0; i < n0; ++i) {
    for (int j = 0; j < n1; ++j) {
      const Eigen::Vector2d along(share(i, n0) * sides[0], share(j, n1) * sides[1]);
      points.push_back({origin + axes * along, axes.col(0), axes.col(1)});
    }
  }
  return points;
}

std::vector<SensorPoint> listed_points(const Scene& scene, const PointList& list) {
  const Pose X = pose(list.pos, list.quat);
  std::vector<SensorPoint> points = read_sensor_points(scene.find(list.spec));
  if (points.empty()) {
    throw InvalidInput("the file has no point; a sensor has at least one");
  }
  for (SensorPoint& point : points) {
    point = {X.R * point.position + X.p, X.R * point.axis0, X.R * point.axis1};
  }
  return points;
}

/// A sensor of points in the frame X_BG of its body.
hbar::TactileSensor make_sensor(const TactileSensor& sensor, const Pose& X_BG,
                                const std::vector<SensorPoint>& points) {
  hbar::TactileSensor made;
  made.name = sensor.name;
  made.coefficients = {sensor.kn, sensor.kt, sensor.mu, sensor.damping};
  const auto count = static_cast<Eigen::Index>(points.size());
  made.points.resize(3, count);
  made.axis0.resize(3, count);
  made.axis1.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const SensorPoint& point = points[static_cast<std::size_t>(i)];
    made.points.col(i) = X_BG.R * point.position + X_BG.p;
    made.axis0.col(i) = X_BG.R * point.axis0;
    made.axis1.col(i) = X_BG.R * point.axis1;
  }
  return made;
}

}  // namespace

void add_tactile_sensors(const Scene& scene, const BuiltBodies& bodies, ModelBuilder& builder) {
  for (const TactileSensor& sensor : scene.description.tactile_sensors) {
    const auto* const list = std::get_if<PointList>(&sensor.points);
    const ReadContext context{scene.file, {}, {}};
    const int line = sensor.line.number;
    const std::string place = list ? attribute_place(context, line, "tactile", "spec", list->spec)
                                   : attribute_place(context, line, "tactile", "name", sensor.name);
    with_place(place, [&] {
      const int link = bodies.find(sensor.body);
      hbar::TactileSensor made =
          make_sensor(sensor, bodies.of_link.at(static_cast<std::size_t>(link)).X_BG,
                      list ? listed_points(scene, *list)
                           : rectangle_points(std::get<RectArray>(sensor.points)));
      made.link = link;
      builder.add_tactile_sensor(std::move(made));
    });
  }
}

}  // namespace hbar::scene
