#include "core/load/scene_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "core/base/shorten.h"
#include "core/load/asset_files.h"
#include "core/load/load.h"

namespace orrery {
namespace {

std::string shown_name(const std::string& path) { return path == "-" ? "standard input" : path; }

constexpr std::size_t kMaxBytes = std::size_t{1} << 30;

[[noreturn]] void refuse_size(const std::string& name) {
  throw FileError("cannot read " + name + ": file has more than " + grouped(kMaxBytes) + " bytes");
}

std::string read_all(std::istream& in, const std::string& name) {
  std::string bytes;
  std::array<char, 64 * 1024> block;
  while (bytes.size() <= kMaxBytes && (in.read(block.data(), block.size()), in.gcount() > 0))
    bytes.append(block.data(), static_cast<std::size_t>(in.gcount()));
  if (bytes.size() > kMaxBytes) refuse_size(name);
  return bytes;
}

// Escapes control characters, which a terminal would interpret.
std::string printable(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    char code[8];
    std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned char>(c));
    shown += (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) ? code : std::string(1, c);
  }
  return shown;
}

}  // namespace

BadScene::BadScene(const std::string& file, const InputError& error) : InputError(error.problems()) {
  const bool malformed = dynamic_cast<const MalformedJson*>(&error);  // its detail has line and column
  for (const Problem& p : problems())
    lines_.push_back(printable(file + ": " + (malformed ? p.detail : p.text())));
}

std::string read_file(const std::string& path) {
  if (path == "-") return read_all(std::cin, shown_name(path));
  std::error_code no_file;  // pipes and other special files have no size
  if (const auto size = std::filesystem::file_size(path, no_file); !no_file && size > kMaxBytes)
    refuse_size(path);
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  std::string bytes;
  if (in.is_open()) bytes = read_all(in, path);
  if (!in.is_open() || in.bad())
    throw FileError("cannot read " + path + (errno ? ": " + std::string(std::strerror(errno)) : ""));
  return bytes;
}

std::shared_ptr<const Scene> load_scene_file(const std::string& path) {
  const std::string text = read_file(path);
  try {
    return load_scene(text, AssetFiles(path == "-" ? "" : std::filesystem::path(path).parent_path()));
  } catch (const InputError& error) {
    throw BadScene(shown_name(path), error);
  }
}

}  // namespace orrery
