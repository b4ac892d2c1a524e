#include "server/import/description_files.h"

#include "core/base/shorten.h"
#include "core/meshes/text.h"

namespace orrery {

void DescriptionFiles::count(const std::string& text, const std::string& name) {
  bytes_ += text.size();
  if (bytes_ > limits_.bytes)
    refuse_at({name, 1},
              "files of a scene must have at most " + grouped(limits_.bytes) + " bytes together (got more)");
}

std::string DescriptionFiles::begin_include(const std::string& name, const ImportPlace& place) {
  if (++depth_ > limits_.include_depth)
    refuse_at(place, "includes must be nested at most " + std::to_string(limits_.include_depth) +
                         " deep (got more: does " + excerpt(name, 80) + " include itself?)");
  if (++files_ > limits_.files)
    refuse_at(place, "scene must include at most " + grouped(limits_.files) + " files (got more)");
  try {
    return nearby_(name);
  } catch (const InputError& error) {
    refuse_at(place, "file " + excerpt(name, 80) + ": " + error.problems().front().detail);
  }
}

}  // namespace orrery
