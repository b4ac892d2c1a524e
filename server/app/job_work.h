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

// A file that a job makes and that never changes.
struct JobResult {
  std::string name;       // what errors call it: "Frame 3"
  std::string_view type;  // "image/png"
  // Steps of the job, the first ones, that make it; none: all.
  std::optional<int> after;
  // Its bytes, with links below `prefix`; the same ones for all readers where it has no links. REQUIRES: the
  // job's status has said that so many steps are done.
  std::function<SharedBytes(const std::string& prefix)> read;
};

// What a job does: renders pictures of a scene, one a step, and makes files of them. A kind of job is a class
// of its own, which stands with its routes in a file of server/routes/. Job calls steps(), request(),
// storage() and add() on its thread, encode() and keep() on those of the pool; the rest is safe from any
// thread.
class JobWork {
 public:
  virtual ~JobWork() = default;

  // Pictures to render, at least 1 and as many as were added. It may become smaller when one is added.
  virtual int steps() const = 0;
  // How the picture 0 <= step < steps() is rendered. REQUIRES: not all were added.
  virtual RenderRequest request(int step) const = 0;
  virtual FilmStorage storage() const = 0;

  // Takes the next picture. They come in order.
  virtual void add(const RenderResult& /*rendered*/) {}
  // What is to be kept of a picture. Several at once.
  virtual std::string encode(const Film& film) const = 0;
  // Takes what encode() made of each picture. One at a time, in order, and before the step is told to be
  // done.
  virtual void keep(int step, std::string&& encoded) = 0;

  // No more pictures come: gives back what only taking them needs.
  virtual void end() {}

  // Members that point to the files, of what is told about the job `job_id`, and about a step that is done.
  virtual nlohmann::ordered_json links(const std::string& job_id) const = 0;
  virtual nlohmann::ordered_json links_of_step(const std::string& job_id, int step) const = 0;
  // What else is told about the job, of which so many steps are done, and about a step that is.
  virtual nlohmann::ordered_json told(int steps_done) const = 0;
  virtual nlohmann::ordered_json told_of_step(int step) const = 0;
  // The file whose address has this path, where the job is `job_id`. Throws NotFound for paths of none.
  virtual JobResult result(const std::string& job_id, std::string_view path) const = 0;
};

}  // namespace orrery
