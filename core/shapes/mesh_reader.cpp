#include "core/shapes/mesh_reader.h"

#include "core/base/shorten.h"
#include "core/model/asset_reader.h"
#include "core/params/motion.h"

namespace orrery {
namespace {

constexpr MeshLimits kLimits;

std::string entries_text(std::size_t count, const char* why, std::size_t got) {
  return "must be a list of " + std::to_string(count) + " entries, " + why + " (got " + std::to_string(got) +
         ")";
}

// Reads a mesh from the keys of the object. Even after recorded problems, the mesh has valid indices, one
// normal per vertex or no normals, and one uv per vertex or no uvs.
TriangleMesh read_inline(Params& p) {
  TriangleMesh mesh;
  mesh.positions = p.points("positions", "Vertices, in metres.", {3, kLimits.vertices});
  const auto bound = static_cast<std::int64_t>(mesh.positions.size());
  const auto triples =
      p.index_triples("indices", "Vertices of each triangle, anticlockwise as seen from the front.",
                      {1, kLimits.triangles}, bound);
  mesh.normals =
      p.directions("normals", "Shading normal of each vertex; default: flat shading.", {0, kLimits.vertices});
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size()) {
    p.fail("normals", entries_text(mesh.positions.size(), "one per position", mesh.normals.size()));
    mesh.normals.clear();
  }
  mesh.uvs =
      p.pairs("uvs", "Texture coordinates (u, v) of each vertex; (0, 0) is the lower left of the image.",
              {0, kLimits.vertices});
  if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size()) {
    p.fail("uvs", entries_text(mesh.positions.size(), "one per position", mesh.uvs.size()));
    mesh.uvs.clear();
  }
  mesh.colors = p.points("colors", "Colour of each vertex, linear, 0 to 1; textures may use it.",
                         {0, kLimits.vertices});
  if (!mesh.colors.empty() && mesh.colors.size() != mesh.positions.size()) {
    p.fail("colors", entries_text(mesh.positions.size(), "one per position", mesh.colors.size()));
    mesh.colors.clear();
  }
  for (const Vec3d& color : mesh.colors)
    if (!(std::min({color.x, color.y, color.z}) >= 0 && max_component(color) <= 1)) {
      p.fail("colors", "must be from 0 to 1");
      mesh.colors.clear();
      break;
    }
  for (const auto& triple : triples) {
    if (std::max({triple[0], triple[1], triple[2]}) >= bound) return {};  // reported by index_triples()
    mesh.triangles.push_back({static_cast<std::uint32_t>(triple[0]), static_cast<std::uint32_t>(triple[1]),
                              static_cast<std::uint32_t>(triple[2])});
  }
  return mesh;
}

// Materials and animations of a file have smaller numbers.
constexpr std::int64_t kMaxPart = 1'000'000;
constexpr double kMaxPoseTime = 1e6;  // seconds

TriangleMesh part_or_whole(const MeshModel& model, std::optional<int> part) {
  if (!part) return whole_of(model.mesh);
  TriangleMesh mesh = part_of(model.mesh, *part);
  if (mesh.triangles.empty())
    throw InputError("", "must have triangles of material " + std::to_string(*part) + ", as \"part\" states");
  return mesh;
}

// Reads a mesh from the file `name`: see read_named(). Rejects coordinates above kMaxCoordinate, too.
template <class Read>
TriangleMesh read_elsewhere(Params& p, const char* key, const std::string& name, std::optional<int> part,
                            const Read& read) {
  return read_named(p, key, name, [&](const std::string& n) {
    TriangleMesh mesh = part_or_whole(*read(n), part);
    for (const Vec3d& v : mesh.positions)
      if (!(max_component(abs(v)) <= kMaxCoordinate))
        throw InputError("", "coordinates must be at most 1e12 m in magnitude (got " +
                                 number_text(max_component(abs(v))) + ")");
    return mesh;
  });
}

std::string file_name(Params& p, const char* fallback = nullptr) {
  return p.text("file", "OBJ, PLY, STL, 3MF or glTF file in or below the scene's folder; command line only.",
                kMostNameLength, fallback);
}
std::string asset_name(Params& p, const char* fallback = nullptr) {
  return p.text("asset", "SHA-256 of an uploaded OBJ, PLY, STL, 3MF or glTF file.", 64, fallback);
}
// Triangles of a file, and the state of its model.
struct Selection {
  std::optional<int> part;
  ModelState state;
};

std::optional<int> read_part(Params& p) {
  const std::int64_t part = p.integer("part",
                                      "Number of a material of the file whose triangles to read, from 0; -1: "
                                      "triangles without a material; default: all triangles.",
                                      -1, kMaxPart, derived(std::int64_t{-1}));
  return p.has("part") ? std::optional(static_cast<int>(part)) : std::nullopt;
}
std::optional<ModelPose> read_pose(Params& p) {
  const double time = p.number("pose_time",
                               "Time of the pose of an animated glTF model, in seconds from the start of the "
                               "animation; default: the pose at rest.",
                               {.min = -kMaxPoseTime, .max = kMaxPoseTime}, derived(0.0));
  const std::int64_t animation = p.integer(
      "animation", "Number of the animation in the file, from 0; requires pose_time.", 0, kMaxPart, 0);
  if (p.has("animation") && !p.has("pose_time")) p.fail("animation", "must not be given without pose_time");
  return p.has("pose_time") ? std::optional(ModelPose{static_cast<int>(animation), time}) : std::nullopt;
}
std::string read_variant(Params& p) {
  return p.text("variant",
                "Name of a variant of the materials of a glTF model; default: the materials of the file.",
                kMostNameLength, "");
}
Selection read_selection(Params& p) {
  const std::optional<int> part = read_part(p);
  std::optional<ModelPose> pose = read_pose(p);
  return {part, {std::move(pose), read_variant(p)}};
}

