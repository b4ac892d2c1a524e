#pragma once

#include <cstddef>
#include <vector>

#include "core/model/texture.h"
#include "core/params/params.h"

namespace orrery {

// Parameter of a material type that may be textured, and its place in the inputs of the type.
struct TexturedField {
  std::size_t first, count;  // numbers from the start of the inputs: 1 number, or 3 of a colour
};

// Reads the inputs of one material: parameters that may be textured, and through plain() all others. Each
// function reads one parameter into a member of the inputs. If the parameter is a texture, it records the use
// and sets the member to the smallest value. The n-th call has slot n. Records problems in Params.
class MaterialParams {
 public:
  // `textures` is null if no parameter may be textured. `inputs` is the first of the numbers to read into.
  MaterialParams(Params& params, const TextureNames* textures, double* inputs)
      : params_(params), textures_(textures), inputs_(inputs) {}

  Params& plain() { return params_; }

  // The following functions correspond to the functions of Params with the same names.
  void number(double& into, std::string_view key, std::string_view doc, const Range& range,
              Fallback<double> fallback = {});
  void color(Vec3d& into, std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {},
             double max = kMaxColor);
  void coefficient(Vec3d& into, std::string_view key, std::string_view doc, Fallback<Vec3d> fallback = {},
                   double max = kMaxColor);
  // Reads a coefficient whose default is `offset` + `scale` * `of`, where `of` was read before.
  void coefficient_like(Vec3d& into, std::string_view key, std::string_view doc, const Vec3d& of,
                        double scale, double offset, double max = kMaxColor);

  // Returns the smallest or largest value of a member that was read before.
  Vec3d least(const Vec3d& member) const { return bound(member, &TextureUse::least); }
  Vec3d most(const Vec3d& member) const { return bound(member, &TextureUse::most); }

  // Returns whether a member that was read before is textured. Raises the values of the texture to at least
  // `least`.
  bool raise_texture(const double& member, double least);

  // Uses by ascending slot.
  const std::vector<TextureUse>& uses() const { return uses_; }
  // Fields by slot.
  const std::vector<TexturedField>& fields() const { return fields_; }

 private:
  // Adds a field. Returns its slot.
  int add_field(const double& first, std::size_t count);
  // Returns true if the value of `key` is a texture, and then records its use.
  bool read_texture(std::string_view key, const Range& range, int slot, bool is_color);
  const TextureUse* use_of(const double& first) const;
  Vec3d bound(const Vec3d& member, Vec3d TextureUse::*end) const;

  Params& params_;
  const TextureNames* textures_;
  double* inputs_;
  std::vector<TexturedField> fields_;
  std::vector<TextureUse> uses_;
};

// Reads the reference to a texture in `p`: name, channel, scale, tint and offset. Sets `least` and `most` to
// the bounds of the value.
TextureUse read_texture_use(Params& p, const TextureNames& textures, bool is_color);

}  // namespace orrery
