#include <map>

#include "core/meshes/repair.h"
#include "core/params/motion.h"
#include "core/shapes/mesh_records.h"
#include "core/shapes/moving_mesh.h"

namespace orrery {
namespace {

constexpr MeshLimits kLimits;
constexpr std::size_t kMostNameLength = 1024;

TriangleMesh read_inline(Params& p) {
  TriangleMesh mesh;
  mesh.positions = p.points("positions", "Vertices, in metres.", {3, kLimits.vertices});
  const auto bound = static_cast<std::int64_t>(mesh.positions.size());
  const auto triples = p.index_triples("indices", "Vertices of each triangle, anticlockwise from the front.",
                                       {1, kLimits.triangles}, bound);
  mesh.normals =
      p.directions("normals", "Direction to shade with at each vertex; left out, triangles are flat.",
                   {0, kLimits.vertices});
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
    p.fail("normals", "expected as many as positions (" + std::to_string(mesh.positions.size()) + "), got " +
                          std::to_string(mesh.normals.size()));
  for (const auto& triple : triples) {
    if (std::max({triple[0], triple[1], triple[2]}) >= bound) return {};  // reported already
    mesh.triangles.push_back({static_cast<std::uint32_t>(triple[0]), static_cast<std::uint32_t>(triple[1]),
                              static_cast<std::uint32_t>(triple[2])});
  }
  return mesh;
}

// What `read` gives; its errors become those of `key`.
template <class Read>
TriangleMesh read_elsewhere(Params& p, const char* key, const std::string& name, const Read& read) {
  if (name.empty()) {
    p.fail(key, "expected a name, got \"\"");
    return {};
  }
  try {
    TriangleMesh mesh = read(name);
    for (const Vec3d& v : mesh.positions)
      if (!(max_component(abs(v)) <= kMaxCoordinate))
        throw InputError("", "expected coordinates of at most 1e12 metres");
    return mesh;
  } catch (const InputError& error) {
    p.fail(key, error.problems().front().detail);
    return {};
  }
}

TriangleMesh read_file(Params& p, const MeshSource& source, const char* fallback = nullptr) {
  const std::string name = p.text(
      "file", "OBJ, PLY, STL or glTF file in the scene's folder or below it; on the command line only.",
      kMostNameLength, fallback);
  if (!p.has("file")) return {};
  return read_elsewhere(p, "file", name, [&](const std::string& n) { return source.file(n); });
}

TriangleMesh read_asset(Params& p, const MeshSource& source, const char* fallback = nullptr) {
  const std::string name =
      p.text("asset", "SHA-256 of an uploaded OBJ, PLY, STL or glTF file.", 64, fallback);
  if (!p.has("asset")) return {};
  return read_elsewhere(p, "asset", name, [&](const std::string& n) { return source.asset(n); });
}

TriangleMesh read(Params& p, const MeshSource& source) {
  switch (p.form({{"positions", "indices"}, {"file"}, {"asset"}})) {
    case 0: return read_inline(p);
    case 1: return read_file(p, source);
    default: return read_asset(p, source);
  }
}

// Where the vertices of the mesh are at one time.
VertexKey read_key(Params& p, const MeshSource& source, const TriangleMesh& rest) {
  VertexKey key{p.points("positions", "Vertices, as many as the mesh has.", {0, kLimits.vertices}),
                p.directions("normals", "Direction to shade with at each vertex, if the mesh has such.",
                             {0, kLimits.vertices})};
  for (TriangleMesh& mesh : std::array{read_file(p, source, ""), read_asset(p, source, "")}) {
    if (mesh.positions.empty()) continue;
    if (!key.positions.empty())
      p.fail("", "expected one of positions, file and asset");
    else if (mesh.triangles != rest.triangles)
      p.fail("", "expected the triangles that the mesh has without motion");
    key.positions = std::move(mesh.positions);
    if (!rest.normals.empty() && key.normals.empty()) key.normals = std::move(mesh.normals);
  }
  if (key.positions.empty()) key.positions = rest.positions;
  if (key.normals.empty()) key.normals = rest.normals;
  const auto expect = [&](const char* what, std::size_t count, std::size_t expected) {
    if (count != expected)
      p.fail(what, "expected as many as the mesh has without motion (" + std::to_string(expected) +
                       "), got " + std::to_string(count));
  };
  expect("positions", key.positions.size(), rest.positions.size());
  expect("normals", key.normals.size(), rest.normals.size());
  return key;
}

// All meshes of a scene.
class MeshSet final : public ShapeSet {
 public:
  int add(Params& p, const MeshSource& source) override {
    const std::size_t before = table_.triangles.size();
    TriangleMesh mesh = read(p, source);
    const double crease = p.number("crease_degrees",
                                   "Shading is smooth across edges where faces meet at less than this angle; "
                                   "left out, the normals are those of the mesh.",
                                   {.min = 0, .max = 180}, derived(0.0));
    MovingMesh moving{{}, read_motion(p, [&](Params& key) { return read_key(key, source, mesh); }), {}};
    if (!fits(mesh, moving.keys.times.size(), p)) return 0;
    if (p.has("crease_degrees")) moving.crease = crease;
    if (moving.keys.empty()) {
      left_out_ += drop_degenerate(mesh);
      drop_unused(mesh);
    } else if (!mesh.triangles.empty()) {
      moving.triangles = mesh.triangles;
      moving_.emplace(table_.parts.size(), std::move(moving));
    }
    if (p.has("crease_degrees")) smooth(mesh, crease, p);
    append(mesh);
    return static_cast<int>(table_.triangles.size() - before);
  }
  std::vector<double> key_times() const override {
    std::vector<double> times;
    for (const auto& [part, moving] : moving_)
      times.insert(times.end(), moving.keys.times.begin(), moving.keys.times.end());
    return times;
  }
  std::unique_ptr<ShapeSet> at(double time) const override {
    if (moving_.empty()) return nullptr;
    auto posed = std::make_unique<MeshSet>();
    for (std::size_t part = 0; part < table_.parts.size(); ++part) {
      const auto moving = moving_.find(part);
      posed->append(moving != moving_.end() ? moving->second.at(time) : mesh_of(part));
    }
    return posed;
  }
  int size() const override { return static_cast<int>(table_.triangles.size()); }
  std::size_t left_out() const override { return left_out_; }
  Boundsd bounds(int index) const override {
    return table_.corners(static_cast<std::size_t>(index)).bounds();
  }
  ShapeTraits traits() const override { return {.convex = false, .closed = false}; }
  ShapeKernelPtr<float> kernel(float, int first) const override { return make<float>(first); }
  ShapeKernelPtr<double> kernel(double, int first) const override { return make<double>(first); }
  ShapeKernelPtr<long double> kernel(long double, int first) const override {
    return make<long double>(first);
  }

