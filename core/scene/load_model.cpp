#include "hbar/core/scene/load_model.h"

#include <utility>

#include "hbar/core/scene/build_model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::scene {

LoadedModel load_model(const std::filesystem::path& path, const std::atomic<bool>* stop) {
  Scene scene = read_scene(path);
  std::vector<std::string> notices = std::move(scene.notices);
  Model model = build_model(scene, &notices, stop);
  return {std::move(model), std::move(notices)};
}

}  // namespace hbar::scene
