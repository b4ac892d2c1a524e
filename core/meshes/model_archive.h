#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/meshes/model.h"
#include "core/meshes/zip_file.h"

namespace orrery {

// ZIP archive with a model and the files that the model names.
class ModelArchive {
 public:
  // Returns true if the bytes are a ZIP archive, but no Open Packaging package (ISO/IEC 29500-2) such as a
  // 3MF file. Throws the exceptions of ZipFile.
  static bool is_archive(std::string_view bytes);

  // Finds the model: the only file with the extension of a model format, not counting hidden files and those
  // in
  // __MACOSX. glTF files are preferred to others, then files in fewer folders. Throws InputError if there is
  // no such file or several, or an entry has a path outside of the archive. REQUIRES: `bytes` outlive this.
  explicit ModelArchive(std::string_view bytes);

  // Path of the model in the archive, with slashes.
  const std::string& model_name() const { return model_; }
  // Returns the bytes of the model. Throws InputError if it is an archive or exceeds the limits of ZipLimits.
  std::string read_model_file() const;
  // Returns a function that reads other files of the archive, by their path from the folder of the model. A
  // name that is not in the archive matches if only the case of its letters differs. Valid after this.
  // REQUIRES: calls do not overlap.
  ReadNearby nearby() const;

 private:
  struct Contents;

  std::string model_;
  std::shared_ptr<Contents> contents_;
};

}  // namespace orrery
