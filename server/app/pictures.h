#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/render/renderer.h"
#include "core/render/views.h"
#include "server/app/single_flight.h"

namespace orrery {

// An encoded picture and what it took.
struct Picture {
  std::string bytes;
  RenderStats stats;
  Certificate certificate = {};
  std::vector<Problem> warnings = {};  // see find_warnings()
  std::optional<BudgetOutcome> budget = {};
  bool of_kept_film = false;  // nothing was rendered for it
};
std::size_t held_bytes(const Picture& picture);
// By format and by `work`, the key of what it is a picture of.
std::string picture_key(const std::string& work, FileFormat format);
using Pictures = SingleFlight<Picture>;

std::size_t held_bytes(const RenderResult& rendered);
// Films of which pictures in other formats may be asked for.
using Films = SingleFlight<RenderResult>;

// How the film of a picture in that format is kept: as what all formats are views of, unless such a film
// takes more than `most_bytes`; else as little as the format needs.
FilmStorage shared_storage(FileFormat format, const Plan& plan, std::size_t most_bytes);

}  // namespace orrery
