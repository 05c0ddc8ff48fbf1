#include "hbar/core/scene/read_assimp.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>

#include "hbar/core/base/error.h"

namespace hbar::scene {
namespace {

void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above,
              PolygonMesh& mesh) {
  const aiMatrix4x4 transform = above * node.mTransformation;
  const bool mirrored = transform.Determinant() < 0.0F;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
    const int first = static_cast<int>(mesh.vertices.size());
    for (unsigned k = 0; k < part.mNumVertices; ++k) {
      const aiVector3D point = transform * part.mVertices[k];
      mesh.vertices.emplace_back(point.x, point.y, point.z);
    }
    for (unsigned k = 0; k < part.mNumFaces; ++k) {
      const aiFace& face = part.mFaces[k];
      if (face.mNumIndices < 3) {
        continue;
      }
      Polygon polygon;
      for (unsigned j = 0; j < face.mNumIndices; ++j) {
        polygon.corners.push_back(first + static_cast<int>(face.mIndices[j]));
      }
      if (mirrored) {
        std::reverse(polygon.corners.begin(), polygon.corners.end());
      }
      mesh.polygons.push_back(std::move(polygon));
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    add_node(scene, *node.mChildren[i], transform, mesh);
  }
}

}  // namespace

std::vector<std::string> assimp_extensions() { return {".dae", ".ply", ".gltf", ".glb"}; }

PolygonMesh read_assimp_bytes(std::string_view bytes, const std::string& extension,
                              const std::string& name) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(), aiProcess_ValidateDataStructure, extension.c_str());
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw InvalidInput(concat(name, ": cannot be read: ", importer.GetErrorString()));
  }
  PolygonMesh mesh;
  add_node(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    if (!vertex.allFinite()) {
      throw InvalidInput(concat(name, ": a coordinate is not finite"));
    }
  }
  if (mesh.polygons.empty()) {
    throw InvalidInput(concat(name, ": the file has no face; a solid is bounded by faces"));
  }
  return mesh;
}

}  // namespace hbar::scene
