#pragma once

#include <string>
#include <string_view>

#include "core/image/encode/files.h"

namespace orrery {

// Returns the extension in lower case: ".png" for "a/b.PNG".
std::string ending_of(const std::string& path);
// Returns the format with this name, or if it is empty, the format for the extension of a file name. Standard
// output ("-") has the format png. Throws InputError if the extension is unknown.
FileFormat format_of(const std::string& path, const std::string& name = "");

// Whether both paths lead to the same file after symbolic links are resolved.
bool is_same_file(const std::string& a, const std::string& b);

// Throws FileError if the file cannot be written. Called before a long render.
void require_writable(const std::string& path);

// Writes a file atomically: writes a temporary file in the same folder and renames it. Writes directly to
// devices and pipes, and to standard output if `path` is "-". Throws FileError.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace orrery
