#pragma once

#include <span>
#include <string_view>

namespace orrery {

// A file of web/, scenes/ or server/routes/ that is compiled into the program.
struct EmbeddedFile {
  std::string_view path;   // from the repository root: "web/index.html", "scenes/paper.json"
  std::string_view bytes;  // lives as long as the program
};

// Returns all embedded files in ascending order of path. Thread-safe.
std::span<const EmbeddedFile> embedded_files();

}  // namespace orrery
