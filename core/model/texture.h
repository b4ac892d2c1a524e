#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/model/batch.h"
#include "core/params/names.h"

// Textures: colours that depend on the place on a surface. A mapping assigns coordinates to a surface point,
// and a texture assigns a colour to coordinates. Colours are linear.
namespace orrery {

class AssetSource;
class Params;

// Smallest and largest values of a texture, per channel.
struct TextureBounds {
  Vec3d least{0.0}, most{1.0};
};

// Coordinates at which a texture is evaluated, and the sides of the axis-aligned box in texture coordinates
// over which the texture is averaged. Sides of 0 select a point.
template <class T>
struct TexturePoints {
  Vec3Array<T> at, width;
};

// Maximum side of the averaging box.
inline constexpr double kMaxTextureWidth = 0x1p16;

// Values of one texture. Immutable and thread-safe.
template <class T>
class TextureKernel {
 public:
  virtual ~TextureKernel() = default;

  // Sets `value` in the registers of `groups`. REQUIRES: widths are in [0, kMaxTextureWidth].
  virtual void evaluate(const TexturePoints<T>& points, const LaneGroups& groups,
                        Vec3Array<T>& value) const = 0;
};
template <class T>
using TextureKernelPtr = std::unique_ptr<const TextureKernel<T>>;

// One texture of a scene. Immutable and thread-safe.
class Texture {
 public:
  virtual ~Texture() = default;
  virtual TextureBounds bounds() const = 0;
  // Returns the size of the smallest details, in texture coordinates.
  virtual double detail() const = 0;
  virtual TextureKernelPtr<float> kernel(float) const = 0;
  virtual TextureKernelPtr<double> kernel(double) const = 0;
};

// Mapping from surface points to texture coordinates. With M the matrix of `rows`, q = M (p - origin).
//   uv           (u, v, 0) of the shape; not used: origin and rows
//   planar       (q.x, q.y, 0)
//   spherical    (turns of q about its y axis, latitude of q from 0 at the bottom to 1 at the top, 0)
//   cylindrical  (turns of q about its y axis, q.y, 0)
//   solid        q
// The first two coordinates of uv, spherical and cylindrical are then multiplied by `repeat`, turned
// anticlockwise by an angle with this cosine and sine, and increased by `shift`.
struct TextureMapping {
  enum class Kind { uv, planar, spherical, cylindrical, solid } kind = Kind::uv;
  bool in_world = false;  // p is in world coordinates, otherwise in the coordinates of the instance's model
  Vec3d origin{0.0};
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // rows; 1 / metres for planar and solid
  std::array<double, 2> repeat{1, 1}, shift{0, 0};
  double cosine = 1, sine = 0;
};

struct PlacedTexture {
  std::string name;
  const char* type = "";  // name of its TextureType
  std::shared_ptr<const Texture> texture;
  TextureMapping mapping;
  bool filtered = true;        // averaged over the footprint of the pixel
  bool vertex_colors = false;  // multiplied by the vertex colours of meshes
};

// Value taken from a texture: its colour, its luminance (ITU-R BT.709) or one channel.
enum class TextureChannel { rgb, luminance, red, green, blue };

// Returns the vector whose dot product with a colour is the value of a channel; 0 for rgb.
inline Vec3d channel_weights(TextureChannel channel) {
  switch (channel) {
    case TextureChannel::rgb: return Vec3d(0);
    case TextureChannel::luminance: return {0.2126, 0.7152, 0.0722};
    case TextureChannel::red: return {1, 0, 0};
    case TextureChannel::green: return {0, 1, 0};
    case TextureChannel::blue: return {0, 0, 1};
  }
  return Vec3d(0);
}

// Slots of parameters that every material has: bump map, emission, normal map and opacity.
inline constexpr int kBumpSlot = -1, kEmissionSlot = -2, kNormalSlot = -3, kOpacitySlot = -4;

// Use of a texture by one parameter of one material: offset + scale * channel of the texture, per channel of
// a colour, clamped to the bounds [least, most], which differ from the exact bounds by rounding only. `slot`
// numbers the parameters of a material type from 0. Parameters of all materials have negative slots. The
// scale of a bump map is in metres.
struct TextureUse {
  int texture;
  int slot;
  TextureChannel channel;
  Vec3d scale{1.0};
  Vec3d offset{0.0};
  Vec3d least{-std::numeric_limits<double>::infinity()}, most{std::numeric_limits<double>::infinity()};
  int material = 0;  // number in the scene
};

// Returns whether a texture tilts shading normals.
inline bool tilts(const TextureUse& use) { return use.slot == kBumpSlot || use.slot == kNormalSlot; }

// Textures that the materials of a scene may refer to, by index of the name.
struct TextureNames {
  Names names{"texture"};
  std::vector<TextureBounds> bounds;
};

struct TextureType {
  const char* name;
  const char* summary;
  // Reads the parameters of the type. Returns null if a problem was recorded. Throws Cancelled.
  std::shared_ptr<const Texture> (*read)(Params&, const AssetSource&);
};

}  // namespace orrery
