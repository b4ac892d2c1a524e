#pragma once

#include <span>
#include <string_view>

namespace orrery {

// A file of web/ or scenes/ that was put into the program when it was built.
struct EmbeddedFile {
  std::string_view path;   // from the repository root: "web/index.html", "scenes/paper.json"
  std::string_view bytes;  // lives as long as the program
};

// All embedded files, in ascending order of path. Safe from any thread.
std::span<const EmbeddedFile> embedded_files();

}  // namespace orrery
