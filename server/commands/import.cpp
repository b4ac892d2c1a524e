#include "server/import/import.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "core/load/asset_files.h"
#include "core/load/load.h"
#include "core/load/scene_file.h"
#include "core/params/json.h"
#include "server/commands/commands.h"
#include "server/commands/help_layout.h"
#include "server/commands/output_file.h"

namespace orrery {
namespace {

namespace fs = std::filesystem;

constexpr const char* kImportExamples = R"(
Examples:
  orrery import scene.pbrt -o scene.json
  orrery import scene.xml -o scene.json && orrery render scene.json -o scene.png
  orrery import scene.pbrt > scene.json      # in the folder of scene.pbrt

Converts a scene of pbrt-v4, or of Mitsuba 0.6, 2 or 3, as far as scenes of
orrery have its shapes, materials, lights and cameras. A warning names each
kind of thing that is replaced or left out. Meshes and images stay where they
are, in the folder of the output or below it. Large meshes of the scene, and
images of the surroundings in other projections, become files beside the
output: scene-1.ply.
)";

struct ImportFlags {
  std::string scene, output = "-";
};

// Files of the written scene: those of the description, and those that the conversion made.
class ImportedAssets final : public AssetSource {
 public:
  ImportedAssets(const fs::path& folder, const std::vector<ImportedFile>& made)
      : files_(folder), made_(made) {}

  MeshModelPtr model_file(const std::string& name, const std::optional<ModelPose>& pose) const override {
    const ImportedFile* const file = find(name);
    if (file == nullptr) return files_.model_file(name, pose);
    return std::make_shared<const MeshModel>(read_model(file->bytes, {}, {}, pose));
  }
  TexelsPtr picture_file(const std::string& name) const override {
    const ImportedFile* const file = find(name);
    if (file == nullptr) return files_.picture_file(name);
    return std::make_shared<const Texels>(read_picture(file->bytes));
  }

 private:
  const ImportedFile* find(const std::string& name) const {
    for (const ImportedFile& file : made_)
      if (file.name == name) return &file;
    return nullptr;
  }

  AssetFiles files_;
  const std::vector<ImportedFile>& made_;
};

fs::path folder_of(const std::string& path) {
  const fs::path folder = path == "-" ? fs::path() : fs::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

// Returns how the written scene refers to files.
ImportOptions import_options(const ImportFlags& flags) {
  ImportOptions options;
  if (flags.output == "-") return options;
  options.file_stem = fs::path(flags.output).stem().string() + "-";
  std::error_code error;
  const fs::path from = fs::canonical(folder_of(flags.output), error);
  if (error) return options;  // require_writable() has reported it
  const fs::path to = fs::canonical(folder_of(flags.scene), error).lexically_relative(from);
  if (to.empty() || *to.begin() == "..")
    options.folder.reset();
  else if (to != ".")
    options.folder = to.generic_string() + "/";
  return options;
}

// Throws BadScene if the scene is not valid.
void check_imported(const ImportFlags& flags, const std::string& name, const ImportedScene& imported) {
  const std::string beside = flags.output == "-" ? flags.scene : flags.output;
  try {
    load_scene(document_of(imported.scene), ImportedAssets(folder_of(beside), imported.files));
  } catch (const InputError& error) {
    throw BadScene(name + ", converted", error);
  }
}

int import(const ImportFlags& flags) {
  require_writable(flags.output);
  const bool is_file = flags.scene != "-";
  const std::string name = is_file ? fs::path(flags.scene).filename().string() : "standard input";
  ImportedScene imported;
  try {
    imported = import_scene(read_file(flags.scene), name, files_near(folder_of(flags.scene) / name),
                            import_options(flags));
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    throw BadScene(problem.pointer.empty() ? name : problem.pointer, InputError("", problem.detail));
  }
  check_imported(flags, name, imported);
  for (const std::string& note : imported.notes)
    std::cerr << "orrery: warning: " << name << ": " << note << "\n";
  for (const ImportedFile& file : imported.files)
    write_file((folder_of(flags.output) / file.name).string(), file.bytes);
  write_file(flags.output,
             imported.scene.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  return kDone;
}

}  // namespace

Command add_import(CLI::App& root) {
  const auto flags = std::make_shared<ImportFlags>();
  CLI::App* app = root.add_subcommand("import", "Convert a scene of pbrt-v4 or Mitsuba to JSON");
  app->footer(kImportExamples);
  app->add_option("SCENE", flags->scene, "pbrt-v4 or Mitsuba scene, or - for standard input")
      ->required()
      ->group("Arguments");
  app->add_option("-o,--output", flags->output, "JSON file, or - for standard output [-]")
      ->type_name("FILE")
      ->group("Output");
  return {app, [flags] { return import(*flags); }};
}

}  // namespace orrery
