#include "hbar/core/model/tree.h"

namespace hbar {
int Tree::path_through(int i) {
  const int above = ancestors_[static_cast<std::size_t>(i)];
  const CoordinateRange own = node(i).coordinates;
  if (own.begin == own.end) {
    return above;
  }
  CoordinatePath::Step step{own, above};
  if (above >= 0) {
    const CoordinatePath::Step& last = steps_[static_cast<std::size_t>(above)];
    if (last.range.end == own.begin) {  // one range with it
      step = {{last.range.begin, own.end}, last.next};
    }
  }
  steps_.push_back(step);
  return static_cast<int>(steps_.size()) - 1;
}

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
    ancestors_.push_back(parent < 0 ? -1 : path_through(parent));
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
