#pragma once

#include "hbar/core/model/model_builder.h"

namespace hbar::testing {

/// A base with an arm and a leg of one hinge each, and a stone that is free in x, y, z.
[[nodiscard]] inline Model two_limbs() {
  ModelBuilder builder("limbs");
  const auto add = [&](int parent, const std::string& name, const JointKind& kind) {
    Body body = solid_body(name, Cuboid{}, 1.0);
    body.contact_points = Eigen::Matrix3Xd::Zero(3, 1);
    return builder.add_link(parent, {.name = name, .kind = kind}, body);
  };
  const int base = add(-1, "base", RevoluteJoint{});
  const int arm = add(base, "arm", RevoluteJoint{});
  add(base, "leg", RevoluteJoint{});
  const int stone = add(-1, "stone", TranslationalJoint{});
  builder.add_contact({.link = arm, .other = stone});
  builder.add_contact({.link = stone, .surface = Plane{}});
  return builder.build();
}

}  // namespace hbar::testing
