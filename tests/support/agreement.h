#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <map>

#include "core/base/hash.h"
#include "tests/support/structures.h"

// Compares the results of one registered structure with the results of the list.
namespace orrery::test {

// Results of a structure: closest hits, and occlusion up to each distance of `reaches`.
template <class T>
struct TraversalResults {
  std::vector<Hit<T>> closest;
  std::vector<std::vector<char>> occluded;

  TraversalResults(Structure<T>& structure, const Rays<T>& all, std::initializer_list<T> reaches) {
    const Rays<T> rays = subsample_rays(all);
    closest = structure.closest(rays);
    for (const T t_max : reaches) occluded.push_back(structure.occluded(rays, t_max));
  }
};

// Expects bit-identical hits and equal occlusion. Fails if no ray hits, because the comparison would then
// prove nothing.
template <class T>
void expect_agreement(const TraversalResults<T>& found, const TraversalResults<T>& expected) {
  int wrong = 0, met = 0;
  for (std::size_t i = 0; i < expected.closest.size(); ++i) {
    const Hit<T>&a = found.closest[i], &b = expected.closest[i];
    wrong += a.primitive != b.primitive || a.t != b.t;
    met += b.met();
  }
  EXPECT_GT(met, 0) << "no ray hits";
  EXPECT_EQ(wrong, 0) << "of " << expected.closest.size() << " rays, " << met << " of which hit";
  EXPECT_EQ(found.occluded, expected.occluded);
}
template <class T>
void expect_agreement(Structure<T>& structure, Structure<T>& reference, const Rays<T>& rays,
                      std::initializer_list<T> reaches) {
  expect_agreement(TraversalResults<T>(structure, rays, reaches),
                   TraversalResults<T>(reference, rays, reaches));
}

// Returns the results of the list. Caches them by scene, rays and reaches, because the list is slow.
template <class T>
const TraversalResults<T>& list_results(const Json& scene, const Rays<T>& rays,
                                        std::initializer_list<T> reaches) {
  static std::map<std::string, TraversalResults<T>> known;
  std::string question = scene.dump();
  question.append(reinterpret_cast<const char*>(rays.data()), rays.size() * sizeof(Ray<T>));
  question.append(reinterpret_cast<const char*>(reaches.begin()), reaches.size() * sizeof(T));
  const std::string key = sha256_hex(question);
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  Structure<T> list(scene, "list");
  return known.emplace(key, TraversalResults<T>(list, rays, reaches)).first->second;
}

class StructureTest : public testing::TestWithParam<std::string> {
 protected:
  template <class T>
  AcceleratorFacts agree(const Json& scene, const Rays<T>& rays, std::initializer_list<T> reaches) {
    Structure<T> structure(scene, GetParam());
    expect_agreement(TraversalResults<T>(structure, rays, reaches), list_results<T>(scene, rays, reaches));
    return structure.facts();
  }
};

}  // namespace orrery::test
