#pragma once

#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/model/scene.h"

namespace orrery {

// A file that cannot be read or written. what() names it and says why.
class FileError : public Error {
 public:
  using Error::Error;
};

// What is wrong with the scene in a file.
class BadScene : public InputError {
 public:
  BadScene(const std::string& file, const InputError& error);
  // A line a problem: "file: /pointer: sentence".
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  std::vector<std::string> lines_;
};

// All bytes of a file; "-" is standard input. Throws FileError.
std::string read_file(const std::string& path);

// Throws FileError, BadScene.
std::shared_ptr<const Scene> load_scene_file(const std::string& path);

}  // namespace orrery
