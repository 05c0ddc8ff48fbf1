#include "hbar/core/scene/vocabulary.h"

#include <algorithm>

#include "hbar/core/base/error.h"

namespace hbar::scene {
namespace {

std::string range_text(Range range) {
  switch (range) {
    case Range::kAny:
      return "";
    case Range::kPositive:
      return " > 0";
    case Range::kNonNegative:
      return " >= 0";
    case Range::kNonZero:
      return ", not all 0";
    case Range::kNoZero:
      return ", none 0";
    case Range::kOrdered:
      return ", lower <= upper";
    case Range::kAtLeastOne:
      return " >= 1";
    case Range::kCount:
      return concat(" from 1 to ", kMaxCount);
    case Range::kAtLeastTwo:
      return " >= 2";
    case Range::kGridCells:
      return " from 8 to 256";
    case Range::kMask:
      return " from 0 to 63";
  }
  return "";
}

std::string joined(const std::vector<std::string>& parts, const char* separator) {
  std::string out;
  for (const std::string& part : parts) {
    out += (out.empty() ? "" : separator) + part;
  }
  return out;
}

/// "3 numbers > 0", without the attribute's name.
std::string value_text(const AttributeInfo& attribute) {
  const bool whole = attribute.kind == Kind::kInteger;
  const std::string one = whole ? "whole number" : "number";
  switch (attribute.kind) {
    case Kind::kText:
      return "a text that is not empty";
    case Kind::kFlag:
      return "true or false";
    case Kind::kIgnored:
      return "anything";
    case Kind::kChoice:
      return "one of " + joined(listed(attribute.choices, '|'), ", ");
    case Kind::kInteger:
    case Kind::kNumber:
      break;
  }
  std::string text;
  if (attribute.count == 0) {
    text = "one number per joint coordinate";
  } else if (attribute.count == 1) {
    text = "1 " + one;
  } else if (attribute.other_count == 0) {
    text = concat(attribute.count, " ", one, "s");
  } else {
    text = concat(attribute.count, " or ", attribute.other_count, " ", one, "s");
  }
  return text + range_text(attribute.range);
}

std::string default_text(const AttributeInfo& attribute) {
  if (attribute.required) {
    return "required";
  }
  if (attribute.fallback == nullptr || *attribute.fallback == '\0') {
    return "none";
  }
  return concat("`", attribute.fallback, "`");
}

std::string attribute_row(const AttributeInfo& attribute) {
  std::string values = value_text(attribute);
  if (attribute.kind == Kind::kChoice) {
    values = "`" + joined(listed(attribute.choices, '|'), "` `") + "`";
  }
  std::string row = concat("| `", attribute.name, "`", attribute.extension ? " (+)" : "", " | ");
  row += values + " | " + std::string(attribute.unit.empty() ? "-" : attribute.unit) + " | ";
  row += default_text(attribute) + " | ";
  if (!attribute.types.empty()) {
    row += "(" + joined(listed(attribute.types, ' '), ", ") + ") ";
  }
  return row + std::string(attribute.sentence) + " |\n";
}

std::string placement(const ElementInfo& element) {
  if (element.parents.empty()) {
    return "The root of the file.";
  }
  std::string text = "In `<" + joined(listed(element.parents, '|'), ">`, `<") + ">`";
  return text + (element.single ? ", at most once." : ", any number of times.");
}

}  // namespace

std::vector<std::string> listed(std::string_view alternatives, char separator) {
  std::vector<std::string> parts;
  while (!alternatives.empty()) {
    const std::size_t end = std::min(alternatives.find(separator), alternatives.size());
    parts.emplace_back(alternatives.substr(0, end));
    alternatives.remove_prefix(std::min(end + 1, alternatives.size()));
  }
  return parts;
}

bool is_listed(std::string_view alternatives, char separator, std::string_view name) {
  const std::vector<std::string> parts = listed(alternatives, separator);
  return std::find(parts.begin(), parts.end(), name) != parts.end();
}

const ElementInfo* find_element(std::string_view name) {
  for (const ElementInfo& element : vocabulary()) {
    if (element.name == name) {
      return &element;
    }
  }
  return nullptr;
}

const AttributeInfo* find_attribute(const ElementInfo& element, std::string_view name,
                                    std::string_view type) {
  for (const AttributeInfo& attribute : element.attributes) {
    if (attribute.name != name) {
      continue;
    }
    if (type.empty() || attribute.types.empty() || is_listed(attribute.types, ' ', type)) {
      return &attribute;
    }
  }
  return nullptr;
}

std::vector<std::string> children_of(std::string_view parent) {
  std::vector<std::string> names;
  for (const ElementInfo& element : vocabulary()) {
    if (is_listed(element.parents, '|', parent)) {
      names.emplace_back(element.name);
    }
  }
  return names;
}

std::vector<std::string> attribute_names(const ElementInfo& element) {
  std::vector<std::string> names;
  for (const AttributeInfo& attribute : element.attributes) {
    if (std::find(names.begin(), names.end(), attribute.name) == names.end()) {
      names.emplace_back(attribute.name);
    }
  }
  return names;
}

std::string what_it_takes(const AttributeInfo& attribute) {
  return concat(attribute.name, " takes ", value_text(attribute));
}

std::string choice_name(std::string_view element, std::string_view attribute, std::size_t index) {
  const ElementInfo* const info = find_element(element);
  const AttributeInfo* const row = info ? find_attribute(*info, attribute, "") : nullptr;
  const std::vector<std::string> names =
      row ? listed(row->choices, '|') : std::vector<std::string>();
  if (index >= names.size()) {
    throw InvalidInput(concat("choice_name: <", element, " ", attribute, "> has no choice ", index,
                              "; it has ", names.size()));
  }
  return names[index];
}

std::string vocabulary_markdown() {
  std::string out;
  for (const ElementInfo& element : vocabulary()) {
    out += concat("### `<", element.name, ">`", element.extension ? " (+)" : "", "\n\n");
    out += concat(element.sentence, " ", placement(element), "\n\n");
    if (element.attributes.empty()) {
      continue;
    }
    out += "| attribute | takes | unit | default | meaning |\n";
    out += "| --- | --- | --- | --- | --- |\n";
    for (const AttributeInfo& attribute : element.attributes) {
      out += attribute_row(attribute);
    }
    out += "\n";
  }
  return out;
}

}  // namespace hbar::scene
