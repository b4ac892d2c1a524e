#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/base/shorten.h"
#include "core/load/asset_files.h"
#include "core/meshes/inspection.h"
#include "core/model/model_images.h"
#include "core/params/params.h"
#include "server/commands/commands.h"
#include "server/commands/help_layout.h"

namespace orrery {
namespace {

constexpr const char* kInspectExamples = R"(
Examples:
  orrery inspect part.stl
  orrery inspect chair.glb --json
  orrery inspect chair.zip

Prints size, triangles, whether the mesh is watertight, and what the file
contains that is not modelled. Lengths are in the units of the file. A ZIP
archive is read as the one model in it, with the files that the model names.
)";

struct InspectOptions {
  std::string model;
  bool json = false;
};

nlohmann::ordered_json numbers(const Vec3d& v) { return {v.x, v.y, v.z}; }

nlohmann::ordered_json material_names(const MeshModel& model) {
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  for (const ModelMaterial& material : model.materials) names.push_back(material.name);
  return names;
}

nlohmann::ordered_json animations_json(const MeshModel& model) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ModelAnimation& animation : model.animations)
    list.push_back({{"name", animation.name}, {"seconds", animation.seconds}});
  return list;
}

nlohmann::ordered_json inspection_json(const ModelFile& model, const MeshInspection& found) {
  return {{"format", name_of(model.model->format)},
          {"bytes", model.bytes},
          {"vertices", model.model->mesh.positions.size()},
          {"triangles", model.model->mesh.triangles.size()},
          {"triangles_without_area", found.triangles_without_area},
          {"min", numbers(found.bounds.lo)},
          {"max", numbers(found.bounds.hi)},
          {"unit",
           model.model->unit.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(model.model->unit)},
          {"watertight", found.watertight},
          {"area", found.area},
          {"volume", found.watertight ? nlohmann::ordered_json(found.volume) : nullptr},
          {"normals", !model.model->mesh.normals.empty()},
          {"texture_coordinates", !model.model->mesh.uvs.empty()},
          {"vertex_colors", !model.model->mesh.colors.empty()},
          {"materials", material_names(*model.model)},
          {"images", model.model->images.size()},
          {"cameras", model.model->cameras.size()},
          {"lights", model.model->lights.size()},
          {"animations", animations_json(*model.model)},
          {"variants", model.model->variants},
          {"notes", notes_of(*model.model)}};
}

std::string row(const char* name, const std::string& text) {
  std::string line(name);
  line.resize(12, ' ');
  return line + text + "\n";
}
std::string text_of(const Vec3d& v) {
  return number_text(v.x) + ", " + number_text(v.y) + ", " + number_text(v.z);
}

std::string inspection_text(const ModelFile& model, const MeshInspection& found) {
  const TriangleMesh& mesh = model.model->mesh;
  const Vec3d size = found.bounds.hi - found.bounds.lo;
  std::string text =
      row("format", std::string(name_of(model.model->format)) + ", " + grouped(model.bytes) + " bytes");
  text += row("triangles", grouped(mesh.triangles.size()) +
                               (found.triangles_without_area > 0
                                    ? ", " + grouped(found.triangles_without_area) + " of them without area"
                                    : ""));
  text += row("vertices", grouped(mesh.positions.size()) + (mesh.normals.empty() ? "" : ", with normals") +
                              (mesh.uvs.empty() ? "" : ", with texture coordinates") +
                              (mesh.colors.empty() ? "" : ", with colours"));
  if (const std::size_t count = model.model->materials.size(); count > 0)
    text += row("materials", grouped(count) + ", with " + grouped(model.model->images.size()) + " images");
  for (const ModelAnimation& animation : model.model->animations)
    text += row("animation", shortened(animation.name) + ", " + number_text(animation.seconds) + " s");
  if (const auto& variants = model.model->variants; !variants.empty())
    text += row("variants", shortened_names(variants));
  text += row("size", number_text(size.x) + " x " + number_text(size.y) + " x " + number_text(size.z) +
                          (model.model->unit.empty() ? "" : " " + model.model->unit));
  text += row("box", text_of(found.bounds.lo) + " to " + text_of(found.bounds.hi));
  text += row("watertight", found.watertight ? "yes, volume " + number_text(found.volume) : "no");
  text += row("area", number_text(found.area));
  for (const std::string& note : notes_of(*model.model)) text += row("note", note);
  return text;
}

int inspect(const InspectOptions& options) {
  const ModelFile model = read_model_file(options.model);
  const MeshInspection found = inspect_mesh(model.model->mesh);
  std::cout << (options.json ? inspection_json(model, found).dump(2) + "\n" : inspection_text(model, found));
  return kDone;
}

}  // namespace

Command add_inspect(CLI::App& root) {
  const auto options = std::make_shared<InspectOptions>();
  CLI::App* app = root.add_subcommand("inspect", "Print size, triangles and contents of a model");
  app->footer(kInspectExamples);
  app->add_option("MODEL", options->model, "OBJ, PLY, STL, 3MF or glTF file, or - for standard input")
      ->required()
      ->group("Arguments");
  app->add_flag("--json", options->json, "Print JSON")->group("Output");
  return {app, [options] { return inspect(*options); }};
}

}  // namespace orrery
