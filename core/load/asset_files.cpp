#include "core/load/asset_files.h"

#include <algorithm>

#include "core/load/scene_file.h"

namespace orrery {

namespace {

namespace fs = std::filesystem;

// Returns the path of a file in a folder or below it, with symbolic links resolved. Throws InputError if the
// file is elsewhere or no regular file. `owner`: "scene" or "model", for errors.
fs::path path_within(const fs::path& given_folder, const std::string& name, const char* owner) {
  if (name.find('\0') != std::string::npos) throw InputError("", "file name must not contain NUL");
  std::error_code error;
  const fs::path folder = fs::canonical(given_folder.empty() ? "." : given_folder, error);
  const fs::path path = fs::canonical(folder / name, error);  // resolves symbolic links
  if (error) throw InputError("", "cannot read " + (given_folder / name).string() + ": " + error.message());
  if (std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first != folder.end())
    throw InputError(
        "", "must be a file in the " + std::string(owner) + "'s folder or below it (got " + name + ")");
  if (!fs::is_regular_file(path)) throw InputError("", "cannot read " + name + ": not a regular file");
  return path;
}

MeshModelPtr share_model(std::string_view bytes, const ReadNearby& nearby, const ModelState& state) {
  return std::make_shared<const MeshModel>(read_model(bytes, {}, nearby, state));
}

}  // namespace

ReadNearby files_near(const fs::path& file) {
  return [folder = file.parent_path()](const std::string& name) {
    const fs::path path = path_within(folder, name, "model");
    try {
      return read_file(path.string());
    } catch (const FileError& unreadable) {
      throw InputError("", unreadable.what());
    }
  };
}

ModelFile read_model_file(const std::string& path, const ModelState& state) {
  const std::string bytes = read_file(path);
  const bool is_file = path != "-";
  try {
    return {bytes.size(), share_model(bytes, is_file ? files_near(path) : ReadNearby(), state)};
  } catch (const InputError& error) {
    throw BadScene(is_file ? path : "standard input", error);
  }
}

template <class Read>
auto AssetFiles::read_with(const std::string& name, const Read& read) const {
  const fs::path path = path_within(folder_, name, "scene");
  try {
    return read(read_file(path.string()), path);
  } catch (const FileError& unreadable) {
    throw InputError("", unreadable.what());
  } catch (const InputError& bad) {
    throw InputError("", name + ": " + bad.problems().front().detail);
  }
}

MeshModelPtr AssetFiles::model_file(const std::string& name, const ModelState& state) const {
  return read_with(name, [&](const std::string& bytes, const fs::path& path) {
    return share_model(bytes, files_near(path), state);
  });
}

TexelsPtr AssetFiles::picture_file(const std::string& name) const {
  return read_with(name, [](const std::string& bytes, const fs::path&) {
    return std::make_shared<const Texels>(read_picture(bytes));
  });
}

}  // namespace orrery
