#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "hbar/core/geometry/mesh.h"

namespace hbar {

/// A box centred at the origin.
inline TriangleMesh box_mesh(const Eigen::Vector3d& size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d bits(i & 1, i / 2 & 1, i / 4);
    mesh.vertices.emplace_back((bits.array() - 0.5) * size.array());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// An icosahedron whose triangles are cut into four, `levels` times, with vertices on a sphere
/// about the origin.
inline TriangleMesh icosphere(double radius, int levels) {
  const double t = (1.0 + std::sqrt(5.0)) / 2.0;
  TriangleMesh mesh;
  mesh.vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                   {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [place, is_new] =
          middles.emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (is_new) {
        mesh.vertices.push_back((mesh.vertices[static_cast<std::size_t>(a)] +
                                 mesh.vertices[static_cast<std::size_t>(b)]) /
                                2.0);
      }
      return place->second;
    };
    TriangleMesh finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b);
      const int bc = middle(b, c);
      const int ca = middle(c, a);
      finer.triangles.insert(finer.triangles.end(),
                             {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer.triangles;
    for (Eigen::Vector3d& vertex : mesh.vertices) {
      vertex.normalize();
    }
  }
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex *= radius / vertex.norm();
  }
  return mesh;
}

/// A spiky star: an icosphere with random radii from 0.5 to 1.5. It does not cut itself.
inline TriangleMesh star_mesh(int levels, unsigned seed) {
  TriangleMesh mesh = icosphere(1.0, levels);
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> radius(0.5, 1.5);
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex *= radius(engine);
  }
  return mesh;
}

/// The same elsewhere.
inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex += by;
  }
  return mesh;
}

/// The same with its other side outside.
inline TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (std::array<int, 3>& t : mesh.triangles) {
    std::swap(t[1], t[2]);
  }
  return mesh;
}

/// Two surfaces in one mesh, each with vertices of its own.
inline TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const int first = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const std::array<int, 3>& t : b.triangles) {
    a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return a;
}

/// A point with coordinates from −size to size.
inline Eigen::Vector3d random_point(std::mt19937& engine, double size) {
  std::uniform_real_distribution<double> coordinate(-size, size);
  return Eigen::Vector3d::NullaryExpr([&] { return coordinate(engine); });
}

/// Signed distance to the surface of a box centred at the origin.
inline double box_distance(const Eigen::Vector3d& size, const Eigen::Vector3d& x) {
  const Eigen::Vector3d beyond = x.cwiseAbs() - size / 2.0;
  return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
}

}  // namespace hbar
