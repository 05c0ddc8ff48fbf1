#include "hbar/core/parameters/sparsity.h"

#include <set>

namespace hbar {

std::vector<std::vector<int>> tree_pattern(const Tree& tree) {
  std::vector<std::vector<int>> pattern(static_cast<std::size_t>(tree.dof()));
  for (int l = 0; l < tree.dof(); ++l) {
    const int node = tree.node_of(l);
    const auto couple = [&](int c) { pattern[static_cast<std::size_t>(c)].push_back(l); };
    for (int c = 0; c < tree.dof(); ++c) {
      const int other = tree.node_of(c);
      if (tree.is_on_path(other, node) || tree.is_on_path(node, other)) {
        couple(c);
      }
    }
  }
  return pattern;
}

std::vector<std::vector<int>> residual_pattern(const Model& model) {
  const std::vector<std::vector<int>> tree = tree_pattern(model.tree());
  std::vector<std::set<int>> rows;
  for (const std::vector<int>& column : tree) {
    rows.emplace_back(column.begin(), column.end());
  }
  for (const Contact& contact : model.contacts()) {
    const std::vector<int> coupled = coupled_coordinates(model, contact);
    for (const int c : coupled) {
      rows[static_cast<std::size_t>(c)].insert(coupled.begin(), coupled.end());
    }
  }
  std::vector<std::vector<int>> pattern;
  for (const std::set<int>& column : rows) {
    pattern.emplace_back(column.begin(), column.end());
  }
  return pattern;
}

std::vector<int> coupled_coordinates(const Model& model, const Contact& contact) {
  std::vector<int> out;
  for (int l = 0; l < model.dof(); ++l) {
    const int node = model.tree().node_of(l);
    const auto moves = [&](int link) {
      return link >= 0 && model.tree().is_on_path(node, model.node_of_link(link));
    };
    if (moves(contact.link) || moves(contact.other)) {
      out.push_back(l);
    }
  }
  return out;
}

}  // namespace hbar
