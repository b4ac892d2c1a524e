#include "core/plan/cost.h"

#include <algorithm>
#include <limits>

#include "core/cameras/pixel_filter.h"
#include "core/model/accelerator.h"
#include "core/model/technique.h"

namespace orrery {
namespace {

constexpr int kChosenSamples = 16;      // samples per pixel assumed if a budget may end the render early
constexpr double kSpecularShare = 0.5;  // assumed fraction of rays that hit a specular surface
constexpr double kScatterings = 4;      // assumed scattering events per path if bodies scatter light

double camera_rays_of(const Plan& plan) {
  const bool may_end_early = plan.free_samples || plan.asked.seconds.value_or(0) > 0;
  const int samples = may_end_early ? std::min(plan.samples, kChosenSamples) : plan.samples;
  return double(plan.width) * plan.height * samples;
}

// Assumes that 70 % of the paths survive Russian roulette at each vertex. If diffuse surfaces end paths, half
// as many survive, or none without other lobes. Each vertex sends one shadow ray. Each path has one
// connection to each other path of its reuse group. Two rays per sample search for emitters, or
// kMaxEmissionSamples with lens or motion blur. Each scattering event counts as a ray.
double expected_path_rays(const Scene& scene, const Plan& plan) {
  const MaterialTraits& materials = scene.facts.materials;
  const double surviving = plan.technique->interreflects || !materials.diffuse ? 0.7
                           : materials.non_diffuse                             ? 0.7 * kSpecularShare
                                                                               : 0;
  const double has_emission_pass = plan.lens || plan.shutter > 0 ? kMaxEmissionSamples : 2;
  double rays = 1 + has_emission_pass + (plan.reuse - 1) + (plan.scatters ? kScatterings : 0), share = 1;
  for (int depth = 1; depth <= plan.max_depth; ++depth) {
    rays += share * (1 + surviving);
    share *= surviving;
  }
  return camera_rays_of(plan) * rays;
}

double expected_tree_rays(const Scene& scene, const Plan& plan) {
  const MaterialTraits& materials = scene.facts.materials;
  const bool branches = plan.specular && materials.mirrors && plan.technique->secondary_rays;
  const double children = materials.transmits ? 2 : 1;
  const double most =
      plan.min_contribution > 0 ? 1 / plan.min_contribution : std::numeric_limits<double>::infinity();
  double tree = 1;         // rays per camera ray, including the camera ray
  double descendants = 1;  // rays of one generation if every surface were specular
  double share = 1;        // expected fraction of `descendants` that exists
  const int depth = branches ? plan.max_depth : 0;
  for (int generation = 1; generation <= depth; ++generation) {
    descendants = std::min(descendants * children, most);
    share *= kSpecularShare;
    tree += descendants * share;
  }
  const bool shadows = plan.direct_light && plan.shadows;
  const double lit = shadows ? (branches ? 1 - kSpecularShare : 1) : 0;
  const double camera_rays = camera_rays_of(plan);
  return camera_rays * tree * (1 + lit * static_cast<double>(scene.lights.size()));
}

}  // namespace

double expected_rays(const Scene& scene, const Plan& plan) {
  const double parts = plan.filtered && has_negative_lobes(*plan.asked.filter) ? 2 : 1;
  return parts *
         (plan.technique->draws_light ? expected_path_rays(scene, plan) : expected_tree_rays(scene, plan));
}

double ray_weight(const Scene& scene, const Plan& plan) {
  if (plan.technique->rasterizes) return 1;
  constexpr double kUsualRay_ns = 20;
  const auto primitives = static_cast<double>(scene.primitive_count());
  return std::max(1.0, plan.accelerator->costs.each * primitives / kUsualRay_ns);
}

}  // namespace orrery
