#include "core/meshes/mtl.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/base/number.h"
#include "core/base/shorten.h"
#include "core/base/task_scope.h"
#include "core/meshes/formats.h"
#include "core/meshes/note_list.h"
#include "core/meshes/text.h"

// Material libraries of Wavefront OBJ. Format: Wavefront, Material Library File (MTL) Format, 1995. The keys
// Ke, Pr, Pm, norm, map_Ke, map_Pr and map_Pm follow the extension for physically based rendering of the
// program Clara.io, which Blender writes.
namespace orrery {
namespace {

constexpr std::size_t kMaxLibraries = 100;
constexpr std::size_t kMaxMtlNotes = 8;  // notes of each kind
constexpr double kMaxEmittance = 1e6;    // value of Ke; larger ones are reduced
constexpr double kMaxMapScale = 1e5;     // magnitude of -s, -o and -bm
constexpr std::size_t kNameCharacters = 80;

// Map of a material in the file.
struct MtlMap {
  std::string file;
  ModelTexture texture;  // without its image
  double strength = 1;   // -bm
};

// Material in the terms of the file.
struct MtlMaterial {
  std::optional<Vec3d> kd, ks, ke;
  std::optional<double> exponent, dissolve, transparency, illumination, roughness, metallic;
  std::optional<MtlMap> kd_map, ke_map, roughness_map, metallic_map, normal_map;
};

std::string with_slashes(std::string_view name) {
  std::string path(name);
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

// Reads a library. Invalid lines are skipped, with a note.
class LibraryReader {
 public:
  LibraryReader(std::string_view bytes, std::string file, NoteList& problems, std::set<std::string>& unknown)
      : text_(bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes),
        file_(std::move(file)),
        problems_(problems),
        unknown_(unknown) {}

  // Reads the materials whose entries in `wanted` are empty.
  void read(std::map<std::string, std::optional<MtlMaterial>, std::less<>>& wanted) {
    MtlMaterial skipped;
    MtlMaterial* material = &skipped;
    do {
      const std::string_view key = text_.word_of_line();
      if (is_keyword(key, "newmtl")) {
        const auto at = wanted.find(text_.rest_of_line());
        const bool is_wanted = at != wanted.end() && !at->second;
        material = is_wanted ? &at->second.emplace() : &skipped;
        continue;
      }
      try {
        if (!key.empty() && key[0] != '#') read_key(key, *material);
      } catch (const InputError& error) {
        problems_.add(file_ + ": " + error.problems().front().detail);
      }
    } while (text_.next_line());
  }

 private:
  void read_key(std::string_view key, MtlMaterial& material) {
    const std::pair<std::string_view, std::optional<Vec3d> MtlMaterial::*> kColors[] = {
        {"kd", &MtlMaterial::kd}, {"ks", &MtlMaterial::ks}, {"ke", &MtlMaterial::ke}};
    const std::pair<std::string_view, std::optional<double> MtlMaterial::*> kNumbers[] = {
        {"ns", &MtlMaterial::exponent},     {"d", &MtlMaterial::dissolve},
        {"tr", &MtlMaterial::transparency}, {"illum", &MtlMaterial::illumination},
        {"pr", &MtlMaterial::roughness},    {"pm", &MtlMaterial::metallic}};
    const std::pair<std::string_view, std::optional<MtlMap> MtlMaterial::*> kMaps[] = {
        {"map_kd", &MtlMaterial::kd_map},
        {"map_ke", &MtlMaterial::ke_map},
        {"map_pr", &MtlMaterial::roughness_map},
        {"map_pm", &MtlMaterial::metallic_map},
        {"norm", &MtlMaterial::normal_map}};
    for (const auto& [name, member] : kColors)
      if (is_keyword(key, name)) return void(material.*member = read_color(key));
    for (const auto& [name, member] : kNumbers)
      if (is_keyword(key, name)) return void(material.*member = read_number(key));
    for (const auto& [name, member] : kMaps)
      if (is_keyword(key, name)) return void(material.*member = read_map(key));
    // Ambient light has no counterpart. The index of refraction has none for opaque surfaces.
    for (const std::string_view ignored : {"ka", "map_ka", "ni"})
      if (is_keyword(key, ignored)) return;
    if (unknown_.size() < kMaxMtlNotes) unknown_.insert(excerpt(key));
  }

  double read_number(std::string_view key) {
    std::string_view word = text_.word_of_line();
    if (word == "-halo") word = text_.word_of_line();
    return text_.parse_number(word, key);
  }

  // Reads "r g b", or "r" for a grey value.
  Vec3d read_color(std::string_view key) {
    const double red = read_number(key);
    const std::string_view second = text_.word_of_line();
    if (second.empty()) return Vec3d(red);
    const double green = text_.parse_number(second, key);
    return {red, green, read_number(key)};
  }

  // Reads options and the name of a file, which may contain blanks.
  MtlMap read_map(std::string_view key) {
    MtlMap map;
    TextReader ahead = text_;
    for (std::string_view word = ahead.word_of_line(); word.starts_with('-'); word = ahead.word_of_line()) {
      text_.word_of_line();
      read_option(word, map);
      ahead = text_;
    }
    map.file = with_slashes(text_.rest_of_line());
    if (map.file.empty()) text_.fail(std::string(key) + " must name a file");
    return map;
  }

  void read_option(std::string_view option, MtlMap& map) {
    const std::string name(option);
    if (option == "-s" || option == "-o" || option == "-t") {
      const std::array<double, 2> pair = read_pair(name, option == "-s" ? 1 : 0);
      if (option == "-s") map.texture.repeat = pair;
      if (option == "-o") map.texture.shift = pair;
    } else if (option == "-bm") {
      map.strength = checked_scale(name, text_.parse_number(text_.word_of_line(), name));
    } else if (option == "-mm") {
      text_.word_of_line();
      text_.word_of_line();
    } else {
      const std::string_view value = text_.word_of_line();
      if (option == "-clamp" && value == "on")
        map.texture.wrap = map.texture.wrap_v = ModelTexture::Wrap::clamp;
    }
  }

  // Reads one to three numbers. Returns the first two.
  std::array<double, 2> read_pair(const std::string& name, double fallback) {
    std::array<double, 2> pair{fallback, fallback};
    for (std::size_t i = 0; i < 3; ++i) {
      TextReader ahead = text_;
      if (i > 0 && !parse_number<double>(ahead.word_of_line())) break;
      const double number = checked_scale(name, text_.parse_number(text_.word_of_line(), name));
      if (i < 2) pair[i] = number;
    }
    return pair;
  }

  double checked_scale(const std::string& name, double number) const {
    if (!(std::abs(number) <= kMaxMapScale))
      text_.fail(name + " must be at most " + text_of(kMaxMapScale) + " in magnitude (got " +
                 text_of(number) + ")");
    return number;
  }

  TextReader text_;
  std::string file_;
  NoteList& problems_;
  std::set<std::string>& unknown_;  // keys
};

class MtlReader {
 public:
  explicit MtlReader(const ReadNearby& nearby) : nearby_(nearby) {}

  MtlMaterials read(const std::vector<std::string>& libraries, const std::vector<std::string>& used) {
    for (const std::string& name : used) wanted_[name];
    for (const std::string& names : libraries) read_libraries(names);
    for (const std::string& name : used) {
      checkpoint();
      const auto& material = wanted_[name];
      found_.indices.push_back(material ? static_cast<std::int32_t>(found_.materials.size()) : -1);
      if (material)
        found_.materials.push_back(convert(name, *material));
      else
        undefined_.add("material " + excerpt(name, kNameCharacters) + " is not defined");
    }
    if (lacks_library_) undefined_ = {kMaxMtlNotes, ""};  // a consequence of the missing library
    for (NoteList* notes : {&missing_, &undefined_, &problems_}) notes->move_to(found_.notes);
    for (const std::string& key : unknown_)
      found_.notes.push_back("key " + key + " of materials is not modelled");
    return std::move(found_);
  }

 private:
  // Reads the file that a line "mtllib" names, or the files, if no file has the whole line as its name.
  void read_libraries(const std::string& names) {
    std::string problem;
    if (read_library(names, problem)) return;
    TextReader words(names);
    std::size_t count = 0, read = 0;
    for (std::string_view word = words.word(); !word.empty() && word != names; word = words.word()) {
      ++count;
      if (read_library(std::string(word), problem)) ++read;
    }
    if (count > 0 && read == count) return;
    lacks_library_ = true;
    missing_.add("material library " + excerpt(names, kNameCharacters) + " is missing: " + problem);
  }

  // Returns true if the library could be read, now or before.
  bool read_library(const std::string& name, std::string& problem) {
    if (const auto known = read_names_.find(name); known != read_names_.end()) return known->second;
    if (read_names_.size() >= kMaxLibraries) {
      problem = "files may name at most " + grouped(kMaxLibraries) + " libraries";
      return false;
    }
    const auto bytes = read_file(with_slashes(name), problem);
    read_names_[name] = bytes.has_value();
    if (bytes) LibraryReader(*bytes, excerpt(name, kNameCharacters), problems_, unknown_).read(wanted_);
    return bytes.has_value();
  }

  // Reads a file by its path, or by its name alone, because paths are often those of another machine. Returns
  // nullopt and sets `problem` if neither can be read.
  std::optional<std::string> read_file(const std::string& path, std::string& problem) const {
    if (!nearby_) {
      problem = "other files are not available";
      return std::nullopt;
    }
    try {
      return nearby_(path);
    } catch (const InputError& error) {
      problem = error.problems().front().detail;
    }
    const std::size_t slash = path.rfind('/');
    if (slash == path.npos) return std::nullopt;
    try {
      return nearby_(path.substr(slash + 1));
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  ModelMaterial convert(const std::string& name, const MtlMaterial& from) {
    ModelMaterial to;
    to.name = as_utf8(name);
    to.base_color.factor = clamped(from.kd.value_or(Vec3d(1)), 1);
    to.base_color.texture = texture_of(from.kd_map);
    to.emission.factor = clamped(from.ke.value_or(Vec3d(0)), kMaxEmittance);
    to.emission.texture = texture_of(from.ke_map);
    to.metallic.factor = std::clamp(from.metallic.value_or(0), 0.0, 1.0);
    to.metallic.texture = texture_of(from.metallic_map);
    to.roughness.factor = std::clamp(from.roughness.value_or(roughness_of(from)), 0.0, 1.0);
    to.roughness.texture = texture_of(from.roughness_map);
    // Many programs write 0 for a value that a map replaces.
    const auto replace_zero = [](auto& value, const auto& one) {
      if (value.texture && value.factor == one * 0) value.factor = one;
    };
    replace_zero(to.base_color, Vec3d(1));
    replace_zero(to.emission, Vec3d(1));
    replace_zero(to.metallic, 1.0);
    if (to.roughness.texture && from.roughness.value_or(0) == 0) to.roughness.factor = 1;
    to.metallic_channel = to.roughness_channel = ModelMaterial::Channel::luminance;
    if (const auto texture = texture_of(from.normal_map)) to.normal = {from.normal_map->strength, texture};
    const double opacity = from.dissolve ? *from.dissolve : 1 - from.transparency.value_or(0);
    to.opacity = std::clamp(opacity, 0.0, 1.0);
    if (to.opacity < 1) to.alpha = ModelMaterial::Alpha::blend;
    return to;
  }

  // Colours are taken as linear. The format defines no encoding, and programs write both.
  static Vec3d clamped(const Vec3d& color, double most) {
    const auto clamp = [&](double x) { return std::clamp(x, 0.0, most); };
    return {clamp(color.x), clamp(color.y), clamp(color.z)};
  }

  // Returns the roughness of the Blinn-Phong exponent: alpha = roughness^2 = sqrt(2 / (Ns + 2)). Walter et
  // al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007, compare both lobes. Returns 1
  // for a material without a highlight.
  static double roughness_of(const MtlMaterial& from) {
    const bool shines = from.ks.value_or(Vec3d(0)) != Vec3d(0) && from.illumination.value_or(2) >= 2;
    if (!shines) return 1;
    return std::pow(2 / (std::max(0.0, from.exponent.value_or(0)) + 2), 0.25);
  }

  std::optional<ModelTexture> texture_of(const std::optional<MtlMap>& map) {
    if (!map) return std::nullopt;
    const auto image = image_of(map->file);
    if (!image) return std::nullopt;
    ModelTexture texture = map->texture;
    texture.image = *image;
    return texture;
  }

  // Returns the index of an image in found_.images.
  std::optional<int> image_of(const std::string& file) {
    if (const auto known = images_.find(file); known != images_.end()) return known->second;
    std::string problem;
    auto bytes = read_file(file, problem);
    if (!bytes) {
      missing_.add("image " + excerpt(file, kNameCharacters) + " is missing: " + problem);
      return images_[file] = std::nullopt;
    }
    found_.images.push_back(
        {shortened(as_utf8(file), kNameCharacters), std::make_shared<const std::string>(std::move(*bytes))});
    return images_[file] = static_cast<int>(found_.images.size()) - 1;
  }

  const ReadNearby& nearby_;
  MtlMaterials found_;
  std::map<std::string, std::optional<MtlMaterial>, std::less<>> wanted_;  // by name
  std::map<std::string, bool> read_names_;            // libraries: whether they could be read
  std::map<std::string, std::optional<int>> images_;  // by name in the file
  NoteList missing_{kMaxMtlNotes, " more files are missing"},
      undefined_{kMaxMtlNotes, " more materials are not defined"},
      problems_{kMaxMtlNotes, " more lines of material libraries are invalid"};
  std::set<std::string> unknown_;  // keys that are not modelled
  bool lacks_library_ = false;
};

}  // namespace

MtlMaterials read_mtl(const std::vector<std::string>& libraries, const std::vector<std::string>& used,
                      const ReadNearby& nearby) {
  return MtlReader(nearby).read(libraries, used);
}

}  // namespace orrery