TriangleMesh read_file(Params& p, const AssetSource& source, const std::string& name,
                       const Selection& selection) {
  return read_elsewhere(p, "file", name, selection.part,
                        [&](const std::string& n) { return source.model_file(n, selection.state); });
}
TriangleMesh read_asset(Params& p, const AssetSource& source, const std::string& name,
                        const Selection& selection) {
  return read_elsewhere(p, "asset", name, selection.part,
                        [&](const std::string& n) { return source.model_asset(n, selection.state); });
}

SharedVectors share(std::vector<Vec3d> vectors) {
  return std::make_shared<const std::vector<Vec3d>>(std::move(vectors));
}

}  // namespace

MeshObject MeshReader::read(Params& p) {
  MeshObject object;
  TriangleMesh& mesh = object.mesh;
  switch (p.form({{"positions", "indices"}, {"file"}, {"asset"}})) {
    case 0: mesh = read_inline(p); break;
    case 1: {
      const std::string name = file_name(p);
      mesh = read_file(p, source_.assets, name, read_selection(p));
      break;
    }
    default: {
      const std::string name = asset_name(p);
      mesh = read_asset(p, source_.assets, name, read_selection(p));
    }
  }
  const double crease =
      p.number("crease_degrees",
               "Smooth shading between faces whose normals differ by less than this angle, in degrees; "
               "default: the normals of the mesh.",
               {.min = 0, .max = 180}, derived(0.0));
  if (p.has("crease_degrees")) object.crease_degrees = crease;
  if (!fits(mesh.positions.size(), mesh.triangles.size(), p)) mesh = {};
  const VertexKey at_rest =
      p.has("motion") ? VertexKey{share(mesh.positions), share(mesh.normals)} : VertexKey();
  object.keys = read_motion(p, [&](Params& key) { return read_key(key, mesh, at_rest); });
  if (source_.full) object = {};
  return object;
}

// Reads one keyframe. If the keyframe omits positions or normals, or has a wrong number of them, returns the
// vectors of `at_rest`.
VertexKey MeshReader::read_key(Params& p, const TriangleMesh& rest, const VertexKey& at_rest) {
  std::vector<Vec3d> positions =
      p.points("positions", "Vertices, in metres; the same number as in the mesh.", {0, kLimits.vertices});
  std::vector<Vec3d> normals = p.directions(
      "normals", "Shading normal of each vertex, if the mesh has normals.", {0, kLimits.vertices});
  const std::string file = file_name(p, ""), asset = asset_name(p, "");
  const Selection selection = read_selection(p);
  if (p.has("positions") + p.has("file") + p.has("asset") > 1)
    p.fail("", "must have at most one of positions, file and asset");
  if (!fits(rest.positions.size(), rest.triangles.size(), p)) return at_rest;
  if (p.has("file") || p.has("asset")) {
    TriangleMesh mesh = p.has("file") ? read_file(p, source_.assets, file, selection)
                                      : read_asset(p, source_.assets, asset, selection);
    if (mesh.triangles != rest.triangles)
      p.fail("", "must have the same " + std::to_string(rest.triangles.size()) +
                     " triangles with the same vertex indices as the mesh without motion (got " +
                     std::to_string(mesh.triangles.size()) + " triangles)");
    positions = std::move(mesh.positions);
    if (!rest.normals.empty() && normals.empty()) normals = std::move(mesh.normals);
  }
  const auto taken = [&](const char* what, std::vector<Vec3d>& given, std::size_t count,
                         const SharedVectors& resting) {
    if (given.empty()) return resting;
    if (given.size() == count) return share(std::move(given));
    p.fail(what, entries_text(count, "as in the mesh without motion", given.size()));
    return resting;
  };
  return {taken("positions", positions, rest.positions.size(), at_rest.positions),
          taken("normals", normals, rest.normals.size(), at_rest.normals)};
}

bool MeshReader::fits(std::size_t vertices, std::size_t triangles, Params& p) {
  if (source_.full) return false;
  source_.vertices += vertices;
  source_.triangles += triangles;
  source_.full = source_.vertices > kLimits.vertices || source_.triangles > kLimits.triangles;
  if (source_.full)
    p.fail("", "meshes of the scene and their keyframes have at least " + grouped(source_.vertices) +
                   " vertices (limit " + grouped(kLimits.vertices) + ", mesh_vertices) and " +
                   grouped(source_.triangles) + " triangles (limit " + grouped(kLimits.triangles) +
                   ", mesh_triangles)");
  return !source_.full;
}

}  // namespace orrery
