#pragma once

#include "hbar/core/model/model_builder.h"
#include "hbar/core/scene/build_bodies.h"

namespace hbar::scene {

/// Adds a scene's tactile sensors, in file order, to a model that has its links. Points of a
/// rectangle run along axis1 first; a resolution of 1 puts them in the middle. Opens the files that
/// list points.
///
/// @param scene    the scene as read
/// @param bodies   of the model's links
/// @param builder  holds the links; takes the sensors
/// @throws IoError       if a file cannot be read
/// @throws InvalidInput  if a file has other content or no point; messages begin `file:line:
///                       <tactile ...>:`
void add_tactile_sensors(const Scene& scene, const BuiltBodies& bodies, ModelBuilder& builder);

}  // namespace hbar::scene
