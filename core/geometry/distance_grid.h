#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <memory>
#include <string>
#include <string_view>

#include "hbar/core/geometry/distance_field.h"
#include "hbar/core/geometry/mesh.h"
#include "hbar/core/geometry/tricubic_spline.h"

namespace hbar {

/// Cells along the longest side of a distance grid: default and allowed range. n cells take at most
/// 8 (n + 9)³ bytes: 1.5 MB for 48, 149 MB for 256.
inline constexpr int kDistanceCells = 48;
inline constexpr int kMinDistanceCells = 4;    ///< fewest
inline constexpr int kMaxDistanceCells = 256;  ///< most

/// The signed distance of a solid as the tricubic spline through its exact values at the nodes of a
/// uniform grid, three cells wider than the solid on every side.
///
/// The spline φ is the surface that contacts see. It is twice continuously differentiable. Its
/// error is of order cell⁴ where the distance is smooth, and a fraction of a cell where it has a
/// kink: at sharp edges (which are rounded), in a gap or wall a few cells wide, and on the medial
/// axis deep inside. max_error() gives the error near the surface.
class DistanceGrid final : public DistanceField {
 public:
  /// @param mesh   a closed surface in the body's frame, length, see TriangleDistance
  /// @param cells  along the longest side of the mesh's bounding box
  /// @param stop   ends the computation when it is set; may be null
  /// @throws InvalidInput as check_solid does, or if there are too few or too many cells
  /// @throws Interrupted  if `stop` is set before a plane of nodes or cells
  explicit DistanceGrid(const TriangleMesh& mesh, int cells = kDistanceCells,
                        const std::atomic<bool>* stop = nullptr);

  /// Restores a grid from the result of bytes().
  ///
  /// @throws InvalidInput if it is anything else: of another version, truncated, altered
  explicit DistanceGrid(std::string_view bytes);

  /// φ on the grid; outside it, the distance to the bounding box of the mesh, which is positive
  /// there, like φ.
  [[nodiscard]] double lower_bound(const Eigen::Vector3d& x) const override;

  /// Outside the grid φ grows along each axis as the distance to the grid does: half to
  /// twice the true distance, and as smooth as on the grid.
  [[nodiscard]] Sample sample(const Eigen::Vector3d& x) const override;

  /// Jumps at the borders of cells.
  [[nodiscard]] Eigen::Matrix3d hessian_slope(const Eigen::Vector3d& x,
                                              const Eigen::Vector3d& direction) const override;

  /// If the other is a grid of the same nodes, coefficients and mesh's box.
  [[nodiscard]] bool same_as(const DistanceField& other) const override;

  /// The largest |φ − exact distance| at the centres of the cells (where a spline errs most) within
  /// two cells of the surface, length. Measured when the grid was made.
  [[nodiscard]] double max_error() const { return state_.max_error; }

  /// The nodes of the grid.
  [[nodiscard]] const GridNodes& nodes() const { return state_.spline.nodes(); }

  /// The whole grid as a string of bytes with a version and a checksum. Numbers are in this
  /// machine's byte order; a machine with another byte order refuses them.
  [[nodiscard]] std::string bytes() const;

 private:
  struct State {
    TricubicSpline spline;
    Eigen::AlignedBox3d box;  // of the mesh
    double max_error;
  };
  explicit DistanceGrid(State state);
  static State build(const TriangleMesh& mesh, int cells, const std::atomic<bool>* stop);
  static State read(std::string_view bytes);

  State state_;
  Eigen::AlignedBox3d domain_;  // of the nodes
};

/// The distance grid of a mesh, for a contact.
///
/// @param mesh_in_body_frame  a closed surface, length
/// @param cells               along the longest side of its bounding box
/// @param stop                ends the computation when it is set; may be null
/// @throws InvalidInput, Interrupted  as DistanceGrid does
[[nodiscard]] std::shared_ptr<const DistanceField> mesh_distance(
    const TriangleMesh& mesh_in_body_frame, int cells = kDistanceCells,
    const std::atomic<bool>* stop = nullptr);

}  // namespace hbar
