#include "hbar/core/model/tree.h"

namespace hbar {
namespace {

/// `ranges` followed by `next`, merged where they touch.
std::vector<CoordinateRange> extended(std::vector<CoordinateRange> ranges, CoordinateRange next) {
  if (next.begin == next.end) {
    return ranges;
  }
  if (!ranges.empty() && ranges.back().end == next.begin) {
    ranges.back().end = next.end;
  } else {
    ranges.push_back(next);
  }
  return ranges;
}

}  // namespace

int Tree::add_joint(const JointKind& kind, int parent_node, int link) {
  const std::vector<ElementaryMotion> motions = elementary_motions(kind);
  int parent = parent_node;
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const int index = node_count();
    Node node;
    node.parent = parent;
    node.motion = motions[m].kind;
    node.axis = motions[m].axis;
    node.link = link;
    node.first = m == 0;
    node.last = m + 1 == motions.size();
    node.coordinates = {dof_, dof_ + motion_dof(node.motion)};
    ancestors_.push_back(parent < 0 ? std::vector<CoordinateRange>{}
                                    : extended(ancestors(parent), this->node(parent).coordinates));
    nodes_.push_back(node);
    for (int c = node.coordinates.begin; c < node.coordinates.end; ++c) {
      node_of_.push_back(index);
    }
    dof_ = node.coordinates.end;
    parent = index;
  }
  return parent;
}

bool Tree::is_on_path(int above, int below) const {
  int i = below;
  while (i > above) {
    i = node(i).parent;
  }
  return i == above;
}

}  // namespace hbar
