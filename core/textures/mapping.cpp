#include "core/textures/mapping.h"

#include <cmath>

#include "core/math/angles.h"
#include "core/params/params.h"

namespace orrery {
namespace {

using Kind = TextureMapping::Kind;
constexpr std::array<Choice, 5> kKinds{{
    {"uv", "Parameters u and v of the shape, or texture coordinates of the mesh."},
    {"planar", "Projection along the normal of a plane."},
    {"spherical", "Angles around a centre: u around the axis, v from the bottom to the top."},
    {"cylindrical", "Angle around an axis as u, and height along the axis as v."},
    {"solid", "Three coordinates in space."},
}};

void read_place(Params& p, TextureMapping& mapping) {
  mapping.origin = p.point("origin", "Point with the coordinates 0, in metres.", Vec3d(0));
  mapping.in_world =
      p.choice("space",
               "Coordinates of the model of an instance, which the texture follows, or of the scene.",
               {"object", "world"}, "object") == "world";
}

// Sets the rows to an orthonormal frame whose y axis is `axis`. The frame of +y is the identity.
void read_axis(Params& p, TextureMapping& mapping) {
  const Vec3d axis = p.direction("axis", "Direction of the y axis of the texture.", Vec3d(0, 1, 0));
  mapping.y = axis;
  // As tangents_of(), with y and z exchanged.
  const double sign = std::signbit(axis.y) ? -1 : 1, k = -1 / (sign + axis.y), mixed = axis.x * axis.z * k;
  mapping.x = {1 + sign * axis.x * axis.x * k, -sign * axis.x, sign * mixed};
  mapping.z = {mixed, -axis.z, sign + axis.z * axis.z * k};
}

void read_repeats(Params& p, TextureMapping& mapping) {
  constexpr Range kFactor{.min = -1e6, .max = 1e6};
  mapping.repeat = {p.number("repeat_u", "Factor of u.", kFactor, 1.0),
                    p.number("repeat_v", "Factor of v.", kFactor, 1.0)};
  const SineCosine turn = sine_cosine_degrees(
      p.number("turn_degrees", "Anticlockwise rotation of (u, v), in degrees, after the factors.",
               {.min = -360, .max = 360}, 0.0));
  mapping.cosine = turn.cosine;
  mapping.sine = turn.sine;
  mapping.shift = {p.number("shift_u", "Number added to u.", kFactor, 0.0),
                   p.number("shift_v", "Number added to v.", kFactor, 0.0)};
}

// Reads the edge along which a coordinate of a planar mapping increases from 0 to 1. Returns the gradient of
// the coordinate.
Vec3d read_edge(Params& p, const char* key, const char* doc, const Vec3d& fallback) {
  const Vec3d edge = p.point(key, doc, fallback);
  const double size = length(edge);
  if (!(size >= kMinLength)) {
    p.fail(key, "must be at least " + number_text(kMinLength) + " m long (got " + number_text(size) + ")");
    return fallback;
  }
  return edge / size / size;
}

}  // namespace

std::string_view name_of(TextureMapping::Kind kind) { return kKinds[static_cast<std::size_t>(kind)].type; }

TextureMapping read_mapping(Params& p) {
  TextureMapping mapping;
  p.object_if_given("mapping", "Texture coordinates of a surface point; default: uv.", [&](Params& m) {
    const auto kind = m.pick("type", "Mapping type.", kKinds);
    if (!kind) return;
    mapping.kind = static_cast<Kind>(*kind);
    if (mapping.kind != Kind::uv) read_place(m, mapping);
    switch (mapping.kind) {
      case Kind::uv: break;
      case Kind::planar:
        mapping.x = read_edge(m, "u_edge", "Vector along which u increases by 1, in metres.", Vec3d(1, 0, 0));
        mapping.y = read_edge(m, "v_edge", "Vector along which v increases by 1, in metres.", Vec3d(0, 1, 0));
        break;
      case Kind::spherical: read_axis(m, mapping); break;
      case Kind::cylindrical:
        read_axis(m, mapping);
        mapping.y = mapping.y / m.positive("height", "Height over which v increases by 1, in metres.", 1.0);
        break;
      case Kind::solid: {
        read_axis(m, mapping);
        const double size = m.positive("size", "Length of one unit of texture coordinates, in metres.", 1.0);
        mapping.x = mapping.x / size;
        mapping.y = mapping.y / size;
        mapping.z = mapping.z / size;
        break;
      }
    }
    if (mapping.kind != Kind::planar && mapping.kind != Kind::solid) read_repeats(m, mapping);
  });
  return mapping;
}

}  // namespace orrery
