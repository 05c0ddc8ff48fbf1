#include "tasks.h"

#include <numbers>
#include <utility>

namespace hbar::manipulation {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

Eigen::VectorXd vector(std::initializer_list<double> numbers) {
  return Eigen::Map<const Eigen::VectorXd>(std::data(numbers),
                                           static_cast<Eigen::Index>(numbers.size()));
}

/// What the tasks have in common: fingers by the prefixes of their names.
Task with_fingers(const char* name, const std::vector<std::string>& prefixes) {
  Task task;
  task.name = name;
  task.scene = std::string(HBAR_SOURCE_DIR "/examples/scenes/") + name + ".xml";
  for (const std::string& prefix : prefixes) {
    for (const auto& [body, next] :
         {std::pair{"proximal", "middle_hinge"}, {"middle", "distal_hinge"}, {"distal", "tip"}}) {
      task.lengths.push_back({"length of " + prefix + body, {{prefix + body, prefix + next}}});
    }
  }
  task.velocity_weight = 1.0;
  task.rest_weight = 0.1;
  const auto fingers = static_cast<Eigen::Index>(prefixes.size());
  task.control_scale = vector({0.02, 0.02, 0.1, 0.1, 0.1}).replicate(fingers, 1);
  task.control_bound = vector({0.3, 0.3, 2.0, 2.0, 2.0}).replicate(fingers, 1);
  return task;
}

}  // namespace

Task rotate_box() {
  Task task = with_fingers("rotate_box", {""});
  task.title = "A finger turns a box on the ground by 90 degrees.";
  task.duration = 2.0;
  task.steps = 400;
  task.guess = {{0.0, vector({0.0, 0.0, 0.0, 0.0, 0.0})},
                {0.9, vector({0.0, 0.2, 0.0, 0.0, 0.0})},
                {1.0, vector({0.0, 0.2, 0.0, 0.0, 0.0})}};
  task.goals = {{"box.c", kQuarterTurn, 0.01, 300.0}};
  return task;
}

Task flip_box() {
  Task task = with_fingers("flip_box", {""});
  task.title = "A finger flips a box over its edge.";
  task.start = {{"knuckle", 0.8}, {"middle_hinge", -1.6}, {"distal_hinge", 0.8}};
  task.guess = {{0.0, vector({0.0, 0.0, 0.8, -1.6, 0.8})},
                {0.6, vector({0.0, 0.12, 0.8, -1.6, 0.8})},
                {1.0, vector({0.0, 0.12, 0.8, -1.6, 0.8})}};
  task.enough = 2e-3;
  task.goals = {{"box.a", -kQuarterTurn, 0.01, 100.0}};
  return task;
}

Task assemble() {
  Task task = with_fingers("assemble", {"left_", "right_"});
  task.title = "Two fingers bring two boxes together.";
  task.duration = 2.0;
  task.steps = 400;
  task.start = {{"left.y", 0.01}, {"left.c", 0.15}, {"right.y", -0.01}, {"right.c", 0.1}};
  const auto both = [](double travel) {
    return vector({travel, 0.0, 0.0, 0.0, 0.0, -travel, 0.0, 0.0, 0.0, 0.0});
  };
  task.guess = {{0.0, both(0.0)}, {0.9, both(0.1)}, {1.0, both(0.1)}};
  task.goals = {{"left.x", 0.1, 0.002, 3e4},  {"left.y", 0.0, 0.002, 3e4},
                {"left.c", 0.0, 0.02, 300.0}, {"right.x", -0.1, 0.002, 3e4},
                {"right.y", 0.0, 0.002, 3e4}, {"right.c", 0.0, 0.02, 300.0}};
  task.enough = 1e-2;
  task.contact_scales = {0.01, 0.1, 1.0};
  task.scaled_bodies = {"left_tip", "right_tip"};
  return task;
}

}  // namespace hbar::manipulation
