#include "server/import/pbrt_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/base/shorten.h"
#include "core/meshes/text.h"
#include "core/params/params.h"
#include "core/params/suggest.h"
#include "server/import/description_files.h"
#include "server/import/pbrt_state.h"

namespace orrery {
namespace {

constexpr std::size_t kMaxAttributeNumbers = 64;  // shapes copy the parameters of Attribute

class PbrtReader {
 public:
  PbrtReader(const ReadNearby& nearby, const ImportOptions& options)
      : writer_(options),
        files_(nearby, writer_.limits()),
        spectra_(nearby),
        pbrt_{writer_, spectra_, nearby} {}

  ImportedScene read(const std::string& text, const std::string& name) {
    writer_.set("title", shortened(as_utf8(name), 100));
    read_file(text, name);
    if (!blocks_.empty()) refuse_at(blocks_.back().place, "block must have an end (got none)");
    writer_.at({name, 1});
    if (!in_world_) writer_.refuse("scene must have WorldBegin (got none)");
    return writer_.finish();
  }

 private:
  using Method = void (PbrtReader::*)(PbrtLexer&);
  struct Directive {
    std::string_view name;
    Method read;
  };
  enum class BlockKind { attribute, transform, object };
  struct Block {
    BlockKind kind;
    PbrtState state;
    ImportPlace place;
  };

  static const std::array<Directive, 35>& directives();

  void read_file(const std::string& text, const std::string& name) {
    files_.count(text, name);
    if (text.starts_with("\x1f\x8b")) refuse_at({name, 1}, "file must not be compressed (got gzip)");
    const bool has_mark = text.starts_with("\xEF\xBB\xBF");
    PbrtLexer lexer(std::string_view(text).substr(has_mark ? 3 : 0), name);
    for (PbrtToken token = lexer.next(); !token.is(PbrtToken::Kind::end); token = lexer.next()) {
      writer_.at(lexer.place_of(token));
      if (!token.is(PbrtToken::Kind::word))
        writer_.refuse("line must begin with a directive, such as Shape (got " + excerpt(token.text) + ")");
      read_directive(token, lexer);
    }
  }

  void read_directive(const PbrtToken& word, PbrtLexer& lexer) {
    if (is_pbrt_transform(word.text)) return transform(word.text, lexer);
    std::vector<std::string_view> names;
    for (const Directive& one : directives()) {
      if (one.name == word.text) return (this->*one.read)(lexer);
      names.push_back(one.name);
    }
    writer_.refuse("directive must be one of pbrt's (got " + excerpt(word.text) +
                   question_of(nearest(word.text, names)) + ")");
  }

  std::string quoted(PbrtLexer& lexer, const char* what) {
    const PbrtToken token = lexer.next();
    if (!token.is(PbrtToken::Kind::text))
      writer_.refuse(std::string(what) + " must be in quotes (got " +
                     (token.text.empty() ? "nothing" : excerpt(token.text)) + ")");
    return unescaped(token.text);
  }

  // Returns the parameters of a directive, with those of Attribute for its target.
  PbrtParameters parameters(PbrtLexer& lexer, const std::string& target = "") {
    PbrtParameters read = PbrtParameters::read(lexer);
    const auto defaults = state_.defaults->find(target);
    if (defaults != state_.defaults->end()) read.add_defaults(defaults->second);
    return read;
  }

  Affined map() const { return writer_.in_model() ? state_.ctm : compose(mirror_, state_.ctm); }

  void require_world(const char* what) {
    if (!in_world_) writer_.refuse(std::string(what) + " must be after WorldBegin");
  }

  // -- Transformations --

