#pragma once

#include <vector>

#include "hbar/core/model/joint.h"

namespace hbar {

/// A contiguous range of coordinates, [begin, end).
struct CoordinateRange {
  int begin = 0;
  int end = 0;
  friend bool operator==(const CoordinateRange&, const CoordinateRange&) = default;
};

/// One elementary motion of one joint. A joint with several motions is a chain of nodes, the last
/// of which carries the body; the others are massless.
struct Node {
  int parent = -1;  ///< node, or −1 for the world; parent < this node
  MotionKind motion = MotionKind::kFixed;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  int link = 0;                 ///< the link whose joint this belongs to
  bool first = true;            ///< first node of its joint: X_PJ acts here
  bool last = true;             ///< last node of its joint: the body sits here
  CoordinateRange coordinates;  ///< of this motion: 0, 1 or 3 of them
};

/// The kinematic tree as the recursions see it: nodes in topological order, coordinates in file
/// order, and their ancestry.
class Tree {
 public:
  /// Appends a joint's nodes below `parent_node` (−1: world). Returns its last node.
  int add_joint(const JointKind& kind, int parent_node, int link);

  [[nodiscard]] int node_count() const { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] int dof() const { return dof_; }
  [[nodiscard]] const Node& node(int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }

  /// Coordinates of the strict ancestors of node i, as maximal contiguous ranges, ascending.
  [[nodiscard]] const std::vector<CoordinateRange>& ancestors(int i) const {
    return ancestors_[static_cast<std::size_t>(i)];
  }
  /// The node a coordinate belongs to.
  [[nodiscard]] int node_of(int coordinate) const {
    return node_of_[static_cast<std::size_t>(coordinate)];
  }
  /// Whether node `above` is `below` or lies on its path to the world.
  [[nodiscard]] bool is_on_path(int above, int below) const;

 private:
  std::vector<Node> nodes_;
  std::vector<std::vector<CoordinateRange>> ancestors_;
  std::vector<int> node_of_;
  int dof_ = 0;
};

}  // namespace hbar
