#pragma once

#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/model/scene.h"

namespace orrery {

// Thrown when a file cannot be read or written. what() contains its name and the reason.
class FileError : public Error {
 public:
  using Error::Error;
};

// Thrown when a scene file is invalid.
class BadScene : public InputError {
 public:
  BadScene(const std::string& file, const InputError& error);
  // One line for each problem: "file: /pointer: detail".
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

// Returns all bytes of a file, or of standard input if `path` is "-". Throws FileError, also for more than
// 1 GiB.
std::string read_file(const std::string& path);

// Loads a scene and its assets. Throws FileError or BadScene.
std::shared_ptr<const Scene> load_scene_file(const std::string& path);

}  // namespace orrery
