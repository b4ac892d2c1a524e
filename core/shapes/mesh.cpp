#include <map>

#include "core/base/shorten.h"
#include "core/meshes/repair.h"
#include "core/model/tessellation.h"
#include "core/params/params.h"
#include "core/shapes/mesh_reader.h"
#include "core/shapes/mesh_records.h"
#include "core/shapes/moving_triangles.h"

namespace orrery {
namespace {

// Meshes of a scene or a model.
class MeshSet final : public ShapeSet {
 public:
  int add(Params& p, MeshSource& source) override {
    const std::size_t before = table_.triangles.size();
    MeshObject object = MeshReader(source).read(p);
    if (object.mesh.triangles.empty()) return 0;
    if (!(object.keys.empty() ? take_resting(object, p, source) : take_moving(object, p, source))) return 0;
    append(object.mesh);
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
  std::unique_ptr<MovingShapes> during(const Exposure& exposure) const override {
    if (moving_.empty()) return nullptr;
    std::vector<MovingTriangles> meshes;
    for (const auto& [part, moving] : moving_) {
      MovingTriangles& mesh = meshes.emplace_back(MovingTriangles{
          table_.parts[part].first, moving.keys.moments(exposure), {}, {}, moving.triangles, moving.uvs});
      for (const double time : mesh.moments) {
        mesh.positions.push_back(moving.keys.at(time).positions);
        mesh.normals.push_back(moving.corner_normals(time));
      }
    }
    return moving_triangles(std::move(meshes));
  }
  bool moves(int index) const override {
    return moving_.contains(part_number(static_cast<std::size_t>(index)));
  }
  int size() const override { return static_cast<int>(table_.triangles.size()); }
  std::size_t left_out() const override { return left_out_; }
  Boundsd bounds(int index) const override {
    return table_.corners(static_cast<std::size_t>(index)).bounds();
  }
  SweptBounds reach(int index) const override {
    const auto i = static_cast<std::size_t>(index);
    const auto& part = table_.part_of(i);
    const auto moving = moving_.find(part_number(i));
    if (moving == moving_.end()) return ShapeSet::reach(index);
    SweptBounds reach;
    for (const VertexKey& key : moving->second.keys.values) {
      const auto& [a, b, c] = moving->second.triangles[i - part.first];
      const std::vector<Vec3d>& at = *key.positions;
      const Boundsd box = Boundsd::of({at[a], at[b], at[c]});
      reach.box.include(box);
      reach.min_diagonal = std::min(reach.min_diagonal, box.diagonal());
    }
    return reach;
  }
  ShapeTraits traits() const override {
    const bool smooth =
        std::any_of(table_.parts.begin(), table_.parts.end(), [](const auto& part) { return part.smooth; }) ||
        std::any_of(moving_.begin(), moving_.end(),
                    [](const auto& part) { return part.second.crease_degrees.has_value(); });
    return {.convex = false, .closed = false, .smooth = smooth};
  }
  Shell shell(int index) const override {
    const std::size_t part = part_number(static_cast<std::size_t>(index));
    const TriangleMesh mesh = mesh_of(part);
    return {static_cast<int>(table_.parts[part].first + mesh.triangles.size()),
            is_watertight(mesh.triangles, position_indices_of(mesh.positions))};
  }
  std::optional<Patch> patch(int index) const override {
    return patch_of(table_.corners(static_cast<std::size_t>(index)));
  }
  void tessellate(const TessellationView&, int first, Tessellation& out) const override {
    const bool no_normals = table_.normals.empty();
    if (out.may_refer && (no_normals || table_.normals.size() == table_.positions.size())) {
      out.meshes.push_back({table_.positions, table_.normals, table_.triangles, first, out.triangles.size()});
      return;
    }
    const auto first_vertex = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.reserve(out.vertices.size() + table_.positions.size());
    for (const Vec3d& position : table_.positions) out.add(position);
    for (const auto& part : table_.parts) {
      if (!part.smooth) continue;
      const std::size_t end = part.first_normal + vertices_of(part);
      for (std::size_t i = part.first_normal; i < end; ++i)
        out.vertices[first_vertex + part.first_vertex + i - part.first_normal].normal = table_.normals[i];
    }
    out.triangles.reserve(out.triangles.size() + table_.triangles.size());
    for (std::size_t i = 0; i < table_.triangles.size(); ++i) {
      checkpoint(i);
      const auto& [a, b, c] = table_.triangles[i];
      out.add(first + static_cast<int>(i), first_vertex + a, first_vertex + b, first_vertex + c);
    }
  }
  ShapeKernelPtr<float> kernel(float, int first) const override { return make<float>(first); }
  ShapeKernelPtr<double> kernel(double, int first) const override { return make<double>(first); }
  ShapeKernelPtr<long double> kernel(long double, int first) const override {
    return make<long double>(first);
  }

 private:
  // Maximum number of triangle pairs that smoothing compares in a scene.
  static constexpr std::uint64_t kMaxPairs = std::uint64_t{1} << 30;
  // MovingMesh::max_pairs / number of triangle pairs around vertices that coincide at all keys.
  static constexpr std::uint64_t kMaxPairGrowth = 16;

  std::size_t part_number(std::size_t triangle) const {
    return static_cast<std::size_t>(&table_.part_of(triangle) - table_.parts.data());
  }

  // Prepares a static mesh: removes degenerate triangles and unused vertices, and smooths the normals if a
  // crease angle is set. Returns false and records a problem in `p` if smoothing exceeds kMaxPairs.
  bool take_resting(MeshObject& object, Params& p, MeshSource& source) {
    left_out_ += drop_degenerate(object.mesh);
    drop_unused(object.mesh);
    if (!object.crease_degrees) return true;
    const PositionIndices places = position_indices_of(object.mesh.positions);
    if (!may_compare(count_pairs(object.mesh, places), p, source)) return false;
    smooth_normals(object.mesh, *object.crease_degrees, places);
    return true;
  }
  // Stores the motion of a mesh. Returns false and records a problem in `p` if smoothing may exceed
  // kMaxPairs.
  bool take_moving(MeshObject& object, Params& p, MeshSource& source) {
    MovingMesh moving{
        object.mesh.triangles, object.mesh.uvs, std::move(object.keys), object.crease_degrees, {}, 0};
    if (object.crease_degrees) {
      moving.always = position_indices_of(*moving.keys.values[0].positions);
      for (const VertexKey& key : moving.keys.values) split_position_indices(moving.always, *key.positions);
      moving.max_pairs = kMaxPairGrowth * count_pairs(object.mesh, moving.always);
      if (!may_compare(moving.max_pairs, p, source)) return false;
    }
    moving_.emplace(table_.parts.size(), std::move(moving));
    return true;
  }

  // Adds `pairs` to the number of triangle pairs that smoothing compares in this scene. Returns false and
  // records a problem in `p` if the sum exceeds kMaxPairs.
  static bool may_compare(std::uint64_t pairs, Params& p, MeshSource& source) {
    source.pairs += pairs;
    if (source.pairs <= kMaxPairs) return true;
    p.fail("crease_degrees", "smoothing compares " + grouped(source.pairs) +
                                 " pairs of triangles that share a vertex (limit " + grouped(kMaxPairs) +
                                 " pairs per scene)");
    return false;
  }

  using Part = MeshTable<double>::Part;
  std::size_t vertices_of(const Part& part) const {
    const Part* const next = &part + 1;
    const bool last = next == table_.parts.data() + table_.parts.size();
    return (last ? table_.positions.size() : next->first_vertex) - part.first_vertex;
  }
  TriangleMesh mesh_of(std::size_t part) const {
    const Part& from = table_.parts[part];
    TriangleMesh mesh;
    copy(table_.positions, from.first_vertex, from.first_vertex + vertices_of(from), mesh.positions);
    if (from.smooth)
      copy(table_.normals, from.first_normal, from.first_normal + mesh.positions.size(), mesh.normals);
    if (from.mapped) copy(table_.uvs, from.first_uv, from.first_uv + mesh.positions.size(), mesh.uvs);
    if (from.colored)
      copy(table_.colors, from.first_color, from.first_color + mesh.positions.size(), mesh.colors);
    copy(table_.triangles, from.first,
         part + 1 < table_.parts.size() ? table_.parts[part + 1].first : table_.triangles.size(),
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
    Boundsd box;  // bounds of the vertices that triangles use
    const auto first_vertex = static_cast<std::uint32_t>(table_.positions.size());
    const std::size_t first = table_.triangles.size();
    for (const auto& [a, b, c] : mesh.triangles) {
      for (const std::uint32_t vertex : {a, b, c}) box.include(mesh.positions[vertex]);
      table_.triangles.push_back({a + first_vertex, b + first_vertex, c + first_vertex});
    }
    table_.parts.push_back({first, first_vertex, table_.normals.size(), table_.uvs.size(),
                            table_.colors.size(), !mesh.normals.empty(), !mesh.uvs.empty(),
                            !mesh.colors.empty(), box.magnitude()});
    table_.positions.insert(table_.positions.end(), mesh.positions.begin(), mesh.positions.end());
    table_.normals.insert(table_.normals.end(), mesh.normals.begin(), mesh.normals.end());
    table_.uvs.insert(table_.uvs.end(), mesh.uvs.begin(), mesh.uvs.end());
    table_.colors.insert(table_.colors.end(), mesh.colors.begin(), mesh.colors.end());
  }

  template <class T>
  ShapeKernelPtr<T> make(int first) const {
    return std::make_shared<PrimitiveKernel<MeshTriangle, T, MeshRecords<T>>>(MeshRecords<T>(table_), first);
  }

  MeshTable<double> table_;                   // at rest; normals of moving meshes are not smoothed
  std::map<std::size_t, MovingMesh> moving_;  // by index in table_.parts
  std::size_t left_out_ = 0;
};

std::unique_ptr<ShapeSet> make_mesh_set() { return std::make_unique<MeshSet>(); }

}  // namespace

ShapeType mesh_type() {
  return {"mesh", "A triangle mesh with shared vertices, watertight along shared edges.", make_mesh_set};
}

}  // namespace orrery
