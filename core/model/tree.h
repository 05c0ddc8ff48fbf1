#pragma once

#include <cstddef>
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

/// Ranges of coordinates on the way from a node to the world, the nearest first. Borrows the tree.
class CoordinatePath {
 public:
  /// A range, and the index of the one before it on the way to the world; −1: there is none.
  struct Step {
    CoordinateRange range;
    int next = -1;
  };
  /// Goes to the world, range by range.
  class Iterator {
   public:
    Iterator(const std::vector<Step>* steps, int at) : steps_(steps), at_(at) {}
    const CoordinateRange& operator*() const { return step().range; }
    Iterator& operator++() {
      at_ = step().next;
      return *this;
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }

   private:
    [[nodiscard]] const Step& step() const { return (*steps_)[static_cast<std::size_t>(at_)]; }

    const std::vector<Step>* steps_;
    int at_;
  };

  CoordinatePath(const std::vector<Step>& steps, int first) : steps_(&steps), first_(first) {}
  [[nodiscard]] Iterator begin() const { return {steps_, first_}; }
  [[nodiscard]] Iterator end() const { return {steps_, -1}; }
  [[nodiscard]] bool empty() const { return first_ < 0; }

 private:
  const std::vector<Step>* steps_;
  int first_;
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

  /// Coordinates of the strict ancestors of node i, as maximal contiguous ranges, descending.
  [[nodiscard]] CoordinatePath ancestors(int i) const {
    return {steps_, ancestors_[static_cast<std::size_t>(i)]};
  }
  /// The node a coordinate belongs to.
  [[nodiscard]] int node_of(int coordinate) const {
    return node_of_[static_cast<std::size_t>(coordinate)];
  }
  /// Whether node `above` is `below` or lies on its path to the world.
  [[nodiscard]] bool is_on_path(int above, int below) const;

 private:
  /// Where the path begins that goes through node i and its ancestors.
  int path_through(int i);

  std::vector<Node> nodes_;
  // Paths share their ends, so that all of them together take memory in proportion to the nodes.
  std::vector<CoordinatePath::Step> steps_;
  std::vector<int> ancestors_;  // per node: where its path begins in steps_
  std::vector<int> node_of_;
  int dof_ = 0;
};

}  // namespace hbar
