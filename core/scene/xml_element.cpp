#include "hbar/core/scene/xml_element.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hbar/core/base/nearest_name.h"
#include "hbar/core/files/numbers.h"

namespace hbar::scene {
namespace {

/// Squared length of a quaternion that counts as one already, so that reading is idempotent.
constexpr double kUnitSlack = 8.0 * std::numeric_limits<double>::epsilon();

/// Throws unless an element is allowed in its parent.
void check_placement(const tinyxml2::XMLElement& xml, std::string_view parent,
                     const ReadContext& context) {
  const std::string place = element_place(context, xml.GetLineNum(), xml.Name());
  const ElementInfo* const element = find_element(xml.Name());
  const std::vector<std::string> allowed = children_of(parent);
  if (element == nullptr) {
    const std::string hint = allowed.empty() ? concat("<", parent, "> has no elements in it")
                                             : unknown_name_hint(xml.Name(), allowed);
    throw InvalidInput(place + concat("unknown element in <", parent, ">; ") + hint);
  }
  if (!is_listed(element->parents, '|', parent)) {
    std::string where;
    for (const std::string& one : listed(element->parents, '|')) {
      where += (where.empty() ? "<" : " or <") + one + ">";
    }
    throw InvalidInput(place + concat("cannot stand in <", parent, ">; it belongs in ",
                                      where.empty() ? "no other element" : where));
  }
}

}  // namespace

void ReadContext::notice(int line, std::string_view text) {
  if (!noticed.emplace(text).second) {
    return;
  }
  notices.push_back(concat(file, ":", line, ": ", text));
}

std::string element_place(const ReadContext& context, int line, std::string_view element) {
  return concat(context.file, ":", line, ": <", quotable(element), ">: ");
}

std::string attribute_place(const ReadContext& context, int line, std::string_view element,
                            std::string_view attribute, std::string_view text) {
  return concat(context.file, ":", line, ": <", element, " ", quotable(attribute), "=\"",
                quotable(text), "\">: ");
}

XmlElement::XmlElement(const tinyxml2::XMLElement& xml, ReadContext& context)
    : xml_(&xml), context_(&context), info_(find_element(xml.Name())), line_(xml.GetLineNum()) {
  if (info_ == nullptr) {
    throw InvalidInput(element_place(context, line_, xml.Name()) + "unknown element");
  }
  check_attribute_names();
  if (children_of(name()).empty()) {
    static_cast<void>(checked_children(xml, context));
  }
}

void XmlElement::check_attribute_names() const {
  for (const tinyxml2::XMLAttribute* a = xml_->FirstAttribute(); a != nullptr; a = a->Next()) {
    const AttributeInfo* const known = find_attribute(*info_, a->Name(), "");
    if (known != nullptr) {
      if (known->kind == Kind::kIgnored) {
        context_->notice(line_, concat("<", name(), ">: ", a->Name(), " has no effect"));
      }
      continue;
    }
    const std::vector<std::string> names = attribute_names(*info_);
    const std::string hint = names.empty() ? concat("<", name(), "> takes no attributes")
                                           : unknown_name_hint(a->Name(), names);
    throw InvalidInput(attribute_place(*context_, a->GetLineNum(), name(), a->Name(), a->Value()) +
                       "unknown attribute; " + hint);
  }
}

std::size_t XmlElement::read_type(std::string_view attribute) {
  const std::size_t index = choice(attribute);
  type_ = listed(row(attribute).choices, '|')[index];
  for (const tinyxml2::XMLAttribute* a = xml_->FirstAttribute(); a != nullptr; a = a->Next()) {
    if (!applies(a->Name())) {
      context_->notice(line_, concat("<", name(), " ", attribute, "=\"", type_, "\">: ", a->Name(),
                                     " has no effect on this ", attribute));
    }
  }
  return index;
}

bool XmlElement::applies(std::string_view attribute) const {
  return find_attribute(*info_, attribute, type_) != nullptr;
}

const AttributeInfo& XmlElement::row(std::string_view attribute) const {
  const AttributeInfo* const found_row = find_attribute(*info_, attribute, type_);
  if (found_row == nullptr) {
    throw InvalidInput(concat("vocabulary: <", name(), "> has no attribute ", attribute));
  }
  return *found_row;
}

bool XmlElement::states(std::string_view attribute) const {
  return xml_->FindAttribute(std::string(attribute).c_str()) != nullptr;
}

bool XmlElement::has(std::string_view attribute) const {
  if (states(attribute)) {
    return true;
  }
  const auto defaults = context_->defaults.find(name());
  return defaults != context_->defaults.end() &&
         defaults->second.find(attribute) != defaults->second.end();
}

AttributeText XmlElement::found(std::string_view attribute) const {
  if (const auto* a = xml_->FindAttribute(std::string(attribute).c_str())) {
    return {a->Value(), a->GetLineNum(), false};
  }
  const auto defaults = context_->defaults.find(name());
  if (defaults != context_->defaults.end()) {
    const auto value = defaults->second.find(attribute);
    if (value != defaults->second.end()) {
      return value->second;
    }
  }
  const AttributeInfo& info = row(attribute);
  if (info.fallback == nullptr) {
    throw InvalidInput(element_place(*context_, line_, name()) + "attribute " +
                       std::string(attribute) + " is missing; " + what_it_takes(info));
  }
  return {info.fallback, line_, false};
}

void XmlElement::fail(std::string_view attribute, const std::string& reason,
                      const std::string& hint) const {
  const AttributeText value = found(attribute);
  throw InvalidInput(attribute_place(*context_, value.line, name(), attribute, value.text) +
                     reason + "; " + (hint.empty() ? what_it_takes(row(attribute)) : hint));
}

void XmlElement::fail(const std::string& reason) const {
  throw InvalidInput(element_place(*context_, line_, name()) + reason);
}

std::string XmlElement::text(std::string_view attribute) const {
  const AttributeText value = found(attribute);
  const bool may_be_empty = row(attribute).fallback != nullptr;
  if (value.text.empty() && !may_be_empty) {
    fail(attribute, "the text is empty");
  }
  return value.text;
}

std::optional<std::string> XmlElement::optional_text(std::string_view attribute) const {
  if (!applies(attribute) || !has(attribute)) {
    return std::nullopt;
  }
  return text(attribute);
}

bool XmlElement::flag(std::string_view attribute) const {
  const std::string value = found(attribute).text;
  if (value == "true" || value == "1") {
    return true;
  }
  if (value == "false" || value == "0") {
    return false;
  }
  fail(attribute, concat("\"", quotable(value), "\" is neither"));
}

std::optional<bool> XmlElement::optional_flag(std::string_view attribute) const {
  if (!has(attribute)) {
    return std::nullopt;
  }
  return flag(attribute);
}

std::size_t XmlElement::choice(std::string_view attribute) const {
  const std::string value = found(attribute).text;
  const std::vector<std::string> names = listed(row(attribute).choices, '|');
  const auto match = std::find(names.begin(), names.end(), value);
  if (match == names.end()) {
    fail(attribute, concat("unknown ", attribute));
  }
  return static_cast<std::size_t>(match - names.begin());
}

std::vector<double> XmlElement::list(std::string_view attribute, std::size_t count) const {
  const AttributeText value = found(attribute);
  const AttributeInfo& info = row(attribute);
  std::vector<double> values;
  for (const std::string_view word : split_words(value.text)) {
    std::string reason;
    const std::optional<double> parsed = parse_number(word, reason);
    if (!parsed) {
      fail(attribute, reason);
    }
    values.push_back(*parsed);
  }
  const auto first = count > 0 ? count : static_cast<std::size_t>(info.count);
  const auto second = static_cast<std::size_t>(info.other_count);
  if (values.size() != first && (second == 0 || values.size() != second)) {
    fail(attribute, concat("found ", values.size(), values.size() == 1 ? " number" : " numbers"));
  }
  check_range(attribute, values);
  return values;
}

std::vector<int> XmlElement::whole_list(std::string_view attribute) const {
  const AttributeText value = found(attribute);
  std::vector<int> values;
  for (const std::string_view word : split_words(value.text)) {
    std::string reason;
    const std::optional<int> parsed = parse_integer(word, reason);
    if (!parsed) {
      fail(attribute, reason);
    }
    values.push_back(*parsed);
  }
  if (values.size() != static_cast<std::size_t>(row(attribute).count)) {
    fail(attribute, concat("found ", values.size(), values.size() == 1 ? " number" : " numbers"));
  }
  check_range(attribute, std::vector<double>(values.begin(), values.end()));
  return values;
}

void XmlElement::check_range(std::string_view attribute, const std::vector<double>& values) const {
  const auto all = [&](auto&& holds) { return std::all_of(values.begin(), values.end(), holds); };
  bool ok = true;
  std::string reason = "out of range";
  switch (row(attribute).range) {
    case Range::kAny:
      break;
    case Range::kPositive:
      ok = all([](double v) { return v > 0.0; });
      break;
    case Range::kNonNegative:
      ok = all([](double v) { return v >= 0.0; });
      break;
    case Range::kNonZero:
      ok = !all([](double v) { return v == 0.0; });
      reason = "all numbers are 0";
      break;
    case Range::kNoZero:
      ok = all([](double v) { return v != 0.0; });
      break;
    case Range::kOrdered:
      ok = values.size() == 2 && values[0] <= values[1];
      reason = "the lower number is above the upper one";
      break;
    case Range::kAtLeastOne:
      ok = all([](double v) { return v >= 1.0; });
      break;
    case Range::kCount:
      ok = all([](double v) { return v >= 1.0 && v <= kMaxCount; });
      break;
    case Range::kAtLeastTwo:
      ok = all([](double v) { return v >= 2.0; });
      break;
    case Range::kGridCells:
      ok = all([](double v) { return v >= 8.0 && v <= 256.0; });
      break;
    case Range::kMask:
      ok = all([](double v) { return v >= 0.0 && v <= 63.0; });
      break;
  }
  if (!ok) {
    fail(attribute, reason);
  }
}

void XmlElement::check_value(std::string_view attribute) const {
  const AttributeInfo& info = row(attribute);
  switch (info.kind) {
    case Kind::kText:
      static_cast<void>(text(attribute));
      break;
    case Kind::kChoice:
      static_cast<void>(choice(attribute));
      break;
    case Kind::kFlag:
      static_cast<void>(flag(attribute));
      break;
    case Kind::kInteger:
      static_cast<void>(whole_list(attribute));
      break;
    case Kind::kNumber:
      static_cast<void>(
          list(attribute, info.count > 0 ? 0 : split_words(found(attribute).text).size()));
      break;
    case Kind::kIgnored:
      break;
  }
}

void XmlElement::check_any_type(std::string_view attribute) const {
  std::optional<InvalidInput> problem;
  for (const AttributeInfo& info : info_->attributes) {
    if (info.name != attribute) {
      continue;
    }
    XmlElement typed = *this;
    typed.type_ = std::string(info.types.substr(0, info.types.find(' ')));
    try {
      typed.check_value(attribute);
      return;
    } catch (const InvalidInput& error) {
      if (!problem) {
        problem = error;
      }
    }
  }
  if (problem) {
    throw InvalidInput(*problem);
  }
}

int XmlElement::integer(std::string_view attribute) const { return integers<1>(attribute)[0]; }

double XmlElement::number(std::string_view attribute) const { return numbers<1>(attribute)[0]; }

std::optional<double> XmlElement::optional_number(std::string_view attribute) const {
  if (!applies(attribute) || !has(attribute)) {
    return std::nullopt;
  }
  return number(attribute);
}

std::array<double, 4> XmlElement::quaternion(std::string_view attribute) const {
  std::array<double, 4> q = numbers<4>(attribute);
  const auto squared_length = [](const std::array<double, 4>& v) {
    return v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
  };
  if (std::abs(squared_length(q) - 1.0) <= kUnitSlack) {
    return q;
  }
  double largest = 0.0;
  for (const double v : q) {
    largest = std::max(largest, std::abs(v));
  }
  for (double& v : q) {
    v /= largest;  // neither overflows nor vanishes when squared
  }
  const double length = std::sqrt(squared_length(q));
  for (double& v : q) {
    v /= length;
  }
  return q;
}

std::vector<const tinyxml2::XMLElement*> checked_children(const tinyxml2::XMLElement& parent,
                                                          ReadContext& context) {
  const std::string_view name = parent.Name();
  std::vector<const tinyxml2::XMLElement*> children;
  std::map<std::string, int, std::less<>> first_lines;
  for (const tinyxml2::XMLNode* node = parent.FirstChild(); node; node = node->NextSibling()) {
    if (node->ToText() != nullptr) {
      std::string text;
      for (const std::string_view word : split_words(node->Value())) {
        text += (text.empty() ? "" : " ") + std::string(word);
      }
      context.notice(node->GetLineNum(),
                     concat("<", name, ">: the text \"", quotable(text), "\" has no effect"));
    }
    const tinyxml2::XMLElement* const child = node->ToElement();
    if (child == nullptr) {
      continue;
    }
    check_placement(*child, name, context);
    const auto [first, is_new] = first_lines.emplace(child->Name(), child->GetLineNum());
    if (!is_new && find_element(child->Name())->single && name != "default") {
      throw InvalidInput(element_place(context, child->GetLineNum(), child->Name()) +
                         concat("a second one in this <", name, ">, the first is in line ",
                                first->second, "; at most one is allowed"));
    }
    children.push_back(child);
  }
  return children;
}

}  // namespace hbar::scene
