#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/meshes/mesh_file.h"
#include "server/import/notes.h"
#include "server/import/pbrt_lexer.h"
#include "server/import/spectrum.h"

namespace orrery {

// Parameter such as "float radius" [ 2 ].
struct PbrtParameter {
  std::string type, name;
  std::vector<double> numbers;
  std::vector<std::string> texts;  // also "true" and "false"
  ImportPlace place;
  mutable bool used = false;
};

// Spectrum files of a scene. Not thread-safe.
class SpectrumFiles {
 public:
  explicit SpectrumFiles(const ReadNearby& nearby) : nearby_(nearby) {}
  // Throws InputError at the place.
  SpectrumTable read(const std::string& name, const ImportPlace& place) const;

 private:
  const ReadNearby& nearby_;
};

// Parameters of one directive. A getter returns the value of a parameter, or the fallback if there is no
// parameter of that name and type. Throws InputError with file, line, value and limit.
class PbrtParameters {
 public:
  PbrtParameters() = default;
  // Reads the parameters up to the next directive.
  static PbrtParameters read(PbrtLexer& lexer);

  const ImportPlace& place() const { return place_; }
  // Adds the parameters of `defaults` that are not given.
  void add_defaults(const PbrtParameters& defaults);

  const PbrtParameter* find(std::string_view name) const;
  // Returns the parameter if it has this type.
  const PbrtParameter* find(std::string_view type, std::string_view name) const;

  double number(std::string_view name, double fallback) const;
  double positive(std::string_view name, double fallback) const;
  int integer(std::string_view name, int fallback, int least, int most) const;
  bool flag(std::string_view name, bool fallback) const;
  std::string text(std::string_view name, const std::string& fallback) const;
  Vec3d point(std::string_view name, const Vec3d& fallback) const;
  std::vector<double> numbers(std::string_view name) const;
  std::vector<Vec3d> points(std::string_view name) const;
  std::vector<std::array<double, 2>> pairs(std::string_view name) const;
  // Returns the name of a texture, or "".
  std::string texture(std::string_view name) const;

  // Colour of a light: of luminance 1, except for "rgb".
  std::optional<Vec3d> light_color(std::string_view name, const SpectrumFiles& files) const;
  std::optional<Vec3d> surface_color(std::string_view name, const SpectrumFiles& files) const;

  // Spectrum of a parameter that exists and has the type "spectrum".
  SpectrumTable index_table(std::string_view name, const SpectrumFiles& files) const;

  // Throws InputError if a parameter has more numbers or texts.
  void require_few_numbers(std::size_t most) const;
  // Marks parameters without an effect on the image.
  void ignore(std::initializer_list<std::string_view> names) const;
  // Adds notes about the parameters that no getter was called for. `owner`: "shape sphere".
  void note_unused(ImportNotes& notes, const std::string& owner) const;

 private:
  double one_number(const PbrtParameter& parameter) const;
  [[noreturn]] static void refuse_size(const PbrtParameter& parameter, const std::string& needed);

  ImportPlace place_;
  std::vector<PbrtParameter> parameters_;
};

// Reads `count` numbers, in brackets or not.
std::vector<double> read_numbers(PbrtLexer& lexer, std::size_t count, std::string_view name);

}  // namespace orrery
