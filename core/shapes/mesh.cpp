#include "core/meshes/repair.h"
#include "core/params/params.h"
#include "core/shapes/mesh_records.h"

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
    if (!fits(mesh, p)) return 0;
    left_out_ += drop_degenerate(mesh);
    drop_unused(mesh);
    if (p.has("crease_degrees")) smooth(mesh, crease, p);
    append(mesh);
    return static_cast<int>(table_.triangles.size() - before);
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
  static TriangleMesh read(Params& p, const MeshSource& source) {
    switch (p.form({{"positions", "indices"}, {"file"}, {"asset"}})) {
      case 0: return read_inline(p);
      case 1:
        return read_elsewhere(p, "file",
                              p.text("file",
                                     "OBJ, PLY, STL or glTF file in the scene's folder or below it; on the "
                                     "command line only.",
                                     kMostNameLength),
                              [&](const std::string& name) { return source.file(name); });
      default:
        return read_elsewhere(p, "asset",
                              p.text("asset", "SHA-256 of an uploaded OBJ, PLY, STL or glTF file.", 64),
                              [&](const std::string& name) { return source.asset(name); });
    }
  }

  // Limits are those of all meshes of a scene: many objects may name one file.
  bool fits(const TriangleMesh& mesh, Params& p) {
    vertices_ += mesh.positions.size();
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

  void append(const TriangleMesh& mesh) {
    Boundsd box;
    for (const Vec3d& v : mesh.positions) box.include(v);
    const auto first_vertex = static_cast<std::uint32_t>(table_.positions.size());
    if (!mesh.triangles.empty())
      table_.parts.push_back(
          {table_.triangles.size(),
           static_cast<std::ptrdiff_t>(table_.normals.size()) - static_cast<std::ptrdiff_t>(first_vertex),
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

  MeshTable<double> table_;
  std::size_t left_out_ = 0, vertices_ = 0, triangles_ = 0;  // as read
  std::uint64_t pairs_left_ = std::uint64_t{1} << 30;        // that smoothing may still compare
};

std::unique_ptr<ShapeSet> make_mesh_set() { return std::make_unique<MeshSet>(); }

}  // namespace

ShapeType mesh_type() {
  return {"mesh", "Triangles over shared vertices, watertight along shared edges.", make_mesh_set};
}

}  // namespace orrery
