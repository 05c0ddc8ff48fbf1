#include "option_values.h"

#include <fmt/format.h>

#include <algorithm>

#include "entries.h"
#include "examples/common/process.h"
#include "hbar/adjoint/trajectory/integrator.h"
#include "hbar/core/base/nearest_name.h"
#include "hbar/core/files/numbers.h"

namespace hbar::tool {

using example::ExitCode;
using example::ProgramError;
namespace {

int read_count(const std::string& name, const std::string& text, int most) {
  std::string reason;
  const std::optional<int> number = scene::parse_integer(text, reason);
  if (!number) {
    usage(fmt::format("{}: {}", name, reason));
  }
  if (*number < 1) {
    usage(fmt::format("{}: {} is not at least 1", name, text));
  }
  if (*number > most) {
    usage(fmt::format("{}: {} is above {}, the largest that is allowed", name, text, most));
  }
  return *number;
}

}  // namespace

void usage(const std::string& message) { throw ProgramError(ExitCode::kUsage, message); }

std::optional<std::string> value_of(const Given& given, const std::string& name) {
  const auto place = given.find(name);
  return place == given.end() ? std::nullopt : std::optional(place->second);
}

std::optional<double> positive_number(const Given& given, const std::string& name) {
  const std::optional<std::string> text = value_of(given, name);
  if (!text) {
    return std::nullopt;
  }
  std::string reason;
  const std::optional<double> number = scene::parse_number(*text, reason);
  if (!number) {
    usage(fmt::format("{}: {}", name, reason));
  }
  if (!(*number > 0.0)) {
    usage(fmt::format("{}: {} is not positive", name, *text));
  }
  return number;
}

std::optional<int> count(const Given& given, const std::string& name, int most) {
  const std::optional<std::string> text = value_of(given, name);
  return text ? std::optional(read_count(name, *text, most)) : std::nullopt;
}

std::optional<std::vector<int>> counts(const Given& given, const std::string& name, int most) {
  const std::optional<std::vector<std::string>> list = words(given, name);
  if (!list) {
    return std::nullopt;
  }
  std::vector<int> out;
  for (const std::string& word : *list) {
    out.push_back(read_count(name, word, most));
  }
  return out;
}

std::optional<std::vector<double>> numbers(const Given& given, const std::string& name) {
  const std::optional<std::string> text = value_of(given, name);
  if (!text) {
    return std::nullopt;
  }
  std::string reason;
  std::vector<double> list = parse_numbers(*text, reason);
  if (!reason.empty()) {
    usage(fmt::format("{}: {}", name, reason));
  }
  return list;
}

std::optional<std::vector<std::string>> words(const Given& given, const std::string& name) {
  const std::optional<std::string> text = value_of(given, name);
  if (!text) {
    return std::nullopt;
  }
  std::string reason;
  const std::vector<std::string_view> entries = split_entries(*text, reason);
  if (entries.empty()) {
    usage(fmt::format("{}: {}", name, reason.empty() ? "it is empty" : reason));
  }
  return std::vector<std::string>(entries.begin(), entries.end());
}

std::optional<std::string> file(const Given& given, const std::string& name) {
  std::optional<std::string> text = value_of(given, name);
  if (text && text->empty()) {
    usage(fmt::format("{}: the file has no name", name));
  }
  return text;
}

void check_name(const std::string& option, const std::string& text,
                const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), text) == names.end()) {
    usage(fmt::format("{}: there is no \"{}\"; {}", option, scene::quotable(text),
                      unknown_name_hint(text, names)));
  }
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const Integrator& row : integrators()) {
    names.push_back(row.name);
  }
  return names;
}

}  // namespace hbar::tool
