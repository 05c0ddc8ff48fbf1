#include "hbar/core/geometry/distance_grid.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "hbar/core/base/checksum.h"
#include "hbar/core/base/error.h"
#include "hbar/core/base/stop_flag.h"
#include "hbar/core/geometry/triangle_distance.h"

namespace hbar {
namespace {

/// Cells beyond the mesh on every side. The spline levels off beyond the last node, so that it is
/// positive there; the ends' influence on it falls by 3.7 a cell.
constexpr int kMargin = 3;
/// Distance from the surface, in cells, within which max_error is measured.
constexpr double kNear = 2.0;
/// The bytes begin with this, then numbers: the version, the nodes, the mesh's box, the error, the
/// coefficients and the checksum of all before it.
constexpr std::string_view kMagic = "hbardist";
constexpr std::uint64_t kVersion = 1;
/// More nodes on an axis than the largest grid has.
constexpr int kTooManyNodes = kMaxDistanceCells + 2 * kMargin + 8;

GridNodes place_nodes(const Eigen::AlignedBox3d& box, int cells) {
  if (cells < kMinDistanceCells || cells > kMaxDistanceCells) {
    throw InvalidInput(concat("distance grid: ", cells, " cells along the longest side; ",
                              kMinDistanceCells, " to ", kMaxDistanceCells,
                              " are allowed, and n take up to 8 (n + 9)^3 bytes"));
  }
  GridNodes nodes;
  nodes.spacing = box.sizes().maxCoeff() / cells;
  for (int axis = 0; axis < 3; ++axis) {
    // Rounding must not add a cell to the longest side.
    const double exactly = box.sizes()[axis] / nodes.spacing * (1.0 - 1e-12);
    nodes.count[axis] = static_cast<int>(std::ceil(exactly)) + 2 * kMargin + 1;
  }
  nodes.origin =
      box.center() - 0.5 * nodes.spacing * (nodes.count.array() - 1).cast<double>().matrix();
  return nodes;
}

/// Calls visit(i, j, k) for every node, or cell, of a grid; x runs fastest. Looks at `stop` before
/// each plane.
template <typename Visit>
void for_each(const Eigen::Vector3i& count, const std::atomic<bool>* stop, const Visit& visit) {
  for (int k = 0; k < count.z(); ++k) {
    require_running(stop, "distance grid interrupted at plane ", k + 1, " of ", count.z());
    for (int j = 0; j < count.y(); ++j) {
      for (int i = 0; i < count.x(); ++i) {
        visit(i, j, k);
      }
    }
  }
}

double measure_error(const TriangleDistance& exact, const TricubicSpline& spline,
                     const std::atomic<bool>* stop) {
  const GridNodes& nodes = spline.nodes();
  const double near = kNear * nodes.spacing;
  double largest = 0.0;
  int hint = 0;
  for_each(nodes.count.array() - 1, stop, [&](int i, int j, int k) {
    const Eigen::Vector3d x = nodes.point(i, j, k).array() + 0.5 * nodes.spacing;
    const double value = spline.value(x);
    if (std::abs(value) > near + nodes.spacing) {
      return;  // certainly not near: saves a search
    }
    const double distance = exact.signed_distance(x, hint);
    if (std::abs(distance) <= near) {
      largest = std::max(largest, std::abs(value - distance));
    }
  });
  return largest;
}

/// What is added to the levelled spline outside the grid, on one axis, and its derivatives: an
/// antiderivative of the smooth step 3 s² − 2 s³ over the two cells in which the spline levels off,
/// a straight line beyond.
std::array<double, 4> growth(double x, double low, double high, double cell) {
  const double sign = x < low ? -1.0 : 1.0;
  const double width = 2.0 * cell;
  const double s = (x < low ? low - x : (x > high ? x - high : 0.0)) / width;
  if (s >= 1.0) {
    return {width * (s - 0.5), sign, 0.0, 0.0};
  }
  return {width * s * s * s * (1.0 - s / 2.0), sign * s * s * (3.0 - 2.0 * s),
          6.0 * s * (1.0 - s) / width, s > 0.0 ? sign * (6.0 - 12.0 * s) / (width * width) : 0.0};
}

template <typename Number>
void append(std::string& bytes, Number number) {
  const auto part = std::bit_cast<std::array<char, sizeof number>>(number);
  bytes.append(part.data(), part.size());
}

void append(std::string& bytes, const Eigen::Vector3d& vector) {
  for (const double number : vector) {
    append(bytes, number);
  }
}

std::uint64_t checksum_of(std::string_view bytes) {
  Checksum sum;
  sum.add(bytes);
  return sum.value();
}

/// Takes numbers from the front of a string of bytes.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <typename Number>
  Number number() {
    std::array<char, sizeof(Number)> part = {};
    if (bytes_.size() < part.size()) {
      throw InvalidInput("distance grid: the data is cut short");
    }
    std::copy_n(bytes_.begin(), part.size(), part.begin());
    bytes_.remove_prefix(part.size());
    return std::bit_cast<Number>(part);
  }
  Eigen::Vector3d vector() {
    Eigen::Vector3d result;
    for (double& entry : result) {
      entry = number<double>();
    }
    return result;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
};

/// Whether the grid of some mesh could have these numbers. A checksum tells that they are those
/// that were written, not who wrote them.
bool are_of_a_mesh(const GridNodes& nodes, const Eigen::AlignedBox3d& box, double max_error,
                   const std::vector<double>& coefficients) {
  const double cells = box.sizes().maxCoeff() / nodes.spacing;
  // A mesh has a volume, which neither vanishes nor overflows.
  const double cell_volume = nodes.spacing * nodes.spacing * nodes.spacing;
  const bool placed = nodes.spacing > 0.0 && box.sizes().minCoeff() > 0.0 &&
                      cells > kMinDistanceCells - 0.5 && cells < kMaxDistanceCells + 0.5 &&
                      std::isnormal(cell_volume) &&
                      std::isfinite(cell_volume * cells * cells * cells) &&
                      Eigen::AlignedBox3d(nodes.origin, nodes.last()).contains(box) &&
                      max_error >= 0.0 && std::isfinite(max_error);
  // Distances of nodes are below the diagonal; a cubic spline through them overshoots by less than
  // 3 along each axis.
  const double largest = 27.0 * (nodes.last() - nodes.origin).norm();
  return placed && std::all_of(coefficients.begin(), coefficients.end(),
                               [&](double number) { return std::abs(number) <= largest; });
}

}  // namespace

DistanceGrid::DistanceGrid(State state)
    : state_(std::move(state)), domain_(nodes().origin, nodes().last()) {}

DistanceGrid::DistanceGrid(const TriangleMesh& mesh, int cells, const std::atomic<bool>* stop)
    : DistanceGrid(build(mesh, cells, stop)) {}

DistanceGrid::DistanceGrid(std::string_view bytes) : DistanceGrid(read(bytes)) {}

DistanceGrid::State DistanceGrid::build(const TriangleMesh& mesh, int cells,
                                        const std::atomic<bool>* stop) {
  const TriangleDistance exact(mesh);
  const GridNodes nodes = place_nodes(exact.box(), cells);
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(nodes.count.cast<std::int64_t>().prod()));
  int hint = 0;
  for_each(nodes.count, stop, [&](int i, int j, int k) {
    values.push_back(exact.signed_distance(nodes.point(i, j, k), hint));
  });
  TricubicSpline spline = TricubicSpline::through(nodes, values);
  const double max_error = measure_error(exact, spline, stop);
  return {std::move(spline), exact.box(), max_error};
}

