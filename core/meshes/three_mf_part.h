#pragma once

#include <map>

#include "core/math/affine.h"
#include "core/meshes/model.h"
#include "core/meshes/xml_file.h"

namespace orrery {

// Placed object: a component of an object, or an item to build.
struct ThreeMfComponent {
  std::uint32_t object;  // id in its part
  std::string path;      // part in the package, or empty for the same part
  Affined parent_from_object;
};

struct ThreeMfMesh {
  std::vector<Vec3d> positions;
  std::vector<std::uint32_t> colors;  // by position: index into ThreeMfContents::colors; empty if all are 0
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<MeshPart>
      parts;  // by ascending triangle; materials are indices into ThreeMfContents::materials
};

struct ThreeMfObject {
  std::vector<ThreeMfMesh> meshes;  // with at least one triangle each
  std::vector<ThreeMfComponent> components;
};

// Model part of a package.
struct ThreeMfPart {
  std::string unit;
  std::map<std::uint32_t, ThreeMfObject> objects;  // by id
  std::vector<ThreeMfComponent> items;             // content of "build"
};

// Contents that the parts of a package share.
struct ThreeMfContents {
  std::vector<ModelMaterial> materials;
  std::vector<Vec3d> colors{Vec3d(1)};            // linear; the first one stands for no colour
  std::map<std::string, std::size_t> unmodelled;  // elements that are not modelled, by name
  std::size_t vertices = 0, triangles = 0;        // in the objects of all parts
};

// Reads a model part (3MF Core Specification 1.3, sections 3 to 5; Materials and Properties Extension 1.2,
// section 2; Production Extension 1.1). Throws InputError with the place, and Cancelled.
ThreeMfPart read_three_mf_part(const XmlFile& file, const MeshLimits& limits, ThreeMfContents& contents);

}  // namespace orrery
