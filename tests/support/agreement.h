#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <map>

#include "core/base/hash.h"
#include "tests/support/structures.h"

// Tests of one registered structure, which must find what the list finds.
namespace orrery::test {

// What a structure finds: the nearest hits, and the shadows up to each of some reaches.
template <class T>
struct Findings {
  std::vector<Hit<T>> closest;
  std::vector<std::vector<char>> occluded;

  Findings(Structure<T>& structure, const Rays<T>& all, std::initializer_list<T> reaches) {
    const Rays<T> rays = enough_of(all);
    closest = structure.closest(rays);
    for (const T t_max : reaches) occluded.push_back(structure.occluded(rays, t_max));
  }
};

// The same primitives at the same distances, to the bit, and the same shadows. REQUIRES: some ray meets
// something; to agree that all miss proves nothing.
template <class T>
void expect_agreement(const Findings<T>& found, const Findings<T>& expected) {
  int wrong = 0, met = 0;
  for (std::size_t i = 0; i < expected.closest.size(); ++i) {
    const Hit<T>&a = found.closest[i], &b = expected.closest[i];
    wrong += a.primitive != b.primitive || a.t != b.t;
    met += b.met();
  }
  EXPECT_GT(met, 0) << "no ray meets anything";
  EXPECT_EQ(wrong, 0) << "of " << expected.closest.size() << " rays, of which " << met << " meet something";
  EXPECT_EQ(found.occluded, expected.occluded);
}
template <class T>
void expect_agreement(Structure<T>& structure, Structure<T>& reference, const Rays<T>& rays,
                      std::initializer_list<T> reaches) {
  expect_agreement(Findings<T>(structure, rays, reaches), Findings<T>(reference, rays, reaches));
}

// What the list finds. It is asked once for the same question, whatever structures are held against it: it
// takes longer than all of them.
template <class T>
const Findings<T>& list_finds(const Json& scene, const Rays<T>& rays, std::initializer_list<T> reaches) {
  static std::map<std::string, Findings<T>> known;
  std::string question = scene.dump();
  question.append(reinterpret_cast<const char*>(rays.data()), rays.size() * sizeof(Ray<T>));
  question.append(reinterpret_cast<const char*>(reaches.begin()), reaches.size() * sizeof(T));
  const std::string key = sha256_hex(question);
  const auto found = known.find(key);
  if (found != known.end()) return found->second;
  Structure<T> list(scene, "list");
  return known.emplace(key, Findings<T>(list, rays, reaches)).first->second;
}

class StructureTest : public testing::TestWithParam<std::string> {
 protected:
  template <class T>
  AcceleratorFacts agree(const Json& scene, const Rays<T>& rays, std::initializer_list<T> reaches) {
    Structure<T> structure(scene, GetParam());
    expect_agreement(Findings<T>(structure, rays, reaches), list_finds<T>(scene, rays, reaches));
    return structure.facts();
  }
};

}  // namespace orrery::test
