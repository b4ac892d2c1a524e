#pragma once

#include "core/model/asset_source.h"
#include "core/params/params.h"

namespace orrery {

// Returns read(name). Records a problem at `key` and returns an empty result if `name` is empty or `read`
// throws InputError.
template <class Read>
auto read_named(Params& p, const char* key, const std::string& name, const Read& read)
    -> decltype(read(name)) {
  try {
    if (name.empty()) throw InputError("", "must be a name (got \"\")");
    return read(name);
  } catch (const InputError& error) {
    p.fail(key, error.problems().front().detail);
    return {};
  }
}

// Largest length of a file name, in bytes.
inline constexpr std::size_t kMostNameLength = 1024;

// Image that an object of a scene names.
struct PictureName {
  const char* key;  // `file` or `asset`
  std::string name;
  std::optional<std::size_t> image;  // number of an image in a model file
};
PictureName read_picture_name(Params& p);

// Returns the image with a name. Throws the errors of AssetSource.
TexelsPtr picture_of(const AssetSource& source, const PictureName& name);

// Reads the image that the key `file` or `asset` of the object names. Returns null after a problem.
TexelsPtr read_picture(Params& p, const AssetSource& source);

}  // namespace orrery
