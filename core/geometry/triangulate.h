#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hbar {

/// Cuts a polygon into triangles of its own corners, every one of which is a corner of one: the
/// polygon's neighbours, which share its edges, then still fit. Concave polygons and corners in the
/// middle of an edge are fine, as are polygons that are not quite plane: what counts is their
/// projection along the mean normal. Ear clipping, as by G. H. Meisters, Polygons have ears, Amer.
/// Math. Monthly 82(6), 1975.
///
/// @param corners  in order, length; at least 3                                     [n] of [3]
/// @returns triangles of the same orientation, as indices of corners            [n - 2] of [3]
/// @throws InvalidInput  if the corners lie on a line, or the polygon cuts itself
[[nodiscard]] std::vector<std::array<int, 3>> triangulate(
    const std::vector<Eigen::Vector3d>& corners);

}  // namespace hbar
