#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>

#include "core/load/asset_files.h"
#include "core/load/load.h"
#include "core/params/json.h"
#include "server/import/import.h"
#include "tests/support/pictures.h"
#include "tests/support/scenes.h"

// Conversion of scene descriptions in memory.
namespace orrery::test {

using Files = std::map<std::string, std::string>;

inline ReadNearby files_of(const Files& files) {
  return [files](const std::string& name) {
    const auto found = files.find(name);
    if (found == files.end()) throw InputError("", "no such file");
    return found->second;
  };
}

inline ImportedScene imported(const std::string& text, const Files& files = {},
                              const ImportOptions& options = {.file_stem = "made-"}) {
  return import_scene(text, "x.scene", files_of(files), options);
}

// Returns the first problem of a description, as "file:line: detail", or "accepted".
inline std::string import_problem(const std::string& text, const Files& files = {},
                                  const ImportOptions& options = {}) {
  try {
    imported(text, files, options);
  } catch (const InputError& error) {
    return error.problems().front().text();
  }
  return "accepted";
}

// Loads a scene with files, which it stores in a folder meanwhile.
inline std::shared_ptr<const Scene> load_with(const Json& scene, const Files& files) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("orrery-import-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (const auto& [name, bytes] : files) std::ofstream(folder / name, std::ios::binary) << bytes;
  const std::shared_ptr<const Scene> loaded = load_scene(document_of(scene), AssetFiles(folder));
  std::filesystem::remove_all(folder);
  return loaded;
}

// Loads a converted scene with the files that it refers to. `render` replaces its render options.
inline std::shared_ptr<const Scene> loaded(const ImportedScene& from, Files files = {},
                                           const Json& render_options = {{"technique", "raycast"}}) {
  for (const ImportedFile& file : from.files) files[file.name] = file.bytes;
  Json scene = from.scene;
  scene["render"] = render_options;
  return load_with(scene, files);
}

// Centre of the bright pixels of an image, in pixels from the upper left.
struct Spot2 {
  double x = 0, y = 0;
  int pixels = 0;
};
inline Spot2 bright_spot(const Picture& picture) {
  Spot2 spot;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (picture.at(x, y).x > 0.5f) {
        spot.x += x + 0.5;
        spot.y += y + 0.5;
        ++spot.pixels;
      }
  return {spot.x / std::max(1, spot.pixels), spot.y / std::max(1, spot.pixels), spot.pixels};
}

inline Vec3f centre_of(const Picture& picture) { return picture.at(picture.width / 2, picture.height / 2); }

}  // namespace orrery::test
