#include "core/load/asset_files.h"

#include <algorithm>

#include "core/load/scene_file.h"

namespace orrery {

template <class Read>
auto AssetFiles::read_with(const std::string& name, const Read& read) const {
  namespace fs = std::filesystem;
  if (name.find('\0') != std::string::npos) throw InputError("", "file name must not contain NUL");
  std::error_code error;
  const fs::path folder = fs::canonical(folder_.empty() ? "." : folder_, error);
  const fs::path path = fs::canonical(folder / name, error);  // resolves symbolic links
  if (error) throw InputError("", "cannot read " + (folder_ / name).string() + ": " + error.message());
  if (std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first != folder.end())
    throw InputError("", "must be a file in the scene's folder or below it (got " + name + ")");
  if (!fs::is_regular_file(path)) throw InputError("", "cannot read " + name + ": not a regular file");
  try {
    return read(read_file(path.string()));
  } catch (const FileError& unreadable) {
    throw InputError("", unreadable.what());
  } catch (const InputError& bad) {
    throw InputError("", name + ": " + bad.problems().front().detail);
  }
}

TriangleMesh AssetFiles::mesh_file(const std::string& name) const {
  return read_with(name, [](const std::string& bytes) { return read_mesh(bytes); });
}

TexelsPtr AssetFiles::picture_file(const std::string& name) const {
  return read_with(
      name, [](const std::string& bytes) { return std::make_shared<const Texels>(read_picture(bytes)); });
}

}  // namespace orrery
