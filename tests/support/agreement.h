#pragma once

#include <gtest/gtest.h>

#include "tests/support/structures.h"

// Tests of one registered structure, which must find what the list finds.
namespace orrery::test {

// The same primitives at the same distances as `reference` finds, to the bit, and the same shadows up to each
// of `reaches`.
template <class T>
void expect_agreement(Structure<T>& structure, Structure<T>& reference, const Rays<T>& rays,
                      std::initializer_list<T> reaches) {
  const auto expected = reference.closest(rays), found = structure.closest(rays);
  int wrong = 0, met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    wrong += found[i].primitive != expected[i].primitive || found[i].t != expected[i].t;
    met += expected[i].met();
  }
  EXPECT_EQ(wrong, 0) << "of " << rays.size() << " rays, of which " << met << " meet something";
  for (const T t_max : reaches)
    EXPECT_EQ(structure.occluded(rays, t_max), reference.occluded(rays, t_max)) << t_max;
}

class StructureTest : public testing::TestWithParam<std::string> {
 protected:
  template <class T>
  AcceleratorFacts agree(const Json& scene, const Rays<T>& rays, std::initializer_list<T> reaches) {
    Structure<T> reference(scene, "list"), structure(scene, GetParam());
    expect_agreement(structure, reference, rays, reaches);
    return structure.facts();
  }
};

}  // namespace orrery::test