  void transform(std::string_view directive, PbrtLexer& lexer) {
    const PbrtTransform read = pbrt_transform(directive, lexer);
    if (read.target_distance > 0) view_.target_distance = read.target_distance;
    if (!state_.changes_start) return;
    state_.ctm = directive == "Transform" ? read.map : compose(state_.ctm, read.map);
    for (const Vec3d& v : {state_.ctm.x, state_.ctm.y, state_.ctm.z, state_.ctm.origin})
      if (!std::isfinite(dot(v, v)))
        writer_.refuse("transformation must be finite (got a number past 1e154)");
  }
  void identity(PbrtLexer&) { state_.ctm = {}; }
  void coordinate_system(PbrtLexer& lexer) {
    systems_[quoted(lexer, "name of a coordinate system")] = state_.ctm;
  }
  void coord_sys_transform(PbrtLexer& lexer) {
    const std::string name = quoted(lexer, "name of a coordinate system");
    const auto found = systems_.find(name);
    if (found == systems_.end())
      writer_.refuse("coordinate system must be defined before it is used (got " + excerpt(name) + ")");
    state_.ctm = found->second;
  }
  void reverse_orientation(PbrtLexer&) { state_.reversed = !state_.reversed; }
  void active_transform(PbrtLexer& lexer) {
    const std::string_view which = lexer.next().text;
    if (which != "All" && which != "StartTime" && which != "EndTime")
      writer_.refuse("ActiveTransform must be followed by All, StartTime or EndTime (got " + excerpt(which) +
                     ")");
    if (which != "All") pbrt_.notes().add("motion (ActiveTransform) is left out");
    state_.changes_start = which != "EndTime";
  }
  void transform_times(PbrtLexer& lexer) { read_numbers(lexer, 2, "TransformTimes"); }

  // -- Blocks --

  void begin(BlockKind kind) {
    if (blocks_.size() >= writer_.limits().block_depth)
      writer_.refuse("blocks must be nested at most " + grouped(writer_.limits().block_depth) +
                     " deep (got more)");
    blocks_.push_back({kind, state_, writer_.place()});
  }
  void end(BlockKind kind, const char* name) {
    if (blocks_.empty() || blocks_.back().kind != kind)
      writer_.refuse(std::string(name) + " must close the innermost open block (got " +
                     (blocks_.empty() ? "no open block" : "another block") + ")");
    if (kind == BlockKind::transform)
      state_.ctm = blocks_.back().state.ctm;
    else
      state_ = std::move(blocks_.back().state);
    blocks_.pop_back();
  }
  void attribute_begin(PbrtLexer&) { begin(BlockKind::attribute); }
  void attribute_end(PbrtLexer&) { end(BlockKind::attribute, "AttributeEnd"); }
  void transform_begin(PbrtLexer&) { begin(BlockKind::transform); }
  void transform_end(PbrtLexer&) { end(BlockKind::transform, "TransformEnd"); }
  void object_begin(PbrtLexer& lexer) {
    require_world("ObjectBegin");
    const std::string name = quoted(lexer, "name of an object");
    if (writer_.in_model()) writer_.refuse("ObjectBegin must not be inside another object");
    begin(BlockKind::object);
    writer_.begin_model(name);
  }
  void object_end(PbrtLexer&) {
    end(BlockKind::object, "ObjectEnd");
    writer_.end_model();
  }
  void object_instance(PbrtLexer& lexer) {
    const std::string name = quoted(lexer, "name of an object");
    if (writer_.in_model()) writer_.refuse("ObjectInstance must not be inside an object");
    if (!writer_.has_model(name))
      writer_.refuse("object must be defined before it is used (got " + excerpt(name) + ")");
    writer_.add_instance(name, map());
  }
  void attribute(PbrtLexer& lexer) {
    const std::string target = quoted(lexer, "target of Attribute");
    PbrtParameters read = PbrtParameters::read(lexer);
    read.require_few_numbers(kMaxAttributeNumbers);
    auto defaults = *state_.defaults;
    read.add_defaults(defaults[target]);
    defaults[target] = std::move(read);
    state_.defaults = std::make_shared<const std::map<std::string, PbrtParameters>>(std::move(defaults));
  }

  // -- Options of the image --