double DistanceGrid::lower_bound(const Eigen::Vector3d& x) const {
  if (domain_.squaredExteriorDistance(x) > 0.0) {
    return state_.box.exteriorDistance(x);
  }
  return state_.spline.value(x);
}

DistanceField::Sample DistanceGrid::sample(const Eigen::Vector3d& x) const {
  const TricubicSpline::Jet jet = state_.spline.jet(x);
  Sample sample = {jet.value, jet.gradient, jet.hessian};
  if (domain_.contains(x)) {
    return sample;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto added = growth(x[axis], domain_.min()[axis], domain_.max()[axis], nodes().spacing);
    sample.distance += added[0];
    sample.gradient[axis] += added[1];
    sample.hessian(axis, axis) += added[2];
  }
  return sample;
}

Eigen::Matrix3d DistanceGrid::hessian_slope(const Eigen::Vector3d& x,
                                            const Eigen::Vector3d& direction) const {
  Eigen::Matrix3d slope = state_.spline.hessian_slope(x, direction);
  for (int axis = 0; axis < 3; ++axis) {
    const auto added = growth(x[axis], domain_.min()[axis], domain_.max()[axis], nodes().spacing);
    slope(axis, axis) += added[3] * direction[axis];
  }
  return slope;
}

bool DistanceGrid::same_as(const DistanceField& other) const {
  const auto* grid = dynamic_cast<const DistanceGrid*>(&other);
  return grid == this || (grid != nullptr && grid->nodes() == nodes() &&
                          grid->state_.box.min() == state_.box.min() &&
                          grid->state_.box.max() == state_.box.max() &&
                          grid->state_.spline.coefficients() == state_.spline.coefficients());
}

