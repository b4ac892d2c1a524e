#include "core/raster/tessellate.h"

#include "core/base/error.h"
#include "core/base/shorten.h"
#include "core/base/task_scope.h"

namespace orrery {
namespace {

TessellationView view_of(const Plan& plan) {
  const CameraFrame& frame = plan.frame;
  const bool parallel = plan.camera->parallel();
  const PixelFootprint pixel = pixel_footprint(frame, *plan.camera, plan.height);
  const double aspect = double(plan.width) / plan.height;
  const double corner = frame.half_extent * std::sqrt(1 + aspect * aspect);
  return {frame.eye,
          -frame.back,
          parallel,
          pixel.width,
          pixel.spread,
          *plan.asked.tessellation_error,
          parallel ? corner : 1 / std::sqrt(1 + corner * corner)};
}

// Returns the view in the coordinates of an instance. Pixels are as small as the scaling permits.
TessellationView in_model(TessellationView view, const Affined& world_from_model,
                          const Affined& model_from_world) {
  const double x = length(world_from_model.x), y = length(world_from_model.y), z = length(world_from_model.z);
  const double smallest = std::min({x, y, z}), largest = std::max({x, y, z});
  view.eye = model_from_world.point(view.eye);
  view.forward = safe_normalize(model_from_world.vector(view.forward));
  view.pixel_width /= largest;
  view.pixel_spread *= smallest / largest;
  if (view.parallel) view.reach /= smallest;
  return view;
}

class Tessellator {
 public:
  Tessellator(double time, std::size_t max_triangles) : time_(time), max_triangles_(max_triangles) {}

  // Adds the primitives of the sets, numbered from `first`. `may_refer`: they are in scene coordinates.
  // Returns the number after the last.
  int add(const std::vector<std::unique_ptr<ShapeSet>>& sets, const TessellationView& view, int first,
          bool may_refer) {
    for (const auto& shapes : sets) {
      if (shapes->size() == 0) continue;
      const auto posed = shapes->at(time_);
      out_.may_refer = may_refer && !posed;
      (posed ? *posed : *shapes).tessellate(view, first, out_);
      first += shapes->size();
      if (out_.size() > max_triangles_)
        throw InputError("/render/technique", "needs more than " + grouped(max_triangles_) +
                                                  " triangles for this scene; a larger tessellation_error "
                                                  "needs fewer");
    }
    return first;
  }

  int add(const Model& model, const Affined& world_from_model, const TessellationView& view, int first) {
    const std::size_t first_vertex = out_.vertices.size(), first_triangle = out_.triangles.size();
    const int next =
        add(model.shapes, in_model(view, world_from_model, inverse(world_from_model)), first, false);
    for (std::size_t i = first_vertex; i < out_.vertices.size(); ++i) {
      Tessellation::Vertex& vertex = out_.vertices[i];
      vertex.position = world_from_model.point(vertex.position);
      vertex.normal = safe_normalize(transformed_normal(world_from_model, vertex.normal));
    }
    if (scaled_determinant(world_from_model) < 0)
      for (std::size_t i = first_triangle; i < out_.triangles.size(); ++i)
        std::swap(out_.triangles[i].vertices[1], out_.triangles[i].vertices[2]);
    return next;
  }

  Tessellation take() { return std::move(out_); }

 private:
  double time_;
  std::size_t max_triangles_;
  Tessellation out_;
};

}  // namespace

Tessellation tessellate(const Scene& scene, const Plan& plan, std::size_t max_triangles) {
  const TessellationView view = view_of(plan);
  Tessellator tessellator(plan.time, max_triangles);
  int first = tessellator.add(scene.shapes, view, 0, true);
  for (const Instance& instance : scene.instances) {
    checkpoint();
    first = tessellator.add(scene.models[instance.model], instance.world_from_model(plan.time), view, first);
  }
  return tessellator.take();
}

}  // namespace orrery
