#include "core/materials/material_params.h"

#include <algorithm>
#include <array>

namespace orrery {
namespace {

constexpr std::array<std::string_view, 5> kChannels{"rgb", "luminance", "red", "green", "blue"};

// Returns the bounds of a channel of a texture, as a grey colour unless the channel is rgb.
TextureBounds bounds_of_channel(const TextureBounds& all, TextureChannel channel) {
  if (channel == TextureChannel::rgb) return all;
  const Vec3d weights = channel_weights(channel);
  return {Vec3d(dot(all.least, weights)), Vec3d(dot(all.most, weights))};
}

std::string range_of(const Vec3d& least, const Vec3d& most) {
  return number_text(std::min({least.x, least.y, least.z})) + " to " + number_text(max_component(most));
}

}  // namespace

TextureUse read_texture_use(Params& p, const TextureNames& textures, bool is_color) {
  constexpr Range kFactors{.min = -kMaxColor, .max = kMaxColor};
  const std::size_t texture = p.reference("texture", "Name of the texture.", textures.names);
  const std::string channel =
      p.choice("channel", "Value of the texture; default: rgb for colours, luminance for numbers.", kChannels,
               derived(std::string_view(is_color ? "rgb" : "luminance")));
  TextureUse use{.texture = static_cast<int>(texture), .slot = kBumpSlot, .channel = TextureChannel::rgb};
  use.channel =
      static_cast<TextureChannel>(std::find(kChannels.begin(), kChannels.end(), channel) - kChannels.begin());
  use.scale = Vec3d(p.number("scale", "Factor of the value.", kFactors, 1.0));
  if (is_color) use.scale = use.scale * p.color("tint", "Colour that multiplies the value.", Vec3d(1));
  use.offset = Vec3d(p.number("offset", "Number that is added to the scaled value.", kFactors, 0.0));
  if (!is_color && use.channel == TextureChannel::rgb)
    p.fail("channel", "must be luminance, red, green or blue for a number (got \"rgb\")");
  if (texture >= textures.bounds.size()) return use;
  const TextureBounds own = bounds_of_channel(textures.bounds[texture], use.channel);
  const Vec3d a = own.least * use.scale + use.offset, b = own.most * use.scale + use.offset;
  use.least = {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  use.most = largest(a, b);
  return use;
}

int MaterialParams::add_field(const double& first, std::size_t count) {
  fields_.push_back({static_cast<std::size_t>(&first - inputs_), count});
  return static_cast<int>(fields_.size()) - 1;
}

// Clamps the bounds of invalid values, so that the values are valid placeholders.
bool MaterialParams::read_texture(std::string_view key, const Range& range, int slot, bool is_color) {
  if (!textures_) return false;
  TextureUse use;
  const bool is_textured =
      params_.object_instead(key, "texture_use", "A texture instead of a value.", [&](Params& p) {
        use = read_texture_use(p, *textures_, is_color);
        const double least = std::min({use.least.x, use.least.y, use.least.z}),
                     most = max_component(use.most);
        const bool known = static_cast<std::size_t>(use.texture) < textures_->bounds.size();
        if (known && !(range.contains(least) && range.contains(most)))
          p.fail("", "values must be from " + number_text(range.min) + " to " + number_text(range.max) +
                         " (got " + range_of(use.least, use.most) + ")");
      });
  if (!is_textured) return false;
  const auto within = [&](const Vec3d& v) {
    return Vec3d(std::clamp(v.x, range.min, range.max), std::clamp(v.y, range.min, range.max),
                 std::clamp(v.z, range.min, range.max));
  };
  use.slot = slot;
  use.least = within(use.least);
  use.most = within(use.most);
  uses_.push_back(use);
  return true;
}

const TextureUse* MaterialParams::use_of(const double& first) const {
  for (const TextureUse& use : uses_)
    if (inputs_ + fields_[static_cast<std::size_t>(use.slot)].first == &first) return &use;
  return nullptr;
}

Vec3d MaterialParams::bound(const Vec3d& member, Vec3d TextureUse::*end) const {
  const TextureUse* const use = use_of(member.x);
  return use ? use->*end : member;
}

bool MaterialParams::raise_texture(const double& member, double least) {
  for (TextureUse& use : uses_) {
    if (inputs_ + fields_[static_cast<std::size_t>(use.slot)].first != &member) continue;
    use.least = largest(use.least, Vec3d(least));
    use.most = largest(use.most, Vec3d(least));
    return true;
  }
  return false;
}

void MaterialParams::number(double& into, std::string_view key, std::string_view doc, const Range& range,
                            Fallback<double> fallback) {
  const int slot = add_field(into, 1);
  if (read_texture(key, range, slot, false))
    into = uses_.back().least.x;
  else
    into = params_.number(key, doc, range, fallback);
}

void MaterialParams::color(Vec3d& into, std::string_view key, std::string_view doc, Fallback<Vec3d> fallback,
                           double max) {
  const int slot = add_field(into.x, 3);
  if (read_texture(key, {.min = 0, .max = max}, slot, true))
    into = uses_.back().least;
  else
    into = params_.color(key, doc, fallback, max);
}

void MaterialParams::coefficient(Vec3d& into, std::string_view key, std::string_view doc,
                                 Fallback<Vec3d> fallback, double max) {
  const int slot = add_field(into.x, 3);
  if (read_texture(key, {.min = 0, .max = max}, slot, true))
    into = uses_.back().least;
  else
    into = params_.coefficient(key, doc, fallback, max);
}

void MaterialParams::coefficient_like(Vec3d& into, std::string_view key, std::string_view doc,
                                      const Vec3d& of, double scale, double offset, double max) {
  const TextureUse* const model = params_.has(key) ? nullptr : use_of(of.x);
  if (!model) return coefficient(into, key, doc, derived(of * scale + Vec3d(offset)), max);
  TextureUse use = *model;
  coefficient(into, key, doc, derived(Vec3d(0)), max);
  use.slot = static_cast<int>(fields_.size()) - 1;
  const Vec3d a = use.least * scale + Vec3d(offset), b = use.most * scale + Vec3d(offset);
  use.least = {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  use.most = largest(a, b);
  use.offset = use.offset * scale + Vec3d(offset);
  use.scale = use.scale * scale;
  into = use.least;
  uses_.push_back(use);
}

}  // namespace orrery
