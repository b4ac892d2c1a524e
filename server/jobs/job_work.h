#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/budget/renderer.h"
#include "core/image/encode/files.h"
#include "core/plan/request.h"
#include "server/base/shared_bytes.h"

namespace orrery {

// Immutable file made by a job.
struct JobResult {
  std::string name;       // in error messages: "frame 3"
  std::string_view type;  // "image/png"
  // Number of steps that must be done before the file can be read, or nullopt for all steps.
  std::optional<int> after;
  // Returns the file. Its links start with `prefix`. A file without links is shared by all readers, not
  // copied. REQUIRES: the job's status reports these steps as done.
  std::function<SharedBytes(const std::string& prefix)> read;
};

// Kind of job: renders one image of a scene per step and makes files from the images. Each kind is a class in
// the file of its routes in server/routes/. Job calls steps(), request(), format(), add() and end() on its
// thread, and encode() and keep() on pool threads. The other functions must be thread-safe.
class JobWork {
 public:
  virtual ~JobWork() = default;

  // Returns the number of images, at least 1 and at least the number of added images. It may decrease when an
  // image is added.
  virtual int steps() const = 0;
  // Returns the request for image `step`, 0 <= step < steps(). REQUIRES: fewer than steps() images were
  // added.
  virtual RenderRequest request(int step) const = 0;
  // Returns the format that determines the storage of the films; see storage_for().
  virtual FileFormat format() const = 0;

  // Takes the next image. Images are added in order.
  virtual void add(const RenderResult& /*rendered*/) {}
  // Returns the bytes to store for an image. Called by several threads at once.
  virtual std::string encode(const Film& film) const = 0;
  // Stores the result of encode(). Called for one step at a time, in order, before the step is reported as
  // done.
  virtual void keep(int step, std::string&& encoded) = 0;

  // Called when rendering has ended, also after an error. Releases state that only add() and keep() need.
  virtual void end() {}

  // Return status members with links to the files of job `job_id`, or of one of its finished steps.
  virtual nlohmann::ordered_json links(const std::string& job_id) const = 0;
  virtual nlohmann::ordered_json links_of_step(const std::string& job_id, int step) const = 0;
  // Return the other status members of the job after `steps_done` steps, or of a finished step.
  virtual nlohmann::ordered_json status_fields(int steps_done) const = 0;
  virtual nlohmann::ordered_json step_fields(int step) const = 0;
  // Returns the file of job `job_id` at the URL path `path`. Throws NotFound if no such file exists.
  virtual JobResult result(const std::string& job_id, std::string_view path) const = 0;
};

}  // namespace orrery