  void camera(PbrtLexer& lexer) {
    view_.camera = quoted(lexer, "type of a camera");
    view_.camera_parameters = parameters(lexer);
    if (scaled_determinant(state_.ctm) == 0)
      writer_.refuse("camera must have a transformation with an inverse");
    view_.map = inverse(state_.ctm);
    systems_["camera"] = view_.map;
  }
  void film(PbrtLexer& lexer) {
    quoted(lexer, "type of a film");
    view_.film_parameters = parameters(lexer);
  }
  void sampler(PbrtLexer& lexer) {
    quoted(lexer, "type of a sampler");
    sampler_ = parameters(lexer);
  }
  void integrator(PbrtLexer& lexer) {
    quoted(lexer, "type of an integrator");
    integrator_ = parameters(lexer);
  }
  void pixel_filter(PbrtLexer& lexer) {
    filter_ = quoted(lexer, "type of a filter");
    parameters(lexer);
  }
  void accelerator(PbrtLexer& lexer) {
    quoted(lexer, "type of an accelerator");
    parameters(lexer);
  }
  void option(PbrtLexer& lexer) { parameters(lexer); }
  void color_space(PbrtLexer& lexer) {
    const std::string name = quoted(lexer, "name of a colour space");
    if (name != "srgb") pbrt_.notes().add("colour space " + excerpt(name) + " is taken as srgb");
  }
  void world_begin(PbrtLexer&) {
    if (in_world_) writer_.refuse("WorldBegin must be once in a scene (got another one)");
    in_world_ = true;
    if (is_mirrored(view_)) mirror_ = scaling({1, 1, -1});
    view_.map = compose(mirror_, view_.map);
    pbrt_.exposure = pbrt_exposure(pbrt_, view_);
    set_pbrt_view(pbrt_, view_);
    set_pbrt_sampling(pbrt_, sampler_, integrator_, filter_);
    state_.ctm = {};
    systems_["world"] = {};
  }
  void world_end(PbrtLexer&) {}

  // -- Contents of the scene --

  void material(PbrtLexer& lexer) {
    const std::string type = quoted(lexer, "type of a material");
    state_.material = std::make_shared<PbrtMaterial>(
        PbrtMaterial{.name = type, .type = type, .parameters = parameters(lexer, "material")});
  }
  void make_named_material(PbrtLexer& lexer) {
    const std::string name = quoted(lexer, "name of a material");
    PbrtParameters read = parameters(lexer, "material");
    const std::string type = read.text("type", "");
    pbrt_.materials[name] = std::make_shared<PbrtMaterial>(
        PbrtMaterial{.name = name, .type = type, .parameters = std::move(read)});
  }
  void named_material(PbrtLexer& lexer) {
    const std::string name = quoted(lexer, "name of a material");
    const auto found = pbrt_.materials.find(name);
    if (found == pbrt_.materials.end())
      writer_.refuse("material must be defined before it is used (got " + excerpt(name) + ")");
    state_.material = found->second;
  }
  void texture(PbrtLexer& lexer) {
    const std::string name = quoted(lexer, "name of a texture");
    const std::string kind = quoted(lexer, "kind of a texture");
    const std::string type = quoted(lexer, "type of a texture");
    if (kind != "spectrum" && kind != "float" && kind != "color")
      writer_.refuse("kind of a texture must be spectrum or float (got " + excerpt(kind) + ")");
    const PbrtParameters read = parameters(lexer, "texture");
    const bool is_color = kind != "float";
    (is_color ? pbrt_.colors : pbrt_.numbers)[name] = pbrt_texture(pbrt_, name, is_color, type, read);
  }
  void light_source(PbrtLexer& lexer) {
    require_world("LightSource");
    const std::string type = quoted(lexer, "type of a light");
    add_pbrt_light(pbrt_, type, parameters(lexer, "light"), map());
  }
  void area_light_source(PbrtLexer& lexer) {
    const std::string type = quoted(lexer, "type of an area light");
    if (type != "diffuse")
      writer_.refuse("type of an area light must be diffuse (got " + excerpt(type) + ")");
    state_.area_light = std::make_shared<const PbrtParameters>(parameters(lexer, "light"));
  }
  void make_named_medium(PbrtLexer& lexer) {
    quoted(lexer, "name of a medium");
    parameters(lexer);
    pbrt_.notes().add("medium is left out");
  }
  void medium_interface(PbrtLexer& lexer) {
    quoted(lexer, "name of a medium");
    if (lexer.peek().is(PbrtToken::Kind::text)) quoted(lexer, "name of a medium");
  }
  void shape(PbrtLexer& lexer) {
    require_world("Shape");
    const std::string type = quoted(lexer, "type of a shape");
    const PbrtParameters read = parameters(lexer, "shape");
    add_pbrt_shape(pbrt_, {type, read, map(), state_.reversed, *state_.material, state_.area_light.get()});
  }
  void include(PbrtLexer& lexer) {
    const std::string name = quoted(lexer, "name of a file");
    read_file(files_.begin_include(name, writer_.place()), name);
    files_.end_include();
  }
  // The graphics state of an imported file ends with the file.
  void import_file(PbrtLexer& lexer) {
    const PbrtState before = state_;
    include(lexer);
    state_ = before;
  }

