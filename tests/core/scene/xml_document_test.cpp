#include "hbar/core/scene/xml_document.h"

#include <tinyxml2.h>

#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

std::string parse_refusal(const std::string& text) {
  tinyxml2::XMLDocument document;
  try {
    parse_document(text, "bad.xml", document);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

constexpr const char* kExpected = "; a scene is one element <redmax> ... </redmax> in UTF-8";

TEST(XmlDocument, GivesTheRoot) {
  tinyxml2::XMLDocument document;
  const auto& root = parse_document("<!-- c --><redmax model=\"m\"/>", "a.xml", document);
  EXPECT_STREQ(root.Attribute("model"), "m");
  EXPECT_NO_THROW(
      parse_document("\xef\xbb\xbf<?xml version=\"1.0\"?><redmax/>", "a.xml", document));
}

TEST(XmlDocument, RefusesBytesThatAreNoText) {
  using std::string_literals::operator""s;
  const std::string utf16 = std::string("bad.xml:1: the file is UTF-16") + kExpected;
  EXPECT_EQ(parse_refusal("\xff\xfe<\0r\0"s), utf16);
  EXPECT_EQ(parse_refusal("\xfe\xff\0<\0r"s), utf16);
  EXPECT_EQ(parse_refusal("<\0r\0e\0"s), utf16);
  EXPECT_EQ(parse_refusal("\0<\0r\0e"s), utf16);
  EXPECT_EQ(parse_refusal("<redmax>\n\0</redmax>"s),
            std::string("bad.xml:2: the file is binary: it has a byte \\x00") + kExpected);
  EXPECT_EQ(parse_refusal("\x7f"
                          "ELF\x02\x01"),
            std::string("bad.xml:1: the file is binary: it has a byte \\x02") + kExpected);
}

TEST(XmlDocument, RefusesDeepNesting) {
  std::string text = "<redmax><robot>";
  for (int i = 0; i < 100000; ++i) {
    text += "<link>";
  }
  EXPECT_EQ(
      parse_refusal(text),
      concat("bad.xml:1: elements are nested too deeply; at most ", TINYXML2_MAX_ELEMENT_DEPTH,
             " levels are read; write deep chains of links flat, with parent=\"LINK\""));
}

const std::vector<BadScene> kRefusedDocuments = {
    {"empty", "",
     "bad.xml:1: the file is empty; a scene is one element <redmax> ... </redmax> in UTF-8"},
    {"blank", " \n\t\n",
     "bad.xml:1: the file is empty; a scene is one element <redmax> ... </redmax> in UTF-8"},
    {"only a comment", "<!-- nothing -->",
     "bad.xml:1: the file has no element; a scene is one element <redmax> ... </redmax> in UTF-8"},
    {"wrong root", "<mujoco/>",
     "bad.xml:1: <mujoco>: wrong root element; a scene is one element <redmax> ... </redmax> in "
     "UTF-8"},
    {"two roots", "<redmax/>\n<redmax/>",
     "bad.xml:2: <redmax>: a second root element; a scene is one element <redmax> ... </redmax> in "
     "UTF-8"},
    {"mismatched tags", "<redmax>\n<robot>\n</link>\n</redmax>",
     "bad.xml:2: <robot> is not closed by a tag of its own name; <robot> ends with </robot>"},
    {"truncated in an element", "<redmax>\n<robot>\n<link name=\"a\">\n",
     "bad.xml:3: a tag is malformed, or the file ends within it; a scene is one element <redmax> "
     "... </redmax> in UTF-8"},
    {"truncated in an attribute", "<redmax>\n<robot>\n<link name=\"a",
     "bad.xml:3: <link> has a malformed attribute; attributes are written name=\"value\", each "
     "once"},
    {"truncated in a tag", "<redmax>\n<robot",
     "bad.xml:2: <robot> is malformed, or the file ends within it; a scene is one element <redmax> "
     "... </redmax> in UTF-8"},
    {"open comment", "<redmax>\n<!-- never ends\n</redmax>",
     "bad.xml:2: a comment is not closed; comments end with -->"},
    {"duplicate attribute",
     "<redmax>\n<option timestep=\"1\" unit=\"cm-g\" timestep=\"2\"/>\n</redmax>",
     "bad.xml:2: <option>: attribute timestep is given twice; each attribute may be given once"},
    {"attribute without quotes", "<redmax>\n<option timestep=1/>\n</redmax>",
     "bad.xml:2: <option> has a malformed attribute; attributes are written name=\"value\", each "
     "once"},
    {"attribute without value", "<redmax>\n<option timestep/>\n</redmax>",
     "bad.xml:2: <option> has a malformed attribute; attributes are written name=\"value\", each "
     "once"},
    {"text only", "hello",
     "bad.xml:1: a tag is malformed, or the file ends within it; a scene is one element <redmax> "
     "... </redmax> in UTF-8"},
};

TEST(XmlDocument, RefusesWithTheWholeMessage) { expect_refused(kRefusedDocuments); }

}  // namespace
}  // namespace hbar::scene
