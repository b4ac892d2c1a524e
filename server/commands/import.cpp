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
output: scene-import-1.ply.
)";

struct ImportFlags {
  std::string scene, output = "-";
};

fs::path folder_of(const std::string& path) {
  const fs::path folder = path == "-" ? fs::path() : fs::path(path).parent_path();
  return folder.empty() ? "." : folder;
}

// Returns how the written scene refers to files.
ImportOptions import_options(const ImportFlags& flags) {
  ImportOptions options;
  if (flags.output == "-") return options;
  options.file_stem = fs::path(flags.output).stem().string() + "-import-";
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

// Writes the files that the conversion made. Removes them unless the scene is valid, and throws BadScene.
void write_files(const ImportFlags& flags, const std::string& name, const ImportedScene& imported) {
  const fs::path folder = folder_of(flags.output == "-" ? flags.scene : flags.output);
  for (const ImportedFile& file : imported.files) write_file((folder / file.name).string(), file.bytes);
  try {
    load_scene(document_of(imported.scene), AssetFiles(folder));
  } catch (const InputError& error) {
    std::error_code ignored;
    for (const ImportedFile& file : imported.files) fs::remove(folder / file.name, ignored);
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
  write_files(flags, name, imported);
  for (const std::string& note : imported.notes)
    std::cerr << "orrery: warning: " << name << ": " << note << "\n";
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
