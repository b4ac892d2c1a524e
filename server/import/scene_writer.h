#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/meshes/mesh_file.h"
#include "server/import/import.h"
#include "server/import/notes.h"
#include "server/import/place.h"
#include "server/import/placement.h"

namespace orrery {

using SceneJson = nlohmann::ordered_json;

// Builds the JSON of a converted scene. Equal materials, textures and models are written once. Functions
// throw InputError at the place that was set last. Not thread-safe.
class SceneWriter {
 public:
  explicit SceneWriter(const ImportOptions& options);
  SceneWriter(const SceneWriter&) = delete;

  // Sets the place of errors.
  void at(const ImportPlace& place) { place_ = place; }
  const ImportPlace& place() const { return place_; }
  ImportNotes& notes() { return notes_; }
  const ImportLimits& limits() const { return options_.limits; }
  // Throws InputError at the place.
  [[noreturn]] void refuse(const std::string& detail) const { refuse_at(place_, detail); }

  // Sets a top-level key.
  void set(const char* key, SceneJson value) { scene_[key] = std::move(value); }
  const SceneJson* find(const char* key) const { return scene_.contains(key) ? &scene_.at(key) : nullptr; }

  // Return the name of a material or texture, which is `wanted` if no other has this name. texture() returns
  // "" if the scene has no room for another texture.
  std::string material(const std::string& wanted, SceneJson material);
  std::string texture(const std::string& wanted, SceneJson texture);
  void add_light(SceneJson light);

  // Add an object to the open model, or to the scene. add_placed() maps it by an instance unless the map is
  // the identity.
  void add_object(SceneJson object);
  void add_placed(SceneJson object, const Affined& map);
  // Adds a mesh in the scene, or in a file if it is large.
  void add_mesh(const TriangleMesh& mesh, const std::string& material);

  // Objects between these calls belong to a model.
  void begin_model(const std::string& name);
  void end_model();
  bool in_model() const { return open_ != nullptr; }
  bool has_model(const std::string& name) const { return groups_.contains(name); }
  // Adds the objects of a model. REQUIRES: has_model(name).
  void add_instance(const std::string& name, const Affined& map);

  // Adds a file to be written to the folder of the scene, and returns its name. REQUIRES: writes_files().
  std::string add_file(const std::string& ending, std::string bytes);
  bool writes_files() const { return !options_.file_stem.empty(); }

  // Returns the name of a file of the description for the written scene.
  std::string file_name(const std::string& name) const;
  // Return a point or direction as JSON. Throw InputError unless it is finite and within the range of scenes.
  SceneJson point(const Vec3d& p) const;
  SceneJson direction(const Vec3d& d) const { return point(safe_normalize(d)); }
  // Returns a colour as JSON, clamped to 0 to `most` with a note.
  SceneJson color(const Vec3d& c, double most = 1e6);

  // Returns the scene. Throws InputError if it has no objects.
  ImportedScene finish();

 private:
  struct Group {
    SceneJson objects = SceneJson::array();
    std::vector<std::pair<std::string, Affined>> placed;  // models of one object
  };
  // Names of JSON values, each of which is written once.
  struct Named {
    std::map<std::string, std::string> by_content;
    std::map<std::string, int> used;  // number of names that were tried, by their start
    std::map<std::string, bool> names;
  };

  std::string name_of(Named& named, const char* key, const std::string& wanted, SceneJson value);
  std::string free_name(Named& named, const std::string& wanted);
  Group& group() { return open_ != nullptr ? *open_ : root_; }
  void count_object();
  std::string model_of(SceneJson objects, const std::string& wanted);
  void write_instance(const std::string& model, const Affined& map);

  const ImportOptions& options_;
  ImportNotes notes_;
  ImportPlace place_;
  SceneJson scene_;
  Named materials_, textures_, models_;
  Group root_;
  std::map<std::string, Group> groups_;
  std::map<std::string, std::string> group_models_;  // model of the objects of a group
  Group* open_ = nullptr;
  std::vector<ImportedFile> files_;
  std::size_t objects_ = 0, vertices_ = 0, inline_values_ = 0;
};

}  // namespace orrery
