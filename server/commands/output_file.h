#pragma once

#include <string>
#include <string_view>

#include "core/image/files.h"

namespace orrery {

// ".png" of "a/b.PNG".
std::string ending_of(const std::string& path);
// The format that the ending of a file's name stands for. Throws InputError.
FileFormat format_of(const std::string& path);

// However they are written.
bool is_same_file(const std::string& a, const std::string& b);

// Throws FileError if a file cannot be made there: what takes long asks before it begins.
void require_writable(const std::string& path);

// Writes all or nothing: the bytes go to a file beside it that takes its name once it is complete. Throws
// FileError.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace orrery
