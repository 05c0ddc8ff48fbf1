#include "hbar/core/scene/vocabulary_table.h"

#include <array>

namespace hbar::scene {
namespace {

constexpr AttributeInfo stiffness_row(std::string_view name, std::string_view unit,
                                      std::string_view sentence) {
  return {.name = name,
          .fallback = "0",
          .range = Range::kNonNegative,
          .unit = unit,
          .sentence = sentence};
}

constexpr AttributeInfo kPos = {.name = "pos",
                                .count = 3,
                                .fallback = "0 0 0",
                                .unit = "length",
                                .sentence = "Origin, in the frame of what it belongs to."};
constexpr AttributeInfo kQuat = {.name = "quat",
                                 .count = 4,
                                 .fallback = "1 0 0 0",
                                 .range = Range::kNonZero,
                                 .sentence = "Axes, as a quaternion w x y z of any length."};
constexpr AttributeInfo kRgba = {
    .name = "rgba", .count = 4, .sentence = "Red, green, blue, opacity; drawn only."};
constexpr AttributeInfo kName = {
    .name = "name", .kind = Kind::kText, .sentence = "Names it in output."};
constexpr AttributeInfo kContactName = {.name = "name",
                                        .kind = Kind::kText,
                                        .sentence = "Names it; the names of its bodies if absent.",
                                        .extension = true};
constexpr AttributeInfo kRender = {
    .name = "render", .kind = Kind::kFlag, .sentence = "Whether its forces are drawn."};
constexpr AttributeInfo kKn =
    stiffness_row("kn", "force/length", "Normal stiffness per contact point.");
constexpr AttributeInfo kKt = stiffness_row(
    "kt", "force·time/length", "Tangential force per sliding velocity, while sticking.");
constexpr AttributeInfo kMu = stiffness_row("mu", "", "Coefficient of friction.");
constexpr AttributeInfo kDamping =
    stiffness_row("damping", "force·time/length²", "Normal damping, per depth.");
constexpr AttributeInfo kLaw = {.name = "law",
                                .kind = Kind::kChoice,
                                .fallback = "document",
                                .choices = "document|linear",
                                .sentence =
                                    "Normal force: damping times depth (document), or "
                                    "damping alone, in force·time/length (linear).",
                                .extension = true};
constexpr AttributeInfo kFriction = {.name = "friction",
                                     .kind = Kind::kChoice,
                                     .fallback = "document",
                                     .choices = "document|smooth",
                                     .sentence =
                                         "Friction: kt times the sliding velocity, at most mu "
                                         "times the normal force (document), or mu times it, less "
                                         "at velocities below friction_width (smooth).",
                                     .extension = true};
constexpr AttributeInfo kFrictionWidth = {
    .name = "friction_width",
    .required = true,
    .range = Range::kPositive,
    .unit = "length/time",
    .types = "smooth",
    .sentence = "Sliding velocity at which friction is 1/√2 of its greatest; kt is not used.",
    .extension = true};
constexpr AttributeInfo kAdhesion = {.name = "adhesion",
                                     .kind = Kind::kFlag,
                                     .fallback = "true",
                                     .sentence =
                                         "Whether damping may make the normal force pull; if not, "
                                         "such a force is 0.",
                                     .extension = true};
constexpr AttributeInfo kReaction = {.name = "reaction",
                                     .kind = Kind::kChoice,
                                     .fallback = "point",
                                     .choices = "point|surface",
                                     .sentence =
                                         "Where the other body is pushed: at the contact "
                                         "point, or at its own surface.",
                                     .extension = true};
constexpr AttributeInfo kCaps = {.name = "caps",
                                 .kind = Kind::kFlag,
                                 .fallback = "true",
                                 .sentence = "Whether a cylinder ends at its end faces.",
                                 .extension = true};

constexpr AttributeInfo reference_row(std::string_view name, std::string_view sentence) {
  return {.name = name, .kind = Kind::kText, .required = true, .sentence = sentence};
}

constexpr std::array kModel = {AttributeInfo{
    .name = "model", .kind = Kind::kText, .fallback = "", .sentence = "The scene's name."}};
constexpr std::array kOption = {
    AttributeInfo{.name = "integrator",
                  .kind = Kind::kChoice,
                  .fallback = "BDF1",
                  .choices = "BDF1|BDF2|SDIRK2",
                  .sentence = "Method of time integration; BDF2 starts with one SDIRK2 step."},
    AttributeInfo{.name = "timestep",
                  .fallback = "0.02",
                  .range = Range::kPositive,
                  .unit = "time",
                  .sentence = "Step h."},
    AttributeInfo{.name = "gravity",
                  .count = 3,
                  .fallback = "0 0 -980",
                  .unit = "length/time²",
                  .sentence = "Acceleration of free fall; the default is that of cm-g."},
    AttributeInfo{.name = "unit",
                  .kind = Kind::kChoice,
                  .fallback = "cm-g",
                  .choices = "cm-g|m-kg",
                  .sentence = "The scene's units; nothing is converted."}};
constexpr std::array kSolver = {
    AttributeInfo{.name = "tol",
                  .fallback = "1e-9",
                  .range = Range::kPositive,
                  .unit = "force·time² or torque·time²",
                  .sentence = "Newton stops where the residual's 2-norm is below this."},
    AttributeInfo{.name = "rtol",
                  .range = Range::kPositive,
                  .sentence = "The same, relative to the forces in the residual.",
                  .extension = true},
    AttributeInfo{.name = "max_iter",
                  .kind = Kind::kInteger,
                  .fallback = "100",
                  .range = Range::kCount,
                  .sentence = "Newton iterations per stage."},
    AttributeInfo{.name = "max_ls",
                  .kind = Kind::kInteger,
                  .fallback = "20",
                  .range = Range::kCount,
                  .sentence = "Halvings per line search."},
    AttributeInfo{.name = "linear_solver",
                  .kind = Kind::kChoice,
                  .fallback = "sweep",
                  .choices = "sweep|auto|block_substitution|block_banded|lapack_band|klu|umfpack|"
                             "eigen_sparse_lu|mumps|cholmod_normal|spqr",
                  .sentence = "What solves the gradient's linear system; sweep forms no matrix.",
                  .extension = true}};
constexpr std::array kGround = {kPos, AttributeInfo{.name = "normal",
                                                    .count = 3,
                                                    .fallback = "0 0 1",
                                                    .range = Range::kNonZero,
                                                    .sentence = "Out of the ground."}};
constexpr std::array kLink = {
    AttributeInfo{.name = "name",
                  .kind = Kind::kText,
                  .sentence = "Names the link; its body's or joint's name if absent."},
    AttributeInfo{.name = "parent",
                  .kind = Kind::kText,
                  .sentence = "Written under robot: the link it hangs on, declared before it.",
                  .extension = true},
    AttributeInfo{.name = "design_params",
                  .kind = Kind::kInteger,
                  .fallback = "0",
                  .range = Range::kMask,
                  .sentence = "Sum of what is a parameter: 1 joint transformation, 2 body "
                              "transformation, 4 contact points, 8 mass and inertia, 16 stiffness "
                              "and damping, 32 contact scale."}};
constexpr std::array kVisual = {reference_row("mesh", "OBJ file; drawn only."), kPos, kQuat};
constexpr std::array kCollision = {
    reference_row("contacts", "File of contact points: a count, then x y z per line."), kPos,
    kQuat};
constexpr std::array kMotor = {
    reference_row("joint", "The joint it drives; not a fixed one."),
    AttributeInfo{.name = "ctrl",
                  .kind = Kind::kChoice,
                  .fallback = "force",
                  .choices = "force|position",
                  .sentence = "What its controls are: shares of the range, or set points."},
    AttributeInfo{.name = "ctrl_range",
                  .count = 2,
                  .range = Range::kOrdered,
                  .unit = "torque or force",
                  .sentence = "Least and greatest force; no limit if absent."},
    AttributeInfo{.name = "P",
                  .required = true,
                  .range = Range::kNonNegative,
                  .unit = "torque/rad or force/length",
                  .types = "position",
                  .sentence = "Force per distance from the set point."},
    AttributeInfo{.name = "D",
                  .fallback = "0",
                  .range = Range::kNonNegative,
                  .unit = "torque·time or force·time/length",
                  .types = "position",
                  .sentence = "Force against velocity."},
    AttributeInfo{.name = "implicit",
                  .kind = Kind::kFlag,
                  .fallback = "false",
                  .types = "position",
                  .sentence = "Whether it sees the state at the end of the step, not its start.",
                  .extension = true}};
constexpr std::array kGroundContact = {reference_row("body", "The body that touches the ground."),
                                       kContactName,
                                       kKn,
                                       kKt,
                                       kMu,
                                       kDamping,
                                       kRender,
                                       kLaw,
                                       kFriction,
                                       kFrictionWidth,
                                       kAdhesion};
constexpr std::array kGeneralContact = {
    reference_row("general_body", "The body whose contact points are tested."),
    reference_row("primitive_body", "The body whose distance is asked."),
    kContactName,
    kKn,
    kKt,
    kMu,
    kDamping,
    kRender,
    kLaw,
    kFriction,
    kFrictionWidth,
    kAdhesion,
    kReaction,
    kCaps};
constexpr std::array kCuboidContact = {reference_row("body_a", "One cuboid."),
                                       reference_row("body_b", "The other."),
                                       kContactName,
                                       kKn,
                                       kKt,
                                       kMu,
                                       kDamping,
                                       kRender,
                                       kLaw,
                                       kFriction,
                                       kFrictionWidth,
                                       kAdhesion,
                                       kReaction};
constexpr std::array kEndEffector = {
    reference_row("joint", "The joint in whose frame the point is fixed."), kPos,
    AttributeInfo{.name = "radius",
                  .range = Range::kPositive,
                  .unit = "length",
                  .sentence = "Of the ball drawn there."},
    kName, kRgba};
constexpr std::array kTactile = {
    reference_row("body", "The body that carries the sensor."),
    AttributeInfo{.name = "name",
                  .kind = Kind::kText,
                  .sentence = "Names it in output; the body's name if absent."},
    AttributeInfo{.name = "type",
                  .kind = Kind::kChoice,
                  .required = true,
                  .choices = "rect_array|abstract",
                  .sentence = "Points on a rectangle, or listed in a file."},
    AttributeInfo{.name = "rect_pos0",
                  .count = 3,
                  .required = true,
                  .unit = "length",
                  .types = "rect_array",
                  .sentence = "First corner."},
    AttributeInfo{.name = "rect_pos1",
                  .count = 3,
                  .required = true,
                  .unit = "length",
                  .types = "rect_array",
                  .sentence = "Opposite corner, in the plane of the axes."},
    AttributeInfo{.name = "axis0",
                  .count = 3,
                  .required = true,
                  .range = Range::kNonZero,
                  .types = "rect_array",
                  .sentence = "Direction of the first index."},
    AttributeInfo{.name = "axis1",
                  .count = 3,
                  .required = true,
                  .range = Range::kNonZero,
                  .types = "rect_array",
                  .sentence = "Direction of the second; axis0 × axis1 is the normal."},
    AttributeInfo{.name = "resolution",
                  .kind = Kind::kInteger,
                  .count = 2,
                  .required = true,
                  .range = Range::kAtLeastOne,
                  .types = "rect_array",
                  .sentence = "Points along each axis; at most 1000000 in all."},
    AttributeInfo{.name = "spec",
                  .kind = Kind::kText,
                  .required = true,
                  .types = "abstract",
                  .sentence = "File of points with axes."},
    AttributeInfo{.name = "pos",
                  .count = 3,
                  .fallback = "0 0 0",
                  .unit = "length",
                  .types = "abstract",
                  .sentence = "Origin of the file's frame."},
    AttributeInfo{.name = "quat",
                  .count = 4,
                  .fallback = "1 0 0 0",
                  .range = Range::kNonZero,
                  .types = "abstract",
                  .sentence = "Its axes, as a quaternion w x y z of any length."},
    kKn,
    kKt,
    kMu,
    kDamping,
    kRender};
constexpr std::array kSphere = {kName, kPos,
                                AttributeInfo{.name = "radius",
                                              .required = true,
                                              .range = Range::kPositive,
                                              .unit = "length",
                                              .sentence = "Radius."},
                                kRgba};
constexpr std::array kCuboid = {kName, kPos, kQuat,
                                AttributeInfo{.name = "size",
                                              .count = 3,
                                              .required = true,
                                              .range = Range::kPositive,
                                              .unit = "length",
                                              .sentence = "Side lengths."},
                                kRgba};

}  // namespace

std::span<const ElementInfo> vocabulary() {
  static const std::array kElements = {
      ElementInfo{"redmax", "", true, "A scene.", kModel},
      ElementInfo{"option", "redmax", true, "Time integration, gravity and units.", kOption},
      ElementInfo{"solver_option", "redmax", true,
                  "Newton's method of each step, and the linear solver of the gradient.", kSolver},
      ElementInfo{"ground", "redmax", true, "A plane that bodies may rest on.", kGround},
      ElementInfo{"default",
                  "redmax",
                  false,
                  "Holds elements whose attributes are taken where a file says nothing.",
                  {}},
      ElementInfo{"robot", "redmax", false, "One or more trees of links.", {}},
      ElementInfo{"link", "robot|link", false, "A joint, its body, and the links on it.", kLink},
      ElementInfo{"joint", "link|default", true, "How a link moves on its parent.",
                  joint_attributes()},
      ElementInfo{"body", "link|default", true, "The solid a link carries.", body_attributes()},
      ElementInfo{"visual", "body", true, "What is drawn for an abstract body.", kVisual},
      ElementInfo{"collision", "body", true, "The contact points of an abstract body.", kCollision},
      ElementInfo{"actuator", "redmax", false, "Holds the motors.", {}},
      ElementInfo{"motor", "actuator|default", false,
                  "Drives a joint, with one control per coordinate.", kMotor},
      ElementInfo{"contact", "redmax", false, "Holds the contacts.", {}},
      ElementInfo{"ground_contact", "contact|default", false, "A body against the ground.",
                  kGroundContact},
      ElementInfo{"general_primitive_contact", "contact|default", false,
                  "The contact points of a body against a simple shape.", kGeneralContact},
      ElementInfo{"cuboid_cuboid_contact", "contact|default", false,
                  "Two cuboids, the points of each against the other.", kCuboidContact, true},
      ElementInfo{"variable", "redmax", false, "Holds the auxiliary variables.", {}},
      ElementInfo{"endeffector", "variable|default", false,
                  "Three variables: where a point of a link is in the world.", kEndEffector},
      ElementInfo{"sensor", "redmax", false, "Holds the sensors.", {}},
      ElementInfo{"tactile", "sensor|default", false, "A field of force sensors on a body.",
                  kTactile},
      ElementInfo{
          "virtual", "redmax", false, "Holds shapes that are drawn and never simulated.", {}},
      ElementInfo{"sphere", "virtual", false, "A ball, drawn only.", kSphere},
      ElementInfo{"cuboid", "virtual", false, "A box, drawn only.", kCuboid}};
  return kElements;
}

}  // namespace hbar::scene
