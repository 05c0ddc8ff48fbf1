#include "hbar/core/files/result_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "hbar/core/base/error.h"
#include "hbar/core/files/atomic_file.h"

namespace hbar::scene {
namespace {

namespace fs = std::filesystem;

/// The name with its folder resolved; the file itself need not be there.
fs::path resolved(const fs::path& path) {
  std::error_code code;
  const fs::path whole = fs::canonical(path, code);
  if (!code) {
    return whole;
  }
  const fs::path folder = fs::canonical(path.has_parent_path() ? path.parent_path() : ".", code);
  return code ? path.lexically_normal() : folder / path.filename();
}

[[noreturn]] void refuse(const fs::path& path, std::string_view reason) {
  throw IoError(concat(path.string(), ": cannot be written: ", reason));
}

/// A name in the folder that nothing has yet.
fs::path unused_name(const fs::path& folder, const fs::path& result) {
  fs::path name = folder / result.filename();
  name += ".rescued";
  std::error_code code;
  fs::path candidate = name;
  for (int i = 2; fs::exists(candidate, code); ++i) {
    candidate = name;
    candidate += concat('.', i);
  }
  return candidate;
}

/// Where the text was saved, or nothing.
fs::path rescue(const fs::path& result, std::string_view text) {
  const char* elsewhere = std::getenv("TMPDIR");
  for (const fs::path& folder :
       {fs::path("."), fs::path(elsewhere != nullptr && *elsewhere != '\0' ? elsewhere : "/tmp")}) {
    const fs::path path = unused_name(folder, result);
    try {
      write_file_atomically(path, text);
      return path;
    } catch (const IoError&) {  // the next folder may do
    }
  }
  return {};
}

}  // namespace

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code code;
  return fs::equivalent(a, b, code) || resolved(a) == resolved(b);
}

void expect_result_file(const fs::path& path, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    if (is_same_file(path, input)) {
      throw IoError(concat(path.string(),
                           ": is an input of this run and stays as it is; name another file for "
                           "the results"));
    }
  }
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (fs::is_directory(status)) {
    refuse(path, "Is a directory");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    if (::access(path.c_str(), W_OK) != 0) {
      refuse(path, std::generic_category().message(errno));
    }
    return;
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!fs::is_directory(folder, code)) {
    refuse(path, concat("there is no folder ", folder.string()));
  }
  const fs::path place = resolved(path).parent_path();
  remove_abandoned_files(place);
  if (const int code_of_folder = try_folder(place)) {
    refuse(path, std::generic_category().message(code_of_folder));
  }
}

void write_result_file(const fs::path& path, std::string_view text) {
  try {
    write_file_atomically(path, text);
  } catch (const IoError& error) {
    const fs::path saved = rescue(path, text);
    if (saved.empty()) {
      throw;
    }
    throw IoError(concat(error.what(), "; saved as ", saved.string(), " instead"));
  }
}

}  // namespace hbar::scene
