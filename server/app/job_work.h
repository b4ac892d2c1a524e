#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/plan/request.h"
#include "core/render/renderer.h"
#include "server/http/shared_bytes.h"

namespace orrery {

// Immutable file made by a job.
struct JobResult {
  std::string name;       // in error messages: "frame 3"
  std::string_view type;  // "image/png"
  // Number of first steps that the file needs, or nullopt for all.
  std::optional<int> after;
  // Returns the bytes, with links below `prefix`. All readers share the bytes of a file without links.
  // REQUIRES: the job's status reports these steps as done.
  std::function<SharedBytes(const std::string& prefix)> read;
};

// Kind of job: renders one image of a scene per step and makes files of the images. Each kind is a class of
// its own, next to its routes in a file of server/routes/. Job calls steps(), request(), storage() and add()
// on its thread, encode() and keep() on pool threads. The other functions are safe from any thread.
class JobWork {
 public:
  virtual ~JobWork() = default;

  // Returns the number of images, at least 1 and at least the number of added images. It may decrease when an
  // image is added.
  virtual int steps() const = 0;
  // Returns the request for image `step`, 0 <= step < steps(). REQUIRES: not all images were added.
  virtual RenderRequest request(int step) const = 0;
  virtual FilmStorage storage() const = 0;

  // Takes the next image. Images are added in order.
  virtual void add(const RenderResult& /*rendered*/) {}
  // Returns the bytes to store for an image. Called by several threads at once.
  virtual std::string encode(const Film& film) const = 0;
  // Stores the result of encode(). Calls come one at a time, in order, and before the step is reported as
  // done.
  virtual void keep(int step, std::string&& encoded) = 0;

  // Called after the last image. Releases state that only add() and keep() need.
  virtual void end() {}

  // Returns status members with links to the files of job `job_id`, and of a step that is done.
  virtual nlohmann::ordered_json links(const std::string& job_id) const = 0;
  virtual nlohmann::ordered_json links_of_step(const std::string& job_id, int step) const = 0;
  // Returns the other status members of the job after `steps_done` steps, and of a step that is done.
  virtual nlohmann::ordered_json status_fields(int steps_done) const = 0;
  virtual nlohmann::ordered_json step_fields(int step) const = 0;
  // Returns the file of job `job_id` at `path`. Throws NotFound if there is none.
  virtual JobResult result(const std::string& job_id, std::string_view path) const = 0;
};

}  // namespace orrery
