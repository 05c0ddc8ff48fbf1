#pragma once

#include <atomic>

#include "hbar/core/model/model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::scene {

/// The model of a scene that has been read: joints, bodies with their mass properties and contact
/// points, motors, contacts, end effectors and tactile sensors. Opens the files the scene names:
/// meshes, contact points, sensor points. The distance grid of a mesh that others touch is
/// cached beside its file.
///
/// Robots and the links of each are in file order, and so are motors (hence controls), end
/// effectors (hence variables), contacts and sensors.
///
/// @param notices  if it is there, gets what the user should know about those files
/// @param stop     ends the work, most of which is distance grids, when it is set; may be null
/// @throws IoError       if a file cannot be read
/// @throws InvalidInput  if a file has the wrong content, a mesh does not bound a solid, or the
///                       model refuses a description that no reader made; messages begin
///                       `file:line: <element ...>:`
/// @throws Interrupted   if `stop` is set on the way
[[nodiscard]] Model build_model(const Scene& scene, std::vector<std::string>* notices = nullptr,
                                const std::atomic<bool>* stop = nullptr);

}  // namespace hbar::scene
