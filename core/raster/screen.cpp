#include "core/raster/screen.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/cameras/pixel_filter.h"
#include "core/model/technique.h"
#include "core/model/tile.h"
#include "core/raster/chunk_builder.h"
#include "core/raster/tessellate.h"

namespace orrery {
namespace {

SampleRange sample_range(const Plan& plan) {
  if (plan.samples == 1) return {kSubpixels / 2, kSubpixels / 2};
  const double half =
      plan.filtered ? double{PixelFilter(*plan.asked.filter, *plan.asked.filter_width).half_width()} : 0.5;
  return {static_cast<int>(std::floor((0.5 - half) * kSubpixels)) - 1,  // samples are rounded down
          static_cast<int>(std::ceil((0.5 + half) * kSubpixels))};
}

// Fills Screen::blocks.
void find_blocks(Screen& screen) {
  const Tessellation& surfaces = screen.surfaces;
  std::size_t first = 0, own = 0, first_vertex = surfaces.vertices.size();
  const auto add = [&](Screen::Block block, std::size_t size) {
    block.first = static_cast<std::uint32_t>(first);
    block.size = static_cast<std::uint32_t>(size);
    screen.blocks.push_back(block);
    first += (size + Screen::kChunk - 1) / Screen::kChunk * Screen::kChunk;
  };
  const auto add_own = [&](std::size_t end) {
    if (own == end) return;
    const Tessellation::Triangle& triangle = surfaces.triangles[own];
    const Tessellation::Vertex& vertex = surfaces.vertices[0];
    add({.corners = {&triangle.vertices, sizeof triangle},
         .positions = {&vertex.position, sizeof vertex},
         .normals = {&vertex.normal, sizeof vertex},
         .primitives = {&triangle.primitive, sizeof triangle}},
        end - own);
    own = end;
  };
  for (const Tessellation::Mesh& mesh : surfaces.meshes) {
    add_own(mesh.before);
    add({.first_vertex = first_vertex,
         .corners = {mesh.triangles.data()},
         .positions = {mesh.positions.data()},
         .normals = {mesh.normals.empty() ? nullptr : mesh.normals.data()},
         .first_primitive = mesh.first_primitive},
        mesh.triangles.size());
    first_vertex += mesh.positions.size();
  }
  add_own(surfaces.triangles.size());
  screen.vertex_count = first_vertex;
}

void project_vertices(const Projector& projector, Screen& screen) {
  screen.vertices = std::make_unique_for_overwrite<ScreenVertex[]>(screen.vertex_count);
  const auto project = [&](const Strided<Vec3d>& positions, std::size_t count, ScreenVertex* to) {
    parallel_for_each((count + Screen::kChunk - 1) / Screen::kChunk, 1, [&](std::size_t c) {
      projector.project(positions, c * Screen::kChunk, std::min((c + 1) * Screen::kChunk, count), to);
    });
  };
  const Tessellation& surfaces = screen.surfaces;
  ScreenVertex* to = screen.vertices.get();
  if (!surfaces.vertices.empty())
    project({&surfaces.vertices[0].position, sizeof surfaces.vertices[0]}, surfaces.vertices.size(), to);
  to += surfaces.vertices.size();
  for (const Tessellation::Mesh& mesh : surfaces.meshes) {
    project({mesh.positions.data()}, mesh.positions.size(), to);
    to += mesh.positions.size();
  }
}

}  // namespace

const Screen::ClippedPart& Screen::clipped(Number number) const {
  const auto& parts = chunks[number / kParts / kChunk].clipped;
  return *std::lower_bound(parts.begin(), parts.end(), number,
                           [](const ClippedPart& part, Number n) { return part.number < n; });
}

std::size_t Screen::bytes() const {
  const auto size = [](const auto& list) { return list.size() * sizeof list[0]; };
  std::size_t sum = size(surfaces.vertices) + size(surfaces.triangles) + vertex_count * sizeof vertices[0];
  for (const Chunk& chunk : chunks)
    sum += size(chunk.clipped) + size(chunk.triangles.elements) + size(chunk.triangles.first) +
           size(chunk.fragments.elements) + size(chunk.fragments.first);
  return sum;
}

std::shared_ptr<const Screen> make_screen(std::shared_ptr<const Scene> scene, const Plan& plan) {
  auto screen = std::make_shared<Screen>();
  screen->surfaces = tessellate(*scene, plan, kMaxScreenTriangles);
  screen->scene = std::move(scene);
  screen->parallel = plan.camera->parallel();
  screen->centred = plan.samples == 1;
  screen->tiles_across = (plan.width + kTileSide - 1) / kTileSide;
  const SampleRange samples = sample_range(plan);
  const Projector projector(plan, samples);
  find_blocks(*screen);
  project_vertices(projector, *screen);
  for (const Screen::Block& block : screen->blocks)
    for (std::size_t i = 0; i < block.size; i += Screen::kChunk) screen->chunks.push_back({.block = &block});
  parallel_for_each(screen->chunks.size(), 1, [&](std::size_t c) {
    Screen::Chunk& chunk = screen->chunks[c];
    const auto begin = static_cast<std::uint32_t>(c * Screen::kChunk);
    const std::uint32_t end =
        std::min(begin + static_cast<std::uint32_t>(Screen::kChunk), chunk.block->first + chunk.block->size);
    ChunkBuilder(*screen, projector, plan, samples).build(begin, end, chunk);
  });
  return screen;
}

}  // namespace orrery
