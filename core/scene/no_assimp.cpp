// In a build without Assimp.
#include "hbar/core/base/error.h"
#include "hbar/core/scene/read_assimp.h"

namespace hbar::scene {

std::vector<std::string> assimp_extensions() { return {}; }

PolygonMesh read_assimp_bytes(std::string_view /*bytes*/, const std::string& /*extension*/,
                              const std::string& name) {
  throw InvalidInput(concat(name, ": this build does not read it; it has no Assimp"));
}

}  // namespace hbar::scene
