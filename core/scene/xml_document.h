#pragma once

#include <string>
#include <string_view>

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace hbar::scene {

/// Parses the text of a scene file as XML with the one root `<redmax>`.
///
/// @param text      the file's bytes
/// @param file      its name for messages
/// @param document  receives the parsed document
/// @returns         the root
/// @throws InvalidInput that begins `file:line:` if it is not well formed, is not UTF-8 text, is
///         empty, or has another or a second root
const tinyxml2::XMLElement& parse_document(std::string_view text, const std::string& file,
                                           tinyxml2::XMLDocument& document);

}  // namespace hbar::scene