std::string DistanceGrid::bytes() const {
  const std::vector<double>& coefficients = state_.spline.coefficients();
  std::string bytes(kMagic);
  bytes.reserve(256 + sizeof(double) * coefficients.size());
  append(bytes, kVersion);
  for (const int count : nodes().count) {
    append(bytes, static_cast<std::int64_t>(count));
  }
  append(bytes, nodes().origin);
  append(bytes, nodes().spacing);
  append(bytes, state_.box.min());
  append(bytes, state_.box.max());
  append(bytes, state_.max_error);
  for (const double number : coefficients) {
    append(bytes, number);
  }
  append(bytes, checksum_of(bytes));
  return bytes;
}

DistanceGrid::State DistanceGrid::read(std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic) {
    throw InvalidInput("distance grid: the data is not that of a distance grid");
  }
  Reader reader(bytes.substr(kMagic.size()));
  if (const auto version = reader.number<std::uint64_t>(); version != kVersion) {
    throw InvalidInput(concat("distance grid: the data is of version ", version,
                              "; this program reads version ", kVersion));
  }
  GridNodes nodes;
  for (int& count : nodes.count) {
    const auto found = reader.number<std::int64_t>();
    if (found < 4 || found > kTooManyNodes) {
      throw InvalidInput(concat("distance grid: the data tells of ", found, " nodes on an axis"));
    }
    count = static_cast<int>(found);
  }
  nodes.origin = reader.vector();
  nodes.spacing = reader.number<double>();
  const Eigen::Vector3d low = reader.vector();
  const Eigen::Vector3d high = reader.vector();
  const double max_error = reader.number<double>();
  const Eigen::Vector3i padded = nodes.count.array() + 2;
  std::vector<double> coefficients(static_cast<std::size_t>(padded.cast<std::int64_t>().prod()));
  const std::size_t expected = sizeof(double) * coefficients.size() + sizeof(std::uint64_t);
  if (reader.left() != expected) {
    throw InvalidInput(concat("distance grid: ", reader.left(), " bytes where the coefficients of ",
                              listed(nodes.count), " nodes take ", expected));
  }
  for (double& number : coefficients) {
    number = reader.number<double>();
  }
  if (reader.number<std::uint64_t>() !=
      checksum_of(bytes.substr(0, bytes.size() - sizeof(std::uint64_t)))) {
    throw InvalidInput("distance grid: the data does not agree with its checksum");
  }
  const Eigen::AlignedBox3d box(low, high);
  if (!are_of_a_mesh(nodes, box, max_error, coefficients)) {
    throw InvalidInput("distance grid: the data holds numbers that no mesh leads to");
  }
  return {TricubicSpline(nodes, std::move(coefficients)), box, max_error};
}

std::shared_ptr<const DistanceField> mesh_distance(const TriangleMesh& mesh_in_body_frame,
                                                   int cells, const std::atomic<bool>* stop) {
  return std::make_shared<DistanceGrid>(mesh_in_body_frame, cells, stop);
}

}  // namespace hbar
