#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/budget/renderer.h"
#include "core/render/views.h"
#include "server/cache/single_flight.h"

namespace orrery {

// Encoded image and its statistics.
struct Picture {
  std::string bytes;
  RenderStats stats;
  Certificate certificate = {};
  std::vector<Problem> warnings = {};  // see find_warnings()
  std::optional<BudgetOutcome> budget = {};
  bool from_cached_film = false;  // encoded from a cached film
};
std::size_t held_bytes(const Picture& picture);
// Returns the key of an image in a format. `work`: key of the image regardless of its format.
std::string picture_key(const std::string& work, FileFormat format);
using Pictures = SingleFlight<Picture>;

std::size_t held_bytes(const RenderResult& rendered);
// Cache of films, from which images in other formats are encoded.
using Films = SingleFlight<RenderResult>;

// Returns the storage for the film of an image. If srgb8 would suffice, this is linear32, which serves all
// formats, provided that the film fits in `max_bytes`. Otherwise it is the smallest storage for the format.
FilmStorage shared_storage(FileFormat format, const Plan& plan, std::size_t max_bytes);

}  // namespace orrery
