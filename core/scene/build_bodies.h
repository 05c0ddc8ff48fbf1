#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "hbar/core/base/error.h"
#include "hbar/core/geometry/mesh.h"
#include "hbar/core/model/model.h"
#include "hbar/core/scene/read_xml.h"

namespace hbar::scene {

/// The pose given by the pos and quat of an element.
[[nodiscard]] RigidTransform<double> pose(const Vec3& pos, const Quat& quat);

/// A file's numbers as a vector.
[[nodiscard]] Eigen::Vector3d vector(const Vec3& v);

/// The surface of a mesh body, whose distance a contact may need.
struct BodyMesh {
  TriangleMesh surface;        ///< in the body frame, length
  std::filesystem::path file;  ///< its file
  int cells = 0;               ///< along the longest side of its distance grid
};

/// A body of a model, with what its contacts and sensors need in addition.
struct BuiltBody {
  hbar::Body body;                        ///< with its contact points; moved into the model
  RigidTransform<double> X_BG = {};       ///< the frame the scene gives points of it in: the OBJ
                                          ///< file's of a mesh, that of pos and quat of any other
  std::optional<BodyMesh> mesh = {};      ///< of a mesh body
  std::vector<std::string> notices = {};  ///< what the user should know, each `file:line: ...`
};

/// The bodies of a scene.
struct BuiltBodies {
  std::vector<BuiltBody> of_link = {};                ///< by link of the model
  std::unordered_map<std::string, int> link_of = {};  ///< link by the body's name

  /// The link that carries a body.
  /// @throws InvalidInput if there is no such body
  [[nodiscard]] int find(const std::string& body) const;
};

/// Runs `call`; errors it throws then begin with `place`.
template <typename Call>
auto with_place(const std::string& place, const Call& call) {
  try {
    return call();
  } catch (const IoError& error) {
    throw IoError(place + error.what());
  } catch (const InvalidInput& error) {
    throw InvalidInput(place + error.what());
  }
}

/// Builds a body: its mass properties and contact points. Opens the files it names.
///
/// @param scene  its scene, for the folder and the file name
/// @param body   what the scene says about it
/// @param X_WJ   its joint's frame in the world at rest
/// @throws IoError       if a file cannot be read
/// @throws InvalidInput  if a mesh does not bound a solid or a file has other content; messages
///                       begin `file:line: <body ...>:`
[[nodiscard]] BuiltBody build_body(const Scene& scene, const Body& body,
                                   const RigidTransform<double>& X_WJ);

}  // namespace hbar::scene