  SceneWriter writer_;
  DescriptionFiles files_;
  SpectrumFiles spectra_;
  PbrtScene pbrt_;
  PbrtState state_;
  std::vector<Block> blocks_;
  std::map<std::string, Affined> systems_;
  PbrtView view_;
  PbrtParameters sampler_, integrator_;
  std::string filter_ = "gaussian";
  Affined mirror_;
  bool in_world_ = false;
};

const std::array<PbrtReader::Directive, 35>& PbrtReader::directives() {
  static constexpr std::array<Directive, 35> kAll{{{"Shape", &PbrtReader::shape},
                                                   {"AttributeBegin", &PbrtReader::attribute_begin},
                                                   {"AttributeEnd", &PbrtReader::attribute_end},
                                                   {"TransformBegin", &PbrtReader::transform_begin},
                                                   {"TransformEnd", &PbrtReader::transform_end},
                                                   {"ObjectBegin", &PbrtReader::object_begin},
                                                   {"ObjectEnd", &PbrtReader::object_end},
                                                   {"ObjectInstance", &PbrtReader::object_instance},
                                                   {"Attribute", &PbrtReader::attribute},
                                                   {"Identity", &PbrtReader::identity},
                                                   {"CoordinateSystem", &PbrtReader::coordinate_system},
                                                   {"CoordSysTransform", &PbrtReader::coord_sys_transform},
                                                   {"ReverseOrientation", &PbrtReader::reverse_orientation},
                                                   {"ActiveTransform", &PbrtReader::active_transform},
                                                   {"TransformTimes", &PbrtReader::transform_times},
                                                   {"Camera", &PbrtReader::camera},
                                                   {"Film", &PbrtReader::film},
                                                   {"Sampler", &PbrtReader::sampler},
                                                   {"Integrator", &PbrtReader::integrator},
                                                   {"PixelFilter", &PbrtReader::pixel_filter},
                                                   {"Accelerator", &PbrtReader::accelerator},
                                                   {"Option", &PbrtReader::option},
                                                   {"ColorSpace", &PbrtReader::color_space},
                                                   {"WorldBegin", &PbrtReader::world_begin},
                                                   {"WorldEnd", &PbrtReader::world_end},
                                                   {"Material", &PbrtReader::material},
                                                   {"MakeNamedMaterial", &PbrtReader::make_named_material},
                                                   {"NamedMaterial", &PbrtReader::named_material},
                                                   {"Texture", &PbrtReader::texture},
                                                   {"LightSource", &PbrtReader::light_source},
                                                   {"AreaLightSource", &PbrtReader::area_light_source},
                                                   {"MakeNamedMedium", &PbrtReader::make_named_medium},
                                                   {"MediumInterface", &PbrtReader::medium_interface},
                                                   {"Include", &PbrtReader::include},
                                                   {"Import", &PbrtReader::import_file}}};
  return kAll;
}

}  // namespace

ImportedScene import_pbrt(const std::string& text, const std::string& name, const ReadNearby& nearby,
                          const ImportOptions& options) {
  return PbrtReader(nearby, options).read(text, name);
}

}  // namespace orrery
