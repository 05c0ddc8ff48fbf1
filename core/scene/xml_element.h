#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/scene/vocabulary.h"

namespace tinyxml2 {
class XMLElement;
}

namespace hbar::scene {

/// The text of an attribute and where it stands.
struct AttributeText {
  std::string text;
  int line = 0;
  bool from_default = false;  ///< from a `<default>` block, not from the element itself
};

/// The context of reading one file.
struct ReadContext {
  std::string file;                  ///< as messages name it
  std::vector<std::string> notices;  ///< what the user should know, in file order
  /// Attributes of `<default>` blocks, by element and attribute.
  std::map<std::string, std::map<std::string, AttributeText, std::less<>>, std::less<>> defaults;

  std::set<std::string, std::less<>> noticed = {};  ///< their texts, without location

  /// Adds `file:line: text` to the notices, unless the same text is already there for another line.
  void notice(int line, std::string_view text);
};

/// One element of a file, read by the vocabulary: every reading function finds the attribute's row,
/// takes the text from the element, from a `<default>` block or from the row's own default, checks
/// it and throws an InvalidInput that begins `file:line: <element attribute="text">:` if it
/// violates the row.
class XmlElement {
 public:
  /// @param xml      the element; must outlive this
  /// @param context  of the file; must outlive this
  /// @throws InvalidInput for attributes the vocabulary does not know
  XmlElement(const tinyxml2::XMLElement& xml, ReadContext& context);

  [[nodiscard]] std::string_view name() const { return info_->name; }
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] const tinyxml2::XMLElement& xml() const { return *xml_; }
  [[nodiscard]] ReadContext& context() const { return *context_; }

  /// Reads the choice that decides which attributes apply; attributes of the element itself that do
  /// not apply are reported in a notice and ignored.
  std::size_t read_type(std::string_view attribute);

  /// Whether the element or a default block gives the attribute.
  [[nodiscard]] bool has(std::string_view attribute) const;
  /// Whether an attribute's value comes from a `<default>` block.
  [[nodiscard]] bool is_by_default(std::string_view attribute) const {
    return found(attribute).from_default;
  }
  /// Whether the element itself gives the attribute.
  [[nodiscard]] bool states(std::string_view attribute) const;

  [[nodiscard]] std::string text(std::string_view attribute) const;
  [[nodiscard]] std::optional<std::string> optional_text(std::string_view attribute) const;
  [[nodiscard]] bool flag(std::string_view attribute) const;
  [[nodiscard]] std::optional<bool> optional_flag(std::string_view attribute) const;
  /// Index among the choices of the attribute's row.
  [[nodiscard]] std::size_t choice(std::string_view attribute) const;
  [[nodiscard]] int integer(std::string_view attribute) const;
  [[nodiscard]] double number(std::string_view attribute) const;
  [[nodiscard]] std::optional<double> optional_number(std::string_view attribute) const;
  /// Numbers: `count` of them, or the row's own count if that is 0.
  [[nodiscard]] std::vector<double> list(std::string_view attribute, std::size_t count = 0) const;
  /// Numbers of the row's fixed count, which is N.
  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(std::string_view attribute) const {
    return to_array<double, N>(list(attribute));
  }
  template <std::size_t N>
  [[nodiscard]] std::optional<std::array<double, N>> optional_numbers(
      std::string_view attribute) const {
    if (!applies(attribute) || !has(attribute)) {
      return std::nullopt;
    }
    return numbers<N>(attribute);
  }
  template <std::size_t N>
  [[nodiscard]] std::array<int, N> integers(std::string_view attribute) const {
    return to_array<int, N>(whole_list(attribute));
  }
  /// A quaternion of unit length.
  [[nodiscard]] std::array<double, 4> quaternion(std::string_view attribute) const;

  /// Checks the text of an attribute given by the element against each type it may belong to; one
  /// must accept it.
  void check_any_type(std::string_view attribute) const;

  /// Whether the attribute has a row for the element's type.
  [[nodiscard]] bool applies(std::string_view attribute) const;

  /// @throws InvalidInput always: about an attribute, ending with what it takes, or with `hint`.
  [[noreturn]] void fail(std::string_view attribute, const std::string& reason,
                         const std::string& hint = "") const;
  /// @throws InvalidInput always: about the element.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  template <typename T, std::size_t N>
  static std::array<T, N> to_array(const std::vector<T>& values) {
    std::array<T, N> out{};
    if (values.size() != N) {
      throw InvalidInput("vocabulary: an attribute's count is not its use");
    }
    for (std::size_t i = 0; i < N; ++i) {
      out[i] = values[i];
    }
    return out;
  }
  void check_value(std::string_view attribute) const;
  [[nodiscard]] const AttributeInfo& row(std::string_view attribute) const;
  [[nodiscard]] AttributeText found(std::string_view attribute) const;
  [[nodiscard]] std::vector<int> whole_list(std::string_view attribute) const;
  void check_attribute_names() const;
  void check_range(std::string_view attribute, const std::vector<double>& values) const;

  const tinyxml2::XMLElement* xml_;
  ReadContext* context_;
  const ElementInfo* info_;
  std::string type_;
  int line_ = 0;
};

/// The child elements of an element, in file order, each checked to be known, allowed there and not
/// repeated too often; text between them is reported in a notice and dropped.
[[nodiscard]] std::vector<const tinyxml2::XMLElement*> checked_children(
    const tinyxml2::XMLElement& parent, ReadContext& context);

/// The beginning of every message about an element: "file:line: <element>: ".
[[nodiscard]] std::string element_place(const ReadContext& context, int line,
                                        std::string_view element);

/// The beginning of every message about an attribute: `file:line: <element attribute="text">: `.
[[nodiscard]] std::string attribute_place(const ReadContext& context, int line,
                                          std::string_view element, std::string_view attribute,
                                          std::string_view text);

}  // namespace hbar::scene
