#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::scene {

/// The folder of the recorded scenes.
inline constexpr const char* kScenes = HBAR_SOURCE_DIR "/tests/golden/scenes";

inline const std::string kBall = "<body type=\"sphere\" radius=\"1\"/>";

/// A scene of one link "a" around a joint in line 4.
inline std::string scene_with_joint(const std::string& joint) {
  return "<redmax>\n<robot>\n<link name=\"a\">\n" + joint +
         "\n<body type=\"sphere\" radius=\"1\"/>\n</link>\n</robot>\n</redmax>\n";
}

/// A scene of one link "a" around a body in line 5.
inline std::string scene_with_body(const std::string& body) {
  return "<redmax>\n<robot>\n<link name=\"a\">\n<joint type=\"fixed\"/>\n" + body +
         "\n</link>\n</robot>\n</redmax>\n";
}

/// A scene with joints j (revolute) and k (fixed), bodies b (a ball) and d (a box), and one more
/// section in line 2.
inline std::string scene_with_section(const std::string& section) {
  return "<redmax>\n" + section + R"(
<robot>
<link name="a">
<joint name="j" type="revolute" axis="0 0 1"/>
<body name="b" type="sphere" radius="1"/>
<link name="c">
<joint name="k" type="fixed"/>
<body name="d" type="cuboid" size="1 1 1"/>
</link>
</link>
</robot>
</redmax>
)";
}

/// A scene that must be refused, and the whole message.
struct BadScene {
  const char* name;
  std::string text;
  std::string message;
};

/// Reads each scene as "bad.xml" and compares what is thrown.
inline void expect_refused(const std::vector<BadScene>& scenes) {
  for (const BadScene& scene : scenes) {
    SCOPED_TRACE(scene.name);
    try {
      static_cast<void>(read_scene_text(scene.text, "bad.xml"));
      ADD_FAILURE() << "was read";
    } catch (const InvalidInput& error) {
      EXPECT_EQ(error.what(), scene.message);
    }
  }
}

}  // namespace hbar::scene
