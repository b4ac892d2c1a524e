#include "server/import/import.h"

#include "server/import/pbrt_reader.h"

namespace orrery {

ImportedScene import_scene(const std::string& text, const std::string& name, const ReadNearby& nearby,
                           const ImportOptions& options) {
  return import_pbrt(text, name, nearby, options);
}

}  // namespace orrery
