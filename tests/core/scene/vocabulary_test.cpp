#include "hbar/core/scene/vocabulary.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "hbar/core/base/error.h"

namespace hbar::scene {
namespace {

std::string file_text(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(Vocabulary, FindsElementsAndAttributes) {
  ASSERT_NE(find_element("joint"), nullptr);
  EXPECT_EQ(find_element("hinge"), nullptr);
  const ElementInfo& body = *find_element("body");
  EXPECT_EQ(find_attribute(body, "general_contact_resolution", "cuboid")->count, 3);
  EXPECT_EQ(find_attribute(body, "general_contact_resolution", "capsule")->count, 2);
  EXPECT_EQ(find_attribute(body, "general_contact_resolution", "mesh"), nullptr);
  EXPECT_NE(find_attribute(body, "general_contact_resolution", ""), nullptr);
  EXPECT_EQ(find_attribute(body, "colour", ""), nullptr);
}

TEST(Vocabulary, ListsChildrenAndNamesOnce) {
  EXPECT_EQ(children_of("link"), (std::vector<std::string>{"link", "joint", "body"}));
  EXPECT_TRUE(children_of("option").empty());
  const std::vector<std::string> names = attribute_names(*find_element("body"));
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Vocabulary, SaysWhatAnAttributeTakes) {
  const auto takes = [](const char* element, const char* attribute, const char* type = "") {
    return what_it_takes(*find_attribute(*find_element(element), attribute, type));
  };
  EXPECT_EQ(takes("option", "timestep"), "timestep takes 1 number > 0");
  EXPECT_EQ(takes("body", "inertia"), "inertia takes 3 or 6 numbers");
  EXPECT_EQ(takes("motor", "implicit"), "implicit takes true or false");
  EXPECT_EQ(takes("motor", "ctrl"), "ctrl takes one of force, position");
  EXPECT_EQ(takes("joint", "rest"), "rest takes one number per joint coordinate");
  EXPECT_EQ(takes("joint", "format"), "format takes anything");
}

TEST(Vocabulary, SpellsChoices) {
  EXPECT_EQ(choice_name("option", "integrator", 2), "SDIRK2");
  try {
    static_cast<void>(choice_name("option", "integrator", 3));
    ADD_FAILURE();
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "choice_name: <option integrator> has no choice 3; it has 3");
  }
}

TEST(Vocabulary, IsWhatTheDocumentSays) {
  const std::string path = HBAR_SOURCE_DIR "/doc/scene_format.md";
  const std::string document = file_text(path);
  const std::string begin = "<!-- generated from the vocabulary: begin -->\n\n";
  const std::string end = "<!-- generated from the vocabulary: end -->\n";
  const std::size_t first = document.find(begin);
  const std::size_t last = document.find(end);
  ASSERT_NE(first, std::string::npos) << path;
  ASSERT_NE(last, std::string::npos) << path;
  const std::string generated = document.substr(first + begin.size(), last - first - begin.size());
  EXPECT_EQ(generated, vocabulary_markdown())
      << "put what vocabulary_markdown() returns between the two marks of " << path;
}

}  // namespace
}  // namespace hbar::scene
