#include "core/lighting/textures.h"

#include <algorithm>

#include "core/lighting/texture_fields.h"
#include "core/math/hemisphere.h"

namespace orrery {
namespace {

bool follows_instances(const Scene& scene, const PlacedTexture& texture) {
  return texture.mapping.kind != TextureMapping::Kind::uv && !texture.mapping.in_world &&
         !scene.instances.empty();
}

// Returns the difference of the smaller magnitude. At a jump, such as the seam of a sphere, only one of both
// differences includes the jump.
template <class N>
N smaller(const N& a, const N& b) {
  using std::abs;
  return select(abs(b) < abs(a), b, a);
}

}  // namespace

SurfaceFields texture_fields(const Scene& scene) {
  SurfaceFields fields;
  for (const TextureUse& use : scene.texture_uses) {
    if (use.slot == kOpacitySlot) continue;
    const PlacedTexture& texture = scene.textures[static_cast<std::size_t>(use.texture)];
    fields.parameters |= texture.mapping.kind == TextureMapping::Kind::uv;
    fields.footprint |= texture.filtered || tilts(use);
    fields.identity |= follows_instances(scene, texture);
    fields.color |= texture.vertex_colors;
  }
  return fields;
}

// Batch whose textures are evaluated.
template <class T>
struct TextureStage<T>::Batch {
  const Geometry<T>& geometry;
  const PathBatch<T>& paths;
  const HitBatch<T>& hits;
  SurfaceBatch<T>& surface;
  LaneGroups groups;
};

// Coordinates of a batch. `first` and `second` are their derivatives along the tangents of the geometric
// normal. `shifted` and `probe` contain displaced points.
template <class T>
struct TextureStage<T>::Scratch {
  TexturePoints<T> points;
  Vec3Array<T> first, second, value;
  struct Probe {
    RayBatch<T> rays;
    HitBatch<T> hits;
    SurfaceBatch<T> surface;
  };
  std::unique_ptr<Probe> probe;
};

template <class T>
TextureStage<T>::TextureStage(const Scene& scene, const Exposure& exposure) : exposure_(exposure) {
  const std::size_t materials = scene.emission.size();
  std::vector<int> entry_of(scene.textures.size(), -1);
  bool follows = false;
  for (const TextureUse& use : scene.texture_uses) {
    if (use.slot == kOpacitySlot) continue;  // evaluated by CutoutAccelerator
    const PlacedTexture& texture = scene.textures[static_cast<std::size_t>(use.texture)];
    int& number = entry_of[static_cast<std::size_t>(use.texture)];
    if (number < 0) {
      number = static_cast<int>(entries_.size());
      entries_.push_back({texture.texture->kernel(T()),
                          texture.mapping,
                          texture.filtered,
                          texture.vertex_colors,
                          false,
                          false,
                          false,
                          static_cast<T>(texture.texture->detail()),
                          {},
                          std::vector<char>(materials, 0)});
      follows = follows || follows_instances(scene, texture);
    }
    Entry& entry = entries_[static_cast<std::size_t>(number)];
    const auto material = static_cast<std::size_t>(use.material);
    entry.used_by[material] = 1;
    entry.binds = entry.binds || !tilts(use);
    entry.turns = entry.turns || use.slot == kNormalSlot;
    entry.tilts = entry.tilts || tilts(use);
    auto pass = std::find_if(entry.passes.begin(), entry.passes.end(),
                             [&](const Pass& p) { return p.slot == use.slot; });
    if (pass == entry.passes.end())
      pass = entry.passes.insert(pass, {use.slot, std::vector<Binding<T>>(materials)});
    pass->by_material[material] = {T(1),
                                   Vec3<T>(use.scale),
                                   Vec3<T>(use.offset),
                                   Vec3<T>(channel_weights(use.channel)),
                                   use.channel == TextureChannel::rgb ? T(1) : T(0),
                                   Vec3<T>(use.least),
                                   Vec3<T>(use.most)};
    if (use.slot >= 0) slots_ = std::max(slots_, static_cast<std::size_t>(use.slot) + 1);
  }
  if (!follows) return;
  for (const Instance& instance : scene.instances) {
    const bool moves = !exposure.instant() && instance.motion.times.size() > 1;
    poses_.push_back(
        {inverse(instance.world_from_model(exposure.opens)).template as<T>(), moves ? &instance : nullptr});
  }
}

template <class T>
void TextureStage<T>::apply(const Geometry<T>& geometry, const PathBatch<T>& paths, const LaneGroups& met,
                            const HitBatch<T>& hits, SurfaceBatch<T>& surface) const {
  if (surface.textured.size() < slots_) surface.textured.resize(slots_);
  std::unique_ptr<Scratch> scratch;
  const auto evaluate = [&](bool tilting) {
    for (const Entry& entry : entries_) {
      if (!(tilting ? entry.tilts : entry.binds)) continue;
      Batch batch{geometry, paths, hits, surface, groups_of(entry, surface, met)};
      if (batch.groups.empty()) continue;
      if (!scratch) scratch.reset(new Scratch);
      find_coordinates(entry, batch, *scratch);
      if (!tilting || entry.turns) {
        entry.kernel->evaluate(scratch->points, batch.groups, scratch->value);
        if (entry.colored) multiply_colors(batch, scratch->value);
      }
      for (const Pass& pass : entry.passes) {
        if (tilting && pass.slot == kNormalSlot) turn_normals(pass, batch, *scratch);
        if (!tilting && (pass.slot >= 0 || pass.slot == kEmissionSlot)) bind(pass, batch, scratch->value);
      }
      if (!tilting) continue;
      for (const Pass& pass : entry.passes)
        if (pass.slot == kBumpSlot) bump(entry, pass, batch, *scratch);  // replaces the values
    }
  };
  evaluate(false);
  evaluate(true);
}

template <class T>
LaneGroups TextureStage<T>::groups_of(const Entry& entry, const SurfaceBatch<T>& surface,
                                      const LaneGroups& met) const {
  LaneGroups groups;
  for (const int i : met) {
    bool used = false;
    for (int lane = i; lane < i + kWidth<T> && !used; ++lane)
      used = surface.material[lane] >= 0 && entry.used_by[static_cast<std::size_t>(surface.material[lane])];
    if (used) groups.add(i);
  }
  return groups;
}

template <class T>
Affine<Lanes<T>> TextureStage<T>::model_from_world(const Batch& batch, int i) const {
  const IndexLanes<T> instance = load_index<T>(batch.hits.instance, i);
  std::array<Affine<T>, static_cast<std::size_t>(kWidth<T>)> maps;
  for (std::size_t lane = 0; lane < maps.size(); ++lane) {
    if (instance[lane] < 0) continue;
    const Pose& pose = poses_[static_cast<std::size_t>(instance[lane])];
    maps[lane] = pose.model_from_world;
    if (!pose.moving) continue;
    const double share = static_cast<double>(batch.paths.rays.time[i + static_cast<int>(lane)]);
    const double time = exposure_.opens + (exposure_.closes - exposure_.opens) * share;
    maps[lane] = inverse(pose.moving->world_from_model(time)).template as<T>();
  }
  IndexLanes<T> lanes([](auto lane) { return IndexOf<T>(lane); });
  return gather_records<Affine, T>(maps, lanes, MaskOf<N>(true), IndexOf<T>(0));
}

template <class T>
void TextureStage<T>::find_coordinates(const Entry& entry, const Batch& batch, Scratch& scratch) const {
  const bool is_uv = entry.mapping.kind == TextureMapping::Kind::uv;
  const bool differentiates = entry.filtered || entry.tilts;
  const bool follows = !poses_.empty() && !entry.mapping.in_world;
  const MappingOf<N> mapping(entry.mapping);
  if (is_uv && differentiates) find_uv(batch, scratch);
  const SurfaceBatch<T>& surface = batch.surface;
  const N zero(T(0));
  for (const int i : batch.groups) {
    const Vec3<N> normal = surface.geometric.at(i);
    const Tangents<N> tangents = tangents_of(normal);
    TextureCoordinates<N> found;
    if (is_uv) {
      found.at = {surface.u.at(i), surface.v.at(i), zero};
      if (differentiates) {
        found.along_first = scratch.first.at(i);
        found.along_second = scratch.second.at(i);
      }
      found = mapping.repeated(found);
    } else if (follows) {
      const Affine<N> to_model = model_from_world(batch, i);
      found = mapping.coordinates(to_model.point(surface.position.at(i)), to_model.vector(tangents.first),
                                  to_model.vector(tangents.second));
    } else {
      found = mapping.coordinates(surface.position.at(i), tangents.first, tangents.second);
    }
    scratch.points.at.put(i, found.at);
    scratch.points.width.put(
        i, entry.filtered ? box_of_footprint(found, tangents.first, tangents.second, normal,
                                             batch.paths.rays.direction.at(i), surface.footprint.at(i))
                          : Vec3<N>(zero));
    if (!entry.tilts) continue;
    scratch.first.put(i, found.along_first);
    scratch.second.put(i, found.along_second);
  }
}

// Estimates the derivatives of u and v by differences between points at the distance of a pixel. Rays are
// moved with the points, because some shapes compute parameters from the ray.
template <class T>
void TextureStage<T>::find_uv(const Batch& batch, Scratch& scratch) const {
  if (!scratch.probe) scratch.probe.reset(new typename Scratch::Probe);
  auto& [rays, hits, moved] = *scratch.probe;
  const SurfaceBatch<T>& surface = batch.surface;
  rays.count = batch.paths.rays.count;
  const N zero(T(0));
  const auto step_of = [&](int i) {
    return max_first(surface.footprint.at(i), N(T(2) * surface.step.at(i)));
  };
  const auto evaluate_at = [&](bool along_second, T sign) {
    for (const int i : batch.groups) {
      const Tangents<N> tangents = tangents_of(surface.geometric.at(i));
      const Vec3<N> step = (along_second ? tangents.second : tangents.first) * (step_of(i) * N(sign));
      rays.origin.put(i, batch.paths.rays.origin.at(i) + step);
      rays.direction.put(i, batch.paths.rays.direction.at(i));
      rays.t_max.put(i, batch.paths.rays.t_max.at(i));
      rays.time.put(i, batch.paths.rays.time.at(i));
      hits.t.put(i, batch.hits.t.at(i));
      hits.primitive.put(i, load_index<T>(batch.hits.primitive, i));
      moved.position.put(i, surface.position.at(i) + step);
      moved.geometric.put(i, surface.geometric.at(i));
      moved.normal.put(i, surface.normal.at(i));
      moved.side.put(i, surface.side.at(i));
      moved.step.put(i, surface.step.at(i));
    }
    for (const auto& shapes : batch.geometry.shapes) shapes->parameters(rays, batch.groups, hits, moved);
  };
  for (const bool along_second : {false, true}) {
    Vec3Array<T>& derivative = along_second ? scratch.second : scratch.first;
    for (const T sign : {T(1), T(-1)}) {
      evaluate_at(along_second, sign);
      for (const int i : batch.groups) {
        const N scale = N(sign) / step_of(i);
        const Vec3<N> found((moved.u.at(i) - surface.u.at(i)) * scale,
                            (moved.v.at(i) - surface.v.at(i)) * scale, zero);
        const Vec3<N> before = derivative.at(i);
        derivative.put(
            i, sign > 0 ? found : Vec3<N>(smaller(before.x, found.x), smaller(before.y, found.y), zero));
      }
    }
  }
}

template <class T>
Vec3<Lanes<T>> TextureStage<T>::bound_value(const Pass& pass, const SurfaceBatch<T>& surface, int i,
                                            const Vec3<N>& value, MaskOf<N>& mine) const {
  const IndexLanes<T> material = load_index<T>(surface.material, i);
  const auto known = mask_cast<N>(material >= 0);
  const auto binding = gather_records<Binding, T>(
      pass.by_material, material, known, material[static_cast<std::size_t>(stdx::find_first_set(known))]);
  mine = known && binding.used > N(T(0));
  const Vec3<N> chosen = select(binding.rgb > N(T(0)), value, Vec3<N>(N(dot(binding.weights, value))));
  const Vec3<N> scaled = chosen * binding.scale + binding.offset;
  const auto within = [](const N& x, const N& least, const N& most) {
    return min_first(most, max_first(least, x));
  };
  return {within(scaled.x, binding.least.x, binding.most.x),
          within(scaled.y, binding.least.y, binding.most.y),
          within(scaled.z, binding.least.z, binding.most.z)};
}

template <class T>
void TextureStage<T>::bind(const Pass& pass, const Batch& batch, const Vec3Array<T>& values) const {
  Vec3Array<T>& slot = pass.slot == kEmissionSlot
                           ? batch.surface.emitted
                           : batch.surface.textured[static_cast<std::size_t>(pass.slot)];
  for (const int i : batch.groups) {
    MaskOf<N> mine;
    const Vec3<N> value = bound_value(pass, batch.surface, i, values.at(i), mine);
    slot.put(i, mine, value);
  }
}

template <class T>
void TextureStage<T>::multiply_colors(const Batch& batch, Vec3Array<T>& values) const {
  for (const int i : batch.groups) values.put(i, values.at(i) * batch.surface.color.at(i));
}

// The colour c of a normal map is the normal 2 c - 1 in the coordinates of the surface: x along increasing u,
// y along increasing v, z along the shading normal (glTF 2.0, Khronos, section 3.9.3). With the derivatives
// of u and v along the tangents a and b, the direction of increasing u at constant v is a v_b - b v_a, up to
// the sign of the determinant.
template <class T>
void TextureStage<T>::turn_normals(const Pass& pass, const Batch& batch, const Scratch& scratch) const {
  const SurfaceBatch<T>& surface = batch.surface;
  const N zero(T(0)), one(T(1));
  for (const int i : batch.groups) {
    MaskOf<N> mine;
    const Vec3<N> color = bound_value(pass, surface, i, scratch.value.at(i), mine);
    const Vec3<N> a = scratch.first.at(i), b = scratch.second.at(i);
    const N determinant = a.x * b.y - b.x * a.y, side = surface.side.at(i);
    const Tangents<N> tangents = tangents_of(surface.geometric.at(i));
    const Vec3<N> normal = surface.normal.at(i) * side;
    const N sign = select(determinant < zero, N(-one), one);
    const Vec3<N> along_u = (tangents.first * b.y - tangents.second * a.y) * sign,
                  along_v = (tangents.second * a.x - tangents.first * b.x) * sign;
    const Vec3<N> flat = along_u - normal * dot(normal, along_u);
    const N size = dot(flat, flat);
    const auto usable = mine && size > zero && determinant != zero;
    if (!any(usable)) continue;
    using std::sqrt;
    const Vec3<N> x = flat * (one / sqrt(select(usable, size, one)));
    const Vec3<N> across = cross(normal, x);
    const Vec3<N> y = across * select(dot(across, along_v) < zero, N(-one), one);
    const Vec3<N> found = x * color.x + y * color.y + normal * color.z;
    const N square = dot(found, found);
    const auto turned = usable && square > zero;
    batch.surface.normal.put(i, turned, found * (side / sqrt(select(turned, square, one))));
  }
}

// The normal n of a surface raised by the height h is along n - grad h, where the gradient is taken along the
// surface (Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978). The gradient is a central difference
// over one pixel, or over a quarter of the smallest detail if that is larger.
template <class T>
void TextureStage<T>::bump(const Entry& entry, const Pass& pass, const Batch& batch, Scratch& scratch) const {
  std::unique_ptr<TexturePoints<T>> moved(new TexturePoints<T>);
  std::unique_ptr<Vec3Array<T>> before(new Vec3Array<T>), slopes(new Vec3Array<T>);
  const SurfaceBatch<T>& surface = batch.surface;
  const N half_detail(entry.detail * T(0.125)), tiny(std::numeric_limits<T>::min());
  const auto half_step = [&](int i, const Vec3<N>& derivative) {
    using std::abs;
    const N rate = max_first(tiny, N(max_component(abs(derivative))));
    return max_first(N(surface.footprint.at(i) * T(0.5)), N(half_detail / rate));
  };
  for (const bool along_second : {false, true}) {
    const Vec3Array<T>& derivative = along_second ? scratch.second : scratch.first;
    for (const T sign : {T(-1), T(1)}) {
      for (const int i : batch.groups) {
        const Vec3<N> d = derivative.at(i);
        moved->at.put(i, scratch.points.at.at(i) + d * (half_step(i, d) * N(sign)));
        moved->width.put(i, scratch.points.width.at(i));
      }
      entry.kernel->evaluate(*moved, batch.groups, sign < 0 ? *before : scratch.value);
    }
    for (const int i : batch.groups) {
      MaskOf<N> mine;
      const Vec3<N> low = bound_value(pass, surface, i, before->at(i), mine),
                    high = bound_value(pass, surface, i, scratch.value.at(i), mine);
      const N slope = (high.x - low.x) / (T(2) * half_step(i, derivative.at(i)));
      (along_second ? slopes->y : slopes->x).put(i, select(mine, slope, N(T(0))));
    }
  }
  for (const int i : batch.groups) {
    const Vec3<N> geometric = surface.geometric.at(i), normal = surface.normal.at(i);
    const Tangents<N> tangents = tangents_of(geometric);
    const N side = surface.side.at(i), a = slopes->x.at(i), b = slopes->y.at(i);
    const auto tilted = a != N(T(0)) || b != N(T(0));
    if (!any(tilted)) continue;
    const Vec3<N> bumped = normalize(normal - (tangents.first * a + tangents.second * b) * side);
    batch.surface.normal.put(i, tilted, bumped);
  }
}

template class TextureStage<float>;
template class TextureStage<double>;

}  // namespace orrery
