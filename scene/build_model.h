#pragma once

#include "hbar/core/model.h"
#include "hbar/scene/read_xml.h"

namespace hbar::scene {

/// The model of a scene that has been read: joints, bodies with their mass properties, motors and
/// end effectors. Opens the OBJ files of mesh bodies. What is not simulated yet is left out.
///
/// Robots follow each other in file order, and so do the links of each; motors, hence controls, and
/// end effectors, hence variables, as the file lists them.
///
/// @throws IoError       if an OBJ file cannot be read
/// @throws InvalidInput  if a mesh does not bound a solid, or the description was not made by a
///                       reader and the model refuses it; messages begin `file:line: <element
///                       ...>:`
[[nodiscard]] Model build_model(const Scene& scene);

}  // namespace hbar::scene
