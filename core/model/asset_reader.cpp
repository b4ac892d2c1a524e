#include "core/model/asset_reader.h"

namespace orrery {

TexelsPtr read_picture(Params& p, const AssetSource& source) {
  if (p.form({{"file"}, {"asset"}}) == 0) {
    const std::string name =
        p.text("file", "EXR, HDR, PNG or JPEG file in or below the scene's folder; command line only.",
               kMostNameLength);
    return read_named(p, "file", name, [&](const std::string& n) { return source.picture_file(n); });
  }
  const std::string name = p.text("asset", "SHA-256 of an uploaded EXR, HDR, PNG or JPEG file.", 64);
  return read_named(p, "asset", name, [&](const std::string& n) { return source.picture_asset(n); });
}

}  // namespace orrery
