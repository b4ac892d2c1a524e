#include "server/cache/pictures.h"

#include <limits>

namespace orrery {

namespace {

// Size reported for an image that missed its budget. It exceeds every cache, so the image is not cached: a
// later request may have more time.
constexpr std::size_t kTooMany = std::numeric_limits<std::size_t>::max() / 2;

}  // namespace

std::size_t held_bytes(const Picture& picture) {
  return is_missed(picture.budget) ? kTooMany : picture.bytes.capacity();
}

std::string picture_key(const std::string& work, FileFormat format) {
  return work + std::to_string(static_cast<int>(format));
}

std::size_t held_bytes(const RenderResult& rendered) {
  const Film& film = rendered.film;
  if (is_missed(rendered.budget)) return kTooMany;
  return Film::bytes(film.width(), film.height(), film.storage(), film.channels());
}

FilmStorage shared_storage(FileFormat format, const Plan& plan, std::size_t max_bytes) {
  const FilmStorage least = storage_for(format, plan);
  const bool fits = Film::bytes(plan.width, plan.height, FilmStorage::linear32, {}) <= max_bytes;
  return least == FilmStorage::srgb8 && fits ? FilmStorage::linear32 : least;
}

}  // namespace orrery
