#include "server/cache/pictures.h"

#include <limits>

namespace orrery {

namespace {

// Size reported for an image that missed its budget. It exceeds every cache, so the image is not cached: a
// later request may have more time.
constexpr std::size_t kTooMany = std::numeric_limits<std::size_t>::max() / 2;
constexpr std::size_t kEntry = 2048;  // overhead of a cache entry in bytes: keys, nodes, headers of blocks

std::size_t bytes_of(const Certificate& certificate) {
  std::size_t bytes = 0;
  for (const Certificate::Term& term : certificate.terms)
    bytes += sizeof term + term.subject.capacity() + term.reason.capacity();
  for (const Certificate::Bias& bias : certificate.biases) bytes += sizeof bias + bias.option.capacity();
  return bytes;
}

}  // namespace

std::size_t held_bytes(const Picture& picture) {
  if (is_missed(picture.budget)) return kTooMany;
  std::size_t bytes = kEntry + sizeof picture + picture.bytes.capacity() + bytes_of(picture.certificate);
  for (const Problem& warning : picture.warnings)
    bytes += sizeof warning + warning.pointer.capacity() + warning.detail.capacity();
  return bytes;
}

std::string picture_key(const std::string& work, FileFormat format) {
  return work + std::to_string(static_cast<int>(format));
}

std::size_t held_bytes(const RenderResult& rendered) {
  const Film& film = rendered.film;
  if (is_missed(rendered.budget)) return kTooMany;
  return kEntry + sizeof rendered + bytes_of(rendered.certificate) +
         Film::bytes(film.width(), film.height(), film.storage(), film.channels());
}

FilmStorage shared_storage(FileFormat format, const Plan& plan, std::size_t max_bytes) {
  const FilmStorage least = storage_for(format, plan);
  const bool fits = Film::bytes(plan.width, plan.height, FilmStorage::linear32, {}) <= max_bytes;
  return least == FilmStorage::srgb8 && fits ? FilmStorage::linear32 : least;
}

}  // namespace orrery
