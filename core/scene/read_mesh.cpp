#include "hbar/core/scene/read_mesh.h"

#include <algorithm>
#include <cctype>

#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"
#include "hbar/core/files/text_file.h"
#include "hbar/core/scene/polygon_mesh.h"
#include "hbar/core/scene/read_assimp.h"
#include "hbar/core/scene/read_obj.h"
#include "hbar/core/scene/read_stl.h"

namespace hbar::scene {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  return text;
}

std::string listed(const std::vector<std::string>& extensions) {
  std::string text;
  for (const std::string& extension : extensions) {
    text += (text.empty() ? "" : ", ") + extension;
  }
  return text;
}

PolygonMesh read_polygons(const std::filesystem::path& path, const std::string& name) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") {
    return read_obj_text(read_text_file(path), name);
  }
  if (extension == ".stl") {
    return read_stl_bytes(read_text_file(path), name);
  }
  const std::vector<std::string> others = assimp_extensions();
  if (std::find(others.begin(), others.end(), extension) != others.end()) {
    return read_assimp_bytes(read_text_file(path), extension.substr(1), name);
  }
  throw InvalidInput(concat(name, ": a mesh of the kind \"", quotable(extension),
                            "\" is not read; this build reads ", listed(mesh_extensions())));
}

}  // namespace

std::vector<std::string> mesh_extensions() {
  std::vector<std::string> all = {".obj", ".stl"};
  const std::vector<std::string> others = assimp_extensions();
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

MendedMesh read_mesh(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return triangulated(read_polygons(path, name), name);
}

}  // namespace hbar::scene
