#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/scene/description.h"

namespace hbar::scene {

/// A scene file that has been read.
struct Scene {
  Description description;           ///< what it says, defaults applied
  std::vector<std::string> notices;  ///< what the user should know, each `file:line: ...`
  std::string file;                  ///< its name, as messages spell it
  std::filesystem::path folder;      ///< where the files it names are looked for
  /// Where they are looked for next: beside what a symbolic link to the scene leads to.
  std::filesystem::path target_folder = {};

  /// A file that the scene names.
  [[nodiscard]] std::filesystem::path find(const std::string& name) const;
};

/// Reads a scene file in the format of doc/scene_format.md. Files it names are not opened.
///
/// @throws IoError       if the file cannot be read
/// @throws InvalidInput  for everything the format does not allow; the message begins
///                       `file:line: <element attribute="found">:` and ends with what is allowed
[[nodiscard]] Scene read_scene(const std::filesystem::path& path);

/// The same from the text of a file.
///
/// @param text    the content of the file
/// @param name    the file's name in messages
/// @param folder  where the files it names are looked for
[[nodiscard]] Scene read_scene_text(std::string_view text, const std::string& name,
                                    const std::filesystem::path& folder = ".");

}  // namespace hbar::scene
