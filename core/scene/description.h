#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

/// What a scene file says, as plain data: no file, no mesh and no matrix is opened or computed
/// here. Numbers are in the scene's own units. Members are named as the attributes are, and their
/// initial values are the format's defaults (doc/scene_format.md). Descriptions compare equal if
/// every simulated or stored value is equal, whatever the layout of the files.
namespace hbar::scene {

using Vec2 = std::array<double, 2>;
using Vec3 = std::array<double, 3>;
using Vec4 = std::array<double, 4>;
/// w x y z, of unit length.
using Quat = std::array<double, 4>;

/// Line of a scene file, for messages only: all lines compare equal. 0 means no file.
struct SourceLine {
  int number = 0;  ///< 1 is the first line
  friend bool operator==(const SourceLine&, const SourceLine&) { return true; }
};

/// Integrators a scene may name, in the order of the vocabulary.
enum class Integrator { kBdf1, kBdf2, kSdirk2 };

/// Units of a scene's numbers: centimetre and gram, or metre and kilogram; seconds in both. In the
/// order of the vocabulary.
enum class UnitSystem { kCmG, kMKg };

/// `<option>`.
struct Options {
  Integrator integrator = Integrator::kBdf1;
  double timestep = 0.02;             ///< time, > 0
  Vec3 gravity = {0.0, 0.0, -980.0};  ///< length/time²  [3]
  UnitSystem unit = UnitSystem::kCmG;
  friend bool operator==(const Options&, const Options&) = default;
};

/// `<solver_option>`: Newton's method of each step, and the linear solver of the gradient.
struct SolverOptions {
  double tol = 1e-9;                    ///< bound on ‖g‖₂, > 0
  std::optional<double> rtol = {};      ///< bound on ‖g‖₂ relative to the forces, > 0
  int max_iter = 100;                   ///< iterations per stage, ≥ 1
  int max_ls = 20;                      ///< halvings per line search, ≥ 1
  std::string linear_solver = "sweep";  ///< of the gradient, by name; "sweep" forms no matrix
  friend bool operator==(const SolverOptions&, const SolverOptions&) = default;
};

/// `<ground>`: a half-space.
struct Ground {
  Vec3 pos = {0.0, 0.0, 0.0};     ///< a point of the plane, length  [3]
  Vec3 normal = {0.0, 0.0, 1.0};  ///< out of the ground, not zero   [3]
  SourceLine line = {};
  friend bool operator==(const Ground&, const Ground&) = default;
};

/// In the order of the vocabulary's choices for `<joint type>`.
enum class JointType {
  kFixed,
  kRevolute,
  kPrismatic,
  kPlanar,
  kTranslational,
  kFree2d,
  kSphericalEuler,
  kSphericalExp,
  kFree3dEuler,
  kFree3dExp,
  kUniversal
};

/// Number of coordinates of a joint.
[[nodiscard]] constexpr int coordinate_count(JointType type) {
  constexpr std::array<int, 11> kCounts = {0, 1, 1, 2, 3, 3, 3, 3, 6, 6, 2};
  return kCounts[static_cast<std::size_t>(type)];
}

/// What a joint's placement refers to: its parent's joint frame, or the world at rest.
enum class Frame { kLocal, kWorld };

/// `<joint>`.
struct Joint {
  std::string name = {};
  JointType type = JointType::kFixed;
  Frame frame = Frame::kLocal;
  Vec3 pos = {0.0, 0.0, 0.0};        ///< joint frame at rest, length                        [3]
  Quat quat = {1.0, 0.0, 0.0, 0.0};  ///< its axes                                           [4]
  std::optional<Vec3> axis = {};     ///< revolute, prismatic; any length but 0              [3]
  std::optional<Vec3> axis0 = {};    ///< planar, universal                                  [3]
  std::optional<Vec3> axis1 = {};    ///< planar, universal; not parallel to axis0           [3]
  double damping = 0.0;              ///< torque·time or force·time/length, ≥ 0
  double stiffness = 0.0;            ///< torque/rad or force/length, ≥ 0
  std::vector<double> rest = {};     ///< rad or length                                      [dof]
  std::optional<Vec2> lim = {};      ///< lower and upper of each coordinate, rad or length  [2]
  double lim_stiffness = 0.0;        ///< torque/rad or force/length, ≥ 0
  SourceLine line = {};
  friend bool operator==(const Joint&, const Joint&) = default;
};

/// A box.
struct CuboidBody {
  Vec3 size = {1.0, 1.0, 1.0};                                ///< sides, length, > 0  [3]
  std::array<int, 3> general_contact_resolution = {6, 6, 6};  ///< grid points         [3]
  friend bool operator==(const CuboidBody&, const CuboidBody&) = default;
};
/// A ball.
struct SphereBody {
  double radius = 1.0;                                                ///< length, > 0
  std::optional<std::array<int, 2>> general_contact_resolution = {};  ///< points around, rings  [2]
  friend bool operator==(const SphereBody&, const SphereBody&) = default;
};
/// A cylinder about z.
struct CylinderBody {
  double radius = 1.0;                        ///< length, > 0
  double length = 1.0;                        ///< length, > 0
  int general_contact_angle_resolution = 8;   ///< points around, ≥ 1
  int general_contact_radius_resolution = 3;  ///< circles, ≥ 1
  friend bool operator==(const CylinderBody&, const CylinderBody&) = default;
};
/// A cylinder about z closed by two half-balls.
struct CapsuleBody {
  double radius = 1.0;                                     ///< length, > 0
  double length = 1.0;                                     ///< between their centres, > 0
  std::array<int, 2> general_contact_resolution = {5, 4};  ///< rings, points of each  [2]
  friend bool operator==(const CapsuleBody&, const CapsuleBody&) = default;
};

/// What a mesh body's pos and quat place: its principal frame or its file's, in the joint frame or
/// the world. In the order of the vocabulary.
enum class MeshTransform { kBodyToJoint, kObjToJoint, kObjToWorld };

/// A homogeneous solid bounded by the triangles of an OBJ file.
struct MeshBody {
  std::string filename = {};     ///< relative to the scene's folder
  Vec3 scale = {1.0, 1.0, 1.0};  ///< of the OBJ's coordinates, > 0  [3]
  MeshTransform transform_type = MeshTransform::kBodyToJoint;
  std::optional<std::string> contacts = {};  ///< file of contact points
  int contact_count = 64;                    ///< points chosen where there is no such file, ≥ 1
  int distance_cells = 48;  ///< along the longest side of its distance grid, 8 … 256
  friend bool operator==(const MeshBody&, const MeshBody&) = default;
};

/// `<visual>`: what is drawn for an abstract body.
struct Visual {
  std::string mesh = {};             ///< OBJ file
  Vec3 pos = {0.0, 0.0, 0.0};        ///< length  [3]
  Quat quat = {1.0, 0.0, 0.0, 0.0};  ///<         [4]
  friend bool operator==(const Visual&, const Visual&) = default;
};
/// `<collision>`: the contact points of an abstract body.
struct Collision {
  std::string contacts = {};         ///< file of contact points
  Vec3 pos = {0.0, 0.0, 0.0};        ///< length  [3]
  Quat quat = {1.0, 0.0, 0.0, 0.0};  ///<         [4]
  SourceLine line = {};
  friend bool operator==(const Collision&, const Collision&) = default;
};
/// A body known by its mass properties.
struct AbstractBody {
  double mass = 1.0;                              ///< mass, > 0
  std::vector<double> inertia = {1.0, 1.0, 1.0};  ///< principal, or xx xy xz yy yz zz  [3 or 6]
  std::optional<std::string> mesh = {};           ///< OBJ file, drawn
  std::optional<std::string> contacts = {};       ///< file of contact points
  Vec3 scale = {1.0, 1.0, 1.0};                   ///< of mesh and contacts, > 0         [3]
  std::optional<Visual> visual = {};
  std::optional<Collision> collision = {};
  friend bool operator==(const AbstractBody&, const AbstractBody&) = default;
};

/// In the order of the vocabulary's choices for `<body type>`.
using BodyShape =
    std::variant<CuboidBody, SphereBody, CylinderBody, CapsuleBody, MeshBody, AbstractBody>;

/// `<body>`.
struct Body {
  std::string name = {};
  BodyShape shape = {};
  Vec3 pos = {0.0, 0.0, 0.0};        ///< body frame in the joint frame, length  [3]
  Quat quat = {1.0, 0.0, 0.0, 0.0};  ///< its axes                               [4]
  double density = 1.0;              ///< mass/length³, > 0; 1 where it does not apply
  std::optional<Vec4> rgba = {};     ///< red, green, blue, opacity              [4]
  std::optional<std::string> texture = {};
  SourceLine line = {};
  friend bool operator==(const Body&, const Body&) = default;
};

/// `<link>`: a joint and the body it carries.
struct Link {
  std::string name = {};
  int parent = -1;  ///< index into the robot's links, smaller than this link's; −1: the world
  int design_params = 0;  ///< sum of 1 joint and 2 body transformation, 4 contact points, 8 mass
                          ///< and inertia, 16 stiffness and damping, 32 contact scale
  Joint joint = {};
  Body body = {};
  SourceLine line = {};
  friend bool operator==(const Link&, const Link&) = default;
};

/// `<robot>`: links in file order.
struct Robot {
  std::vector<Link> links = {};
  friend bool operator==(const Robot&, const Robot&) = default;
};

/// What a motor's controls are: forces, as shares of its range, or positions to reach.
enum class Control { kForce, kPosition };

/// `<motor>`: one control per coordinate of its joint.
struct Motor {
  std::string joint = {};
  Control ctrl = Control::kForce;
  std::optional<Vec2> ctrl_range = {};  ///< lower and upper, force or torque           [2]
  std::optional<double> P = {};         ///< position motors: force per error, ≥ 0
  double D = 0.0;                       ///< position motors: force per velocity, ≥ 0
  bool implicit = false;                ///< position motors: the state at the end of the step
  SourceLine line = {};
  friend bool operator==(const Motor&, const Motor&) = default;
};

/// Which two shapes touch, and so which element a contact was.
enum class ContactKind { kGround, kGeneralPrimitive, kCuboidCuboid };

/// How an element of a kind is spelled.
[[nodiscard]] constexpr std::string_view contact_element(ContactKind kind) {
  constexpr std::array<std::string_view, 3> kNames = {"ground_contact", "general_primitive_contact",
                                                      "cuboid_cuboid_contact"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// How the normal force is damped: in proportion to the depth, or regardless of it.
enum class ContactLaw { kDocument, kLinear };

/// Friction: bounded by a multiple of the normal force with a corner, or smoothly.
enum class Friction { kDocument, kSmooth };

/// Where the second body is pushed: at the contact point, or at its own surface.
enum class Reaction { kPoint, kSurface };

/// `<ground_contact>`, `<general_primitive_contact>`, `<cuboid_cuboid_contact>`.
struct Contact {
  ContactKind kind = ContactKind::kGround;
  std::optional<std::string> name = {};
  std::string body_a = {};  ///< body, general_body, body_a: the one whose points are tested
  std::string body_b = {};  ///< primitive_body, body_b; empty for the ground
  double kn = 0.0;          ///< force/length, ≥ 0
  double kt = 0.0;          ///< force·time/length, ≥ 0
  double mu = 0.0;          ///< ≥ 0
  double damping = 0.0;     ///< document: force·time/length²; linear: force·time/length; ≥ 0
  std::optional<bool> render = {};
  ContactLaw law = ContactLaw::kDocument;
  Friction friction = Friction::kDocument;
  std::optional<double> friction_width = {};  ///< of smooth friction, length/time, > 0
  bool adhesion = true;                       ///< damping may make the normal force pull
  Reaction reaction = Reaction::kPoint;
  bool caps = true;  ///< a cylinder's end faces count for its distance
  SourceLine line = {};
  friend bool operator==(const Contact&, const Contact&) = default;
};

/// `<endeffector>`: the world position of a point fixed in a joint's frame, three variables.
struct EndEffector {
  std::string joint = {};
  Vec3 pos = {0.0, 0.0, 0.0};         ///< in the joint's frame, length  [3]
  std::optional<double> radius = {};  ///< drawn, length, > 0
  std::optional<std::string> name = {};
  std::optional<Vec4> rgba = {};  ///< red, green, blue, opacity  [4]
  SourceLine line = {};
  friend bool operator==(const EndEffector&, const EndEffector&) = default;
};

/// Sensor points on a rectangle.
struct RectArray {
  Vec3 rect_pos0 = {0.0, 0.0, 0.0};        ///< first corner, length               [3]
  Vec3 rect_pos1 = {0.0, 0.0, 0.0};        ///< opposite corner, length            [3]
  Vec3 axis0 = {1.0, 0.0, 0.0};            ///< along the rows                     [3]
  Vec3 axis1 = {0.0, 1.0, 0.0};            ///< along the columns                  [3]
  std::array<int, 2> resolution = {1, 1};  ///< points along axis0, axis1, ≥ 1     [2]
  friend bool operator==(const RectArray&, const RectArray&) = default;
};
/// Sensor points listed in a file.
struct PointList {
  std::string spec = {};             ///< file of points with axes
  Vec3 pos = {0.0, 0.0, 0.0};        ///< length  [3]
  Quat quat = {1.0, 0.0, 0.0, 0.0};  ///<         [4]
  friend bool operator==(const PointList&, const PointList&) = default;
};

/// `<tactile>`.
struct TactileSensor {
  std::string body = {};
  std::string name = {};
  std::variant<RectArray, PointList> points = {};  ///< in the order of the choices for its type
  double kn = 0.0;                                 ///< force/length, ≥ 0
  double kt = 0.0;                                 ///< force·time/length, ≥ 0
  double mu = 0.0;                                 ///< ≥ 0
  double damping = 0.0;                            ///< force·time/length², ≥ 0
  std::optional<bool> render = {};
  SourceLine line = {};
  friend bool operator==(const TactileSensor&, const TactileSensor&) = default;
};

/// `<virtual><sphere>`: drawn, never simulated.
struct VirtualSphere {
  double radius = 1.0;  ///< length, > 0
  friend bool operator==(const VirtualSphere&, const VirtualSphere&) = default;
};
/// `<virtual><cuboid>`: drawn, never simulated.
struct VirtualCuboid {
  Vec3 size = {1.0, 1.0, 1.0};       ///< sides, length, > 0  [3]
  Quat quat = {1.0, 0.0, 0.0, 0.0};  ///<                     [4]
  friend bool operator==(const VirtualCuboid&, const VirtualCuboid&) = default;
};

/// A child of `<virtual>`: a shape that is drawn and touches nothing.
struct VirtualShape {
  std::optional<std::string> name = {};
  std::variant<VirtualSphere, VirtualCuboid> shape = {};
  Vec3 pos = {0.0, 0.0, 0.0};     ///< in the world, length       [3]
  std::optional<Vec4> rgba = {};  ///< red, green, blue, opacity  [4]
  friend bool operator==(const VirtualShape&, const VirtualShape&) = default;
};

/// `<redmax>`: the whole file.
struct Description {
  std::string model = {};
  Options options = {};
  SolverOptions solver_options = {};
  std::optional<Ground> ground = {};
  std::vector<Robot> robots = {};
  std::vector<Motor> motors = {};
  std::vector<Contact> contacts = {};
  std::vector<EndEffector> end_effectors = {};
  std::vector<TactileSensor> tactile_sensors = {};
  std::vector<VirtualShape> virtual_shapes = {};
  friend bool operator==(const Description&, const Description&) = default;
};

}  // namespace hbar::scene
