#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/meshes/mesh_file.h"

namespace orrery {

// Limits on scene descriptions. Meshes and images have the limits of scenes.
struct ImportLimits {
  std::size_t bytes = std::size_t{1} << 30;  // all files of a scene together, without meshes and images
  std::size_t files = 10'000;                // files that the scene includes
  std::size_t include_depth = 32;            // nested includes
  std::size_t block_depth = 1'000;           // open attribute blocks
  std::size_t objects = 1'000'000;           // objects and instances together
  std::size_t definitions = 1'000'000;       // named things: materials, textures, objects, coordinate systems
  std::size_t mesh_vertices = 10'000'000;    // vertices and triangles of meshes in the description
};

struct ImportOptions {
  // From the written scene to the description: "" or "models/room/". None: the written scene cannot refer to
  // files of the description.
  std::optional<std::string> folder = "";
  std::string file_stem = {};  // start of the names of further files; empty: there can be none
  ImportLimits limits = {};
};

// Mesh or image that a converted scene refers to by name.
struct ImportedFile {
  std::string name, bytes;
};

struct ImportedScene {
  nlohmann::ordered_json scene;
  std::vector<std::string> notes;  // sentences without a full stop about contents that the scene lacks
  std::vector<ImportedFile> files;
};

// Converts a scene description of pbrt-v4, or of Mitsuba 0.6, 2 or 3 if the text begins with "<". `name`
// names the file in errors. `nearby` reads the other files of the scene, by their names relative to it.
// Throws InputError: the pointer is "file:line", the detail states the value and the limit. Throws Cancelled
// and std::bad_alloc. Thread-safe.
ImportedScene import_scene(const std::string& text, const std::string& name, const ReadNearby& nearby,
                           const ImportOptions& options = {});

}  // namespace orrery
