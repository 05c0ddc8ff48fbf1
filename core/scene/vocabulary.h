#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Every element and attribute of the scene format, once: the reader validates against this table,
/// the writer takes its spellings from it, and the reference in doc/scene_format.md is generated
/// from it.
namespace hbar::scene {

/// The type of an attribute's text.
enum class Kind { kText, kChoice, kFlag, kInteger, kNumber, kIgnored };

/// The condition on its numbers.
enum class Range {
  kAny,
  kPositive,     ///< each > 0
  kNonNegative,  ///< each ≥ 0
  kNonZero,      ///< not all 0
  kNoZero,       ///< none 0
  kOrdered,      ///< two, the first not above the second
  kAtLeastOne,   ///< each ≥ 1
  kCount,        ///< each 1 … kMaxCount
  kAtLeastTwo,   ///< each ≥ 2
  kGridCells,    ///< each 8 … 256
  kMask          ///< 0 … 63
};

/// The largest count that a file may give where nothing else limits it.
inline constexpr int kMaxCount = 1'000'000;

/// One attribute of one element.
struct AttributeInfo {
  std::string_view name;
  Kind kind = Kind::kNumber;
  int count = 1;                   ///< numbers in it; 0: one per joint coordinate
  int other_count = 0;             ///< alternative count; 0: none
  const char* fallback = nullptr;  ///< the default, as a file would write it; null: none
  bool required = false;
  Range range = Range::kAny;
  std::string_view unit = {};      ///< in words, empty where there is none
  std::string_view choices = {};   ///< of a kChoice, separated by '|'
  std::string_view types = {};     ///< values of the element's `type` it belongs to; empty: all
  std::string_view sentence = {};  ///< what it is, for the reference
  bool extension = false;          ///< unknown to other readers of this dialect
};

/// One element.
struct ElementInfo {
  std::string_view name;
  std::string_view parents;  ///< elements that may contain it, separated by '|'; empty: the root
  bool single = false;       ///< at most one in each parent
  std::string_view sentence = {};
  std::span<const AttributeInfo> attributes = {};
  bool extension = false;  ///< unknown to other readers of this dialect
};

/// All elements, the root first.
[[nodiscard]] std::span<const ElementInfo> vocabulary();

/// The element of a name, or null.
[[nodiscard]] const ElementInfo* find_element(std::string_view name);

/// The attribute of an element that applies where the element's `type` is `type` (any, if empty),
/// or null.
[[nodiscard]] const AttributeInfo* find_attribute(const ElementInfo& element, std::string_view name,
                                                  std::string_view type);

/// Whether `name` is one of the alternatives in a text separated by `separator`.
[[nodiscard]] bool is_listed(std::string_view alternatives, char separator, std::string_view name);

/// The parts of a text separated by `separator`.
[[nodiscard]] std::vector<std::string> listed(std::string_view alternatives, char separator);

/// Names of the elements that a parent, `<default>` included, may contain.
[[nodiscard]] std::vector<std::string> children_of(std::string_view parent);

/// Names of an element's attributes, each once.
[[nodiscard]] std::vector<std::string> attribute_names(const ElementInfo& element);

/// What an attribute takes, for the end of messages: "size takes 3 numbers > 0".
[[nodiscard]] std::string what_it_takes(const AttributeInfo& attribute);

/// The spelling of choice `index` of an attribute.
///
/// @throws InvalidInput if there is no such element, attribute or choice
[[nodiscard]] std::string choice_name(std::string_view element, std::string_view attribute,
                                      std::size_t index);

/// The reference tables of doc/scene_format.md, as Markdown.
[[nodiscard]] std::string vocabulary_markdown();

}  // namespace hbar::scene
