#pragma once

#include <atomic>

#include "hbar/core/model/model_builder.h"
#include "hbar/core/scene/build_bodies.h"

namespace hbar::scene {

/// Adds a scene's contacts, in file order, to a model that has its links. A contact of two cuboids
/// becomes two contacts, the first cuboid's points first, named NAME-a and NAME-b if the scene
/// names it. Builds the distance of each mesh that points are tested against, once.
///
/// @param scene    the scene as read
/// @param bodies   of the model's links
/// @param builder  holds the links; takes the contacts
/// @param stop     ends the computation of a mesh's distance when it is set; may be null
/// @throws InvalidInput  if the model refuses a contact (a file of contact points was empty, names
///                       of contacts are equal) or a mesh has no distance; messages begin
///                       `file:line: <element ...>:`
/// @throws Interrupted   if `stop` is set on the way
void add_contacts(const Scene& scene, const BuiltBodies& bodies, ModelBuilder& builder,
                  const std::atomic<bool>* stop = nullptr);

}  // namespace hbar::scene
