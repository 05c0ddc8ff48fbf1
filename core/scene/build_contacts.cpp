#include "hbar/core/scene/build_contacts.h"

#include <memory>
#include <utility>

#include "hbar/core/base/unit_vector.h"
#include "hbar/core/scene/distance_cache.h"
#include "hbar/core/scene/xml_element.h"

namespace hbar::scene {
namespace {

NormalLaw normal_law(ContactLaw law) {
  return law == ContactLaw::kLinear ? NormalLaw::kLinear : NormalLaw::kDocument;
}

FrictionLaw friction_law(Friction friction) {
  return friction == Friction::kSmooth ? FrictionLaw::kSmooth : FrictionLaw::kDocument;
}

hbar::Reaction reaction(Reaction where) {
  return where == Reaction::kSurface ? hbar::Reaction::kSurface : hbar::Reaction::kPoint;
}

/// What does not depend on which bodies touch.
hbar::Contact make_law(const Contact& contact) {
  hbar::Contact made;
  made.name = contact.name.value_or("");
  made.coefficients = {contact.kn, contact.kt, contact.mu, contact.damping};
  made.normal_law = normal_law(contact.law);
  made.friction_law = friction_law(contact.friction);
  made.friction_width = contact.friction_width.value_or(0.0);
  made.adhesion = contact.adhesion;
  made.reaction = reaction(contact.reaction);
  return made;
}

Plane ground_plane(const Description& description) {
  const Ground ground = description.ground.value_or(Ground());
  return {vector(ground.pos), unit_vector(vector(ground.normal))};
}

/// Makes the contacts of a scene.
class ContactMaker {
 public:
  ContactMaker(const Scene& scene, const BuiltBodies& bodies, const std::atomic<bool>* stop)
      : bodies_(bodies), ground_(ground_plane(scene.description)), stop_(stop) {}

  [[nodiscard]] std::vector<hbar::Contact> make(const Contact& contact) {
    hbar::Contact first = make_law(contact);
    first.link = bodies_.find(contact.body_a);
    if (contact.kind == ContactKind::kGround) {
      first.surface = ground_;
      return {first};
    }
    first.other = bodies_.find(contact.body_b);
    if (contact.kind == ContactKind::kGeneralPrimitive) {
      first.surface = surface_of(first.other, contact.caps);
      return {first};
    }
    hbar::Contact second = first;
    std::swap(second.link, second.other);
    if (contact.name) {
      first.name += "-a";
      second.name += "-b";
    }
    return {first, second};
  }

 private:
  [[nodiscard]] ContactSurface surface_of(int link, bool caps) {
    const std::optional<BodyMesh>& mesh = bodies_.of_link.at(static_cast<std::size_t>(link)).mesh;
    if (!mesh) {
      return OwnShape{caps};
    }
    std::shared_ptr<const DistanceField>& field = fields_[link];
    if (!field) {
      field = cached_mesh_distance(mesh->surface, mesh->cells, mesh->file, stop_);
    }
    return field;
  }

  const BuiltBodies& bodies_;
  Plane ground_;
  const std::atomic<bool>* stop_;
  std::unordered_map<int, std::shared_ptr<const DistanceField>> fields_;  ///< by link
};

/// The beginning of messages about a contact.
std::string place_of(const Scene& scene, const Contact& contact) {
  const ReadContext context{scene.file, {}, {}};
  const int line = contact.line.number;
  const std::string_view element = contact_element(contact.kind);
  return contact.name ? attribute_place(context, line, element, "name", *contact.name)
                      : element_place(context, line, element);
}

}  // namespace

void add_contacts(const Scene& scene, const BuiltBodies& bodies, ModelBuilder& builder,
                  const std::atomic<bool>* stop) {
  ContactMaker maker(scene, bodies, stop);
  for (const Contact& contact : scene.description.contacts) {
    with_place(place_of(scene, contact), [&] {
      for (hbar::Contact& made : maker.make(contact)) {
        builder.add_contact(std::move(made));
      }
    });
  }
}

}  // namespace hbar::scene
