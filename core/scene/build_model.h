#pragma once

#include "hbar/core/model/model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::scene {

/// The model of a scene that has been read: joints, bodies with their mass properties and contact
/// points, motors, contacts, end effectors and tactile sensors. Opens the files the scene names:
/// OBJ files, contact points, sensor points. The distance of a mesh that others touch is kept
/// beside its OBJ file for the next time.
///
/// Robots follow each other in file order, and so do the links of each; motors, hence controls, end
/// effectors, hence variables, contacts and sensors as the file lists them.
///
/// @throws IoError       if a file cannot be read
/// @throws InvalidInput  if a file holds something else than it should, a mesh does not bound a
///                       solid, or the description was not made by a reader and the model refuses
///                       it; messages begin `file:line: <element ...>:`
[[nodiscard]] Model build_model(const Scene& scene);

}  // namespace hbar::scene