 private:
  // Limits are those of all meshes of a scene: many objects may name one file.
  bool fits(const TriangleMesh& mesh, std::size_t keys, Params& p) {
    vertices_ += mesh.positions.size() * (1 + keys);
    triangles_ += mesh.triangles.size();
    if (vertices_ <= kLimits.vertices && triangles_ <= kLimits.triangles) return true;
    p.fail("", "expected at most " + std::to_string(kLimits.vertices) + " vertices (mesh_vertices) and " +
                   std::to_string(kLimits.triangles) +
                   " triangles (mesh_triangles) in all meshes of a scene, got " + std::to_string(vertices_) +
                   " and " + std::to_string(triangles_) + " with this one");
    return false;
  }

  void smooth(TriangleMesh& mesh, double crease, Params& p) {
    try {
      pairs_left_ -= smooth_normals(mesh, crease, pairs_left_);
    } catch (const InputError& error) {
      p.fail("crease_degrees", error.problems().front().detail);
    }
  }

  TriangleMesh mesh_of(std::size_t part) const {
    const auto end_of = [&](const auto& list, auto begin_of) {
      return part + 1 < table_.parts.size() ? begin_of(table_.parts[part + 1]) : list.size();
    };
    const auto& from = table_.parts[part];
    TriangleMesh mesh;
    copy(table_.positions, from.first_vertex,
         end_of(table_.positions, [](const auto& p) { return p.first_vertex; }), mesh.positions);
    if (from.smooth)
      copy(table_.normals, from.first_normal, from.first_normal + mesh.positions.size(), mesh.normals);
    copy(table_.triangles, from.first, end_of(table_.triangles, [](const auto& p) { return p.first; }),
         mesh.triangles);
    for (auto& triangle : mesh.triangles)
      for (std::uint32_t& vertex : triangle) vertex -= static_cast<std::uint32_t>(from.first_vertex);
    return mesh;
  }
  template <class V>
  static void copy(const std::vector<V>& from, std::size_t begin, std::size_t end, std::vector<V>& to) {
    to.assign(from.begin() + static_cast<std::ptrdiff_t>(begin),
              from.begin() + static_cast<std::ptrdiff_t>(end));
  }

  void append(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) return;
    Boundsd box;
    for (const Vec3d& v : mesh.positions) box.include(v);
    const auto first_vertex = static_cast<std::uint32_t>(table_.positions.size());
    table_.parts.push_back({table_.triangles.size(), first_vertex, table_.normals.size(),
                            !mesh.normals.empty(), box.magnitude()});
    table_.positions.insert(table_.positions.end(), mesh.positions.begin(), mesh.positions.end());
    table_.normals.insert(table_.normals.end(), mesh.normals.begin(), mesh.normals.end());
    for (const auto& [a, b, c] : mesh.triangles)
      table_.triangles.push_back({a + first_vertex, b + first_vertex, c + first_vertex});
  }

  template <class T>
  ShapeKernelPtr<T> make(int first) const {
    return std::make_unique<PrimitiveKernel<MeshTriangle, T, MeshRecords<T>>>(MeshRecords<T>(table_), first);
  }

  MeshTable<double> table_;                                  // as if nothing moved
  std::map<std::size_t, MovingMesh> moving_;                 // by part
  std::size_t left_out_ = 0, vertices_ = 0, triangles_ = 0;  // as read
  std::uint64_t pairs_left_ = std::uint64_t{1} << 30;        // that smoothing may still compare
};

std::unique_ptr<ShapeSet> make_mesh_set() { return std::make_unique<MeshSet>(); }

}  // namespace

ShapeType mesh_type() {
  return {"mesh", "Triangles over shared vertices, watertight along shared edges.", make_mesh_set};
}

}  // namespace orrery
