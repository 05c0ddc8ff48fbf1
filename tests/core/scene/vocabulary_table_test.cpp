#include "hbar/core/scene/vocabulary_table.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/core/scene/scene_testing.h"

namespace hbar::scene {
namespace {

TEST(EveryElement, IsSaidOnceAndStandsInKnownParents) {
  std::set<std::string> names;
  for (const ElementInfo& element : vocabulary()) {
    EXPECT_TRUE(names.emplace(element.name).second) << element.name;
    EXPECT_FALSE(element.sentence.empty()) << element.name;
    for (const std::string& parent : listed(element.parents, '|')) {
      EXPECT_NE(find_element(parent), nullptr) << parent;
    }
  }
}

TEST(EveryAttribute, IsCompleteAndUnambiguous) {
  for (const ElementInfo& element : vocabulary()) {
    std::set<std::string> rows;
    for (const AttributeInfo& attribute : element.attributes) {
      SCOPED_TRACE(std::string(element.name) + " " + std::string(attribute.name));
      EXPECT_FALSE(attribute.sentence.empty());
      EXPECT_FALSE(attribute.required && attribute.fallback != nullptr);
      EXPECT_EQ(attribute.kind == Kind::kChoice, !attribute.choices.empty());
      for (const std::string& type :
           attribute.types.empty() ? std::vector<std::string>{""} : listed(attribute.types, ' ')) {
        EXPECT_TRUE(rows.insert(std::string(attribute.name) + " " + type).second);
      }
    }
  }
}

TEST(EveryDefault, IsThatOfTheStructs) {
  const Description description =
      read_scene_text(scene_with_section("<option/><solver_option/><ground/>"
                                         "<actuator><motor joint=\"j\"/></actuator>"),
                      "bad.xml")
          .description;
  EXPECT_EQ(description.options, Options());
  EXPECT_EQ(description.solver_options, SolverOptions());
  EXPECT_EQ(description.ground, Ground());
  Motor motor;
  motor.joint = "j";
  EXPECT_EQ(description.motors.at(0), motor);
}

}  // namespace
}  // namespace hbar::scene
