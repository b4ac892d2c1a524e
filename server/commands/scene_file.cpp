#include "server/commands/scene_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>

#include "core/load/load.h"

namespace orrery {
namespace {

std::string shown_name(const std::string& path) { return path == "-" ? "standard input" : path; }

std::string read_all(std::istream& in) { return {std::istreambuf_iterator<char>(in), {}}; }

}  // namespace

BadScene::BadScene(const std::string& file, const InputError& error) : InputError(error.problems()) {
  const bool malformed = dynamic_cast<const MalformedJson*>(&error);  // its text says the line and column
  for (const Problem& p : problems())
    lines_.push_back(file + ": " + (p.pointer.empty() || malformed ? "" : p.pointer + ": ") + p.detail);
}

std::string read_file(const std::string& path) {
  if (path == "-") return read_all(std::cin);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  std::string bytes;
  if (in) bytes = read_all(in);
  if (!in || in.bad())
    throw FileError("cannot read " + path + (errno ? ": " + std::string(std::strerror(errno)) : ""));
  return bytes;
}

std::shared_ptr<const Scene> load_scene_file(const std::string& path) {
  const std::string text = read_file(path);
  try {
    return load_scene(text);
  } catch (const InputError& error) {
    throw BadScene(shown_name(path), error);
  }
}

}  // namespace orrery
