#include "hbar/core/parameters/parameter_rows.h"

#include "hbar/core/dynamics/motion.h"
#include "hbar/core/parameters/sparsity.h"

namespace hbar::detail {
namespace {

/// Rows of coordinates, collected in any order.
class Rows {
 public:
  explicit Rows(const Model& model) : model_(model), wanted_(index(model.dof()), false) {}

  /// Those whose node is accepted.
  template <typename Accept>
  Rows& nodes(const Accept& accept) {
    for (int l = 0; l < model_.dof(); ++l) {
      wanted_[index(l)] = wanted_[index(l)] || accept(model_.tree().node_of(l));
    }
    return *this;
  }
  /// Those on the path to a link's body.
  Rows& path(int link) {
    return nodes([&](int i) { return model_.tree().is_on_path(i, model_.node_of_link(link)); });
  }
  /// Those of a link's joint.
  Rows& joint(int link) {
    return nodes([&](int i) { return model_.tree().node(i).link == link; });
  }
  /// Those that an accepted contact couples: accept(index, contact).
  template <typename Accept>
  Rows& contacts(const Accept& accept) {
    for (int i = 0; i < model_.contact_count(); ++i) {
      if (accept(i, model_.contact(i))) {
        for (const int l : coupled_coordinates(model_, model_.contact(i))) {
          wanted_[index(l)] = true;
        }
      }
    }
    return *this;
  }
  /// Those that contacts of accepted links couple, on either side.
  template <typename Accept>
  Rows& contacts_of(const Accept& accept) {
    return contacts([&](int, const Contact& contact) {
      return accept(contact.link) || (contact.other >= 0 && accept(contact.other));
    });
  }

  [[nodiscard]] std::vector<int> list() const {
    std::vector<int> rows;
    for (int l = 0; l < model_.dof(); ++l) {
      if (wanted_[index(l)]) {
        rows.push_back(l);
      }
    }
    return rows;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  const Model& model_;
  std::vector<bool> wanted_;
};

}  // namespace

std::vector<int> rows_of_joint_frame(const Model& model, int link) {
  const Tree& tree = model.tree();
  const int first = first_node_of_link(model, link);
  return Rows(model)
      .nodes([&](int i) { return tree.is_on_path(i, first) || tree.is_on_path(first, i); })
      .contacts_of([&](int moved) { return tree.is_on_path(first, model.node_of_link(moved)); })
      .list();
}
std::vector<int> rows_of_body(const Model& model, int link) {
  return Rows(model).path(link).contacts_of([&](int moved) { return moved == link; }).list();
}
std::vector<int> rows_of_inertia(const Model& model, int link) {
  return Rows(model).path(link).list();
}
std::vector<int> rows_of_points(const Model& model, int link) {
  return Rows(model)
      .contacts([&](int, const Contact& contact) { return contact.link == link; })
      .list();
}
std::vector<int> rows_of_contact(const Model& model, int index) {
  return Rows(model).contacts([&](int i, const Contact&) { return i == index; }).list();
}
std::vector<int> rows_of_joint(const Model& model, int link) {
  return Rows(model).joint(link).list();
}
std::vector<int> rows_of_motor(const Model& model, int motor) {
  return Rows(model).joint(model.motors()[static_cast<std::size_t>(motor)].link).list();
}
std::vector<int> every_row(const Model& model, int) {
  return Rows(model).nodes([](int) { return true; }).list();
}

}  // namespace hbar::detail
