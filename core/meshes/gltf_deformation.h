#pragma once

#include <optional>
#include <vector>

#include "core/math/affine.h"
#include "core/meshes/gltf_file.h"

namespace orrery {

// Transforms of the joints of a skin from mesh coordinates to world coordinates.
using JointTransforms = std::vector<Affined>;

// Returns the joint transforms of a skin (glTF 2.0, 3.7.3.1): the inverse bind matrix, then the transform of
// the joint's node. `world_of` returns the transform of the node whose index is its argument. Throws
// InputError if the skin is invalid.
template <class WorldOf>
JointTransforms joint_transforms(GltfFile& file, const GltfValue& skin, const WorldOf& world_of);

// Returns the affine map of element `i` of an accessor of type MAT4.
Affined affine_of(const GltfNumbers& matrices, std::size_t i, const GltfValue& place);

// Pose of a mesh.
struct MeshPose {
  Affined world_from_node;
  std::vector<double> weights;              // one per morph target; missing weights are 0
  const JointTransforms* joints = nullptr;  // null: the mesh has no skin
};

// Moves the vertices of a primitive to world coordinates: first by its morph targets (3.7.2.2), then by its
// skin or the transform of its node. The transform of a skinned node is ignored. Must not outlive the file.
class VertexPlacer {
 public:
  // `count`: number of vertices. Throws InputError if targets, joints or weights are invalid.
  VertexPlacer(GltfFile& file, const GltfValue& primitive, std::size_t count, const MeshPose& pose);

  Vec3d position(std::size_t vertex, const Vec3d& stored) const;
  Vec3d normal(std::size_t vertex, const Vec3d& stored) const;  // not normalized
  // Returns true if the first vertex is mirrored.
  bool mirrors() const { return scaled_determinant(map_at(0)) < 0; }

 private:
  struct Target {
    double weight;
    std::optional<GltfNumbers> positions, normals;
  };
  struct Influences {
    GltfNumbers joints, weights;
  };

  void read_targets(GltfFile& file, const GltfValue& targets, std::size_t count);
  void read_influences(GltfFile& file, const GltfValue& attributes, std::size_t count);
  // Returns the map of a vertex from mesh coordinates to world coordinates.
  Affined map_at(std::size_t vertex) const;

  const MeshPose& pose_;
  std::vector<Target> targets_;
  std::vector<Influences> influences_;
};

template <class WorldOf>
JointTransforms joint_transforms(GltfFile& file, const GltfValue& skin, const WorldOf& world_of) {
  const GltfValue joints = skin.at("joints");
  const auto inverse_bind = skin.find("inverseBindMatrices");
  std::optional<GltfNumbers> matrices;
  if (inverse_bind) matrices = file.accessor(*inverse_bind, "MAT4");
  if (matrices && matrices->count < joints.size())
    inverse_bind->fail("must have " + std::to_string(joints.size()) + " matrices, one per joint (got " +
                       std::to_string(matrices->count) + ")");
  JointTransforms transforms;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Affined world = world_of(joints.item(i));
    transforms.push_back(matrices ? compose(world, affine_of(*matrices, i, *inverse_bind)) : world);
  }
  return transforms;
}

}  // namespace orrery
