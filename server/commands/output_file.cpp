#include "server/commands/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "core/base/error.h"
#include "core/load/scene_file.h"

namespace orrery {

namespace {

// Whether write_file() replaces the file. It writes directly to devices and pipes.
bool is_replaced(const std::string& path) {
  std::error_code ignored;
  const auto kind = std::filesystem::status(path, ignored).type();
  return kind == std::filesystem::file_type::regular || kind == std::filesystem::file_type::not_found;
}

// Returns the path with symbolic links resolved.
std::string target_of(const std::string& path) {
  std::error_code ignored;
  const std::string target = std::filesystem::weakly_canonical(path, ignored).string();
  return target.empty() ? path : target;
}

}  // namespace

std::string ending_of(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

FileFormat format_of(const std::string& path, const std::string& name) {
  const std::string ending = !name.empty() ? "." + name : path == "-" ? ".png" : ending_of(path);
  if (ending == ".png") return FileFormat::png;
  if (ending == ".jpg" || ending == ".jpeg") return FileFormat::jpeg;
  if (ending == ".exr") return FileFormat::exr;
  throw InputError("--output", "must be a name that ends in .png, .jpg or .exr (got " + path + ")");
}

bool is_same_file(const std::string& a, const std::string& b) { return target_of(a) == target_of(b); }

void require_writable(const std::string& path) {
  if (path == "-") return;
  const std::string folder = std::filesystem::path(target_of(path)).parent_path().string();
  const std::string place = !is_replaced(path) ? path : folder.empty() ? "." : folder;
  std::error_code ignored;
  errno = std::filesystem::is_directory(path, ignored) ? EISDIR : 0;
  if (errno != 0 || access(place.c_str(), W_OK) != 0)
    throw FileError("cannot write " + path + ": " + std::strerror(errno));
}

void write_file(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    if (!std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush())
      throw FileError("cannot write to standard output");
    return;
  }
  const bool replace = is_replaced(path);
  const std::string target = target_of(path),
                    written = replace ? target + ".part-" + std::to_string(getpid()) : path;
  errno = 0;
  std::ofstream out(written, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (out && (!replace || std::rename(written.c_str(), target.c_str()) == 0)) return;
  const std::string reason = errno ? ": " + std::string(std::strerror(errno)) : "";
  std::error_code ignored;
  if (replace) std::filesystem::remove(written, ignored);
  throw FileError("cannot write " + path + reason);
}

}  // namespace orrery
