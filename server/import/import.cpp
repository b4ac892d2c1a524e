#include "server/import/import.h"

#include <algorithm>

#include "server/import/mitsuba_reader.h"
#include "server/import/pbrt_reader.h"

namespace orrery {

ImportedScene import_scene(const std::string& text, const std::string& name, const ReadNearby& nearby,
                           const ImportOptions& options) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != text.npos && text[first] == '<') return import_mitsuba(text, name, nearby, options);
  return import_pbrt(text, name, nearby, options);
}

}  // namespace orrery
