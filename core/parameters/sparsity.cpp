#include "hbar/core/parameters/sparsity.h"

#include <set>

#include "hbar/core/dynamics/motion.h"

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

std::vector<int> parameter_rows(const Model& model, const ParameterBlock& block) {
  const Tree& tree = model.tree();
  std::vector<bool> wanted(static_cast<std::size_t>(tree.dof()), false);
  const auto keep = [&](const auto& is_row) {
    for (int l = 0; l < tree.dof(); ++l) {
      wanted[static_cast<std::size_t>(l)] =
          wanted[static_cast<std::size_t>(l)] || is_row(tree.node_of(l));
    }
  };
  const auto keep_contacts = [&](const auto& changes) {
    for (int i = 0; i < model.contact_count(); ++i) {
      if (changes(i)) {
        for (const int l : coupled_coordinates(model, model.contact(i))) {
          wanted[static_cast<std::size_t>(l)] = true;
        }
      }
    }
  };
  /// Contacts of which either body is one that `moved` accepts.
  const auto keep_contacts_of = [&](const auto& moved) {
    keep_contacts([&](int i) {
      const Contact& contact = model.contact(i);
      return moved(contact.link) || (contact.other >= 0 && moved(contact.other));
    });
  };
  const auto is_owner = [&](int link) { return link == block.owner; };
  switch (block.kind) {
    case ParameterKind::kJointTransform: {
      const int first = first_node_of_link(model, block.owner);
      keep([&](int i) { return tree.is_on_path(i, first) || tree.is_on_path(first, i); });
      keep_contacts_of([&](int link) { return tree.is_on_path(first, model.node_of_link(link)); });
      break;
    }
    case ParameterKind::kBodyTransform:
    case ParameterKind::kSize: {
      const int node = model.node_of_link(block.owner);
      keep([&](int i) { return tree.is_on_path(i, node); });
      keep_contacts_of(is_owner);
      break;
    }
    case ParameterKind::kMass:
    case ParameterKind::kInertia: {
      const int node = model.node_of_link(block.owner);
      keep([&](int i) { return tree.is_on_path(i, node); });
      break;
    }
    case ParameterKind::kContactPoint:
    case ParameterKind::kContactScale:
      keep_contacts([&](int i) { return model.contact(i).link == block.owner; });
      break;
    case ParameterKind::kContactCoefficient:
      keep_contacts([&](int i) { return i == block.owner; });
      break;
    case ParameterKind::kStiffness:
    case ParameterKind::kDamping:
      keep([&](int i) { return tree.node(i).link == block.owner; });
      break;
    case ParameterKind::kMotorP:
    case ParameterKind::kMotorD: {
      const int link = model.motors()[static_cast<std::size_t>(block.owner)].link;
      keep([&](int i) { return tree.node(i).link == link; });
      break;
    }
    case ParameterKind::kGravity:
      keep([](int) { return true; });
      break;
  }
  std::vector<int> rows;
  for (int l = 0; l < tree.dof(); ++l) {
    if (wanted[static_cast<std::size_t>(l)]) {
      rows.push_back(l);
    }
  }
  return rows;
}

}  // namespace hbar
