#include "hbar/core/scene/xml_document.h"

#include <tinyxml2.h>

#include <algorithm>
#include <set>

#include "hbar/core/base/error.h"
#include "hbar/core/files/numbers.h"

namespace hbar::scene {
namespace {

constexpr const char* kExpected = "a scene is one element <redmax> ... </redmax> in UTF-8";

[[noreturn]] void fail(const std::string& file, std::ptrdiff_t line, const std::string& reason,
                       const std::string& hint = kExpected) {
  throw InvalidInput(concat(file, ":", line, ": ", reason, "; ", hint));
}

std::ptrdiff_t line_of(std::string_view text, std::size_t position) {
  return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n');
}

void check_bytes(std::string_view text, const std::string& file) {
  const std::string_view start = text.substr(0, 2);
  if (start == "\xff\xfe" || start == "\xfe\xff" || start == std::string_view("<\0", 2) ||
      start == std::string_view("\0<", 2)) {
    fail(file, 1, "the file is UTF-16");
  }
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 && byte != '\n' && byte != '\r' && byte != '\t') {
      fail(file, line_of(text, i),
           concat("the file is binary: it has a byte ", quotable(text.substr(i, 1))));
    }
  }
  const bool blank = split_words(text).empty();
  if (blank) {
    fail(file, 1, "the file is empty");
  }
}

/// The name of the element tinyxml2 complains about, or nothing.
std::string blamed_element(const tinyxml2::XMLDocument& document) {
  const std::string message = document.ErrorStr();
  const std::string marker = "XMLElement name=";
  const std::size_t at = message.find(marker);
  return at == std::string::npos ? "" : message.substr(at + marker.size());
}

/// The attribute that an element gives twice, or nothing. The element is the last of that name that
/// begins on or before a line.
std::string repeated_attribute(std::string_view text, int line, const std::string& element) {
  std::size_t end = 0;
  for (int i = 0; i < line && end != std::string_view::npos; ++i) {
    end = text.find('\n', end + 1);
  }
  const std::size_t begin = text.rfind("<" + element, end);
  if (element.empty() || begin == std::string_view::npos) {
    return "";
  }
  std::set<std::string, std::less<>> seen;
  std::size_t i = begin + 1 + element.size();
  while (i < text.size() && text[i] != '>') {
    const std::size_t equals = text.find('=', i);
    const std::size_t open = text.find_first_of("\"'", i);
    if (equals == std::string_view::npos || open == std::string_view::npos) {
      return "";
    }
    const auto words = split_words(text.substr(i, equals - i));
    if (words.size() != 1) {
      return "";
    }
    if (!seen.emplace(words[0]).second) {
      return std::string(words[0]);
    }
    const std::size_t close = text.find(text[open], open + 1);
    if (close == std::string_view::npos) {
      return "";
    }
    i = close + 1;
    while (i < text.size() && (!split_words(text.substr(i, 1)).empty() ? text[i] == '/' : true)) {
      ++i;
    }
  }
  return "";
}

[[noreturn]] void fail_to_parse(const tinyxml2::XMLDocument& document, std::string_view text,
                                const std::string& file) {
  const int line = std::max(1, document.ErrorLineNum());
  const std::string element = quotable(blamed_element(document));
  const std::string tag = element.empty() ? "a tag" : "<" + element + ">";
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE: {
      const std::string name = repeated_attribute(text, line, element);
      if (!name.empty()) {
        fail(file, line, concat("<", element, ">: attribute ", name, " is given twice"),
             "each attribute may be given once");
      }
      fail(file, line, concat(tag, " has a malformed attribute"),
           "attributes are written name=\"value\", each once");
    }
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      fail(file, line, concat(tag, " is not closed by a tag of its own name"),
           concat(tag, " ends with </", element, ">"));
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      fail(file, line, "elements are nested too deeply",
           concat("at most ", TINYXML2_MAX_ELEMENT_DEPTH,
                  " levels are read; write deep chains of links flat, with parent=\"LINK\""));
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      fail(file, line, "a comment is not closed", "comments end with -->");
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      fail(file, line, "the file has no element");
    default:
      fail(file, line, concat(tag, " is malformed, or the file ends within it"));
  }
}

}  // namespace

const tinyxml2::XMLElement& parse_document(std::string_view text, const std::string& file,
                                           tinyxml2::XMLDocument& document) {
  check_bytes(text, file);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    fail_to_parse(document, text, file);
  }
  const tinyxml2::XMLElement* const root = document.RootElement();
  if (root == nullptr) {
    fail(file, 1, "the file has no element");
  }
  if (std::string_view(root->Name()) != "redmax") {
    fail(file, root->GetLineNum(), concat("<", quotable(root->Name()), ">: wrong root element"));
  }
  if (const auto* const second = root->NextSiblingElement()) {
    fail(file, second->GetLineNum(),
         concat("<", quotable(second->Name()), ">: a second root element"));
  }
  return *root;
}

}  // namespace hbar::scene
