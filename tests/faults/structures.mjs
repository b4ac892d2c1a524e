// Well-known mistakes of structures and instances, each with a test that fails while it is in the code.

const kRoom = "core/accelerators";

export const structureFaults = [
  {
    fault: 9,
    about: "a kd-tree's ray visits one side of a plane only",
    file: `${kRoom}/space_tree.h`,
    from: "if (enters_far) later[waiting++] = far;",
    to: "",
    target: "test_accelerators",
    tests: ["All/Accelerators.AgreeWithTheListOnACloudOfAllShapes/kd_median"],
  },
  {
    fault: 9,
    about: "planes are crossed at one distance, without a margin for rounding",
    file: `${kRoom}/probes.h`,
    from: "const T pad = max_component(abs(ray.origin)) * kRounding<T>;",
    to: "const T pad = 0;",
    target: "test_accelerators",
    tests: ["All/Accelerators.AgreeWithTheListFromAfar/kd_sah"],
  },
  {
    fault: 14,
    about: "the first hit found in a cell is taken for the nearest",
    file: `${kRoom}/single_walk.h`,
    from: "bool open(T from) const { return from <= hit.t * kFarther<T>; }",
    to: "bool open(T from) const { return from >= 0 && hit.t > 0 && hit.primitive == kNoPrimitive; }",
    target: "test_accelerators",
    tests: ["All/Partitions.FindTheNearerOfLongAndShort/grid"],
  },
  {
    fault: 14,
    about: "cells that are shared cost nothing, so that they are cut without end",
    file: `${kRoom}/space_tree.h`,
    from: "if (added > left) return false;",
    to: "if (added > left) left = added;",
    target: "test_accelerators",
    tests: ["All/Partitions.FindTheNearerOfLongAndShort/kd_median"],
  },
  {
    fault: 15,
    about: "axes of oriented boxes go by triangles, not by their area",
    file: `${kRoom}/oriented_box.cpp`,
    from: "const double size = length(cross(b - a, c - a)) / 2;",
    to: "const double size = 1;",
    target: "test_accelerators",
    tests: ["OrientedBox.IgnoresHowFinelyCornersAreCut"],
  },
  {
    fault: 16,
    about: "normals of instances are turned as directions are",
    file: "core/shapes/instances.cpp",
    from: "normalize(from_world.transposed(found->geometric.at(i)))",
    to: "normalize(to_world.vector(found->geometric.at(i)))",
    target: "test_accelerators",
    tests: ["Instance.LooksOutwardHoweverItIsScaled"],
  },
  {
    fault: 16,
    about: "rays keep length 1 in an instance, so that distances are the model's",
    file: "core/shapes/instances.h",
    from: "return {from_world.point(ray.origin), from_world.vector(ray.direction)};",
    to: "return {from_world.point(ray.origin), normalize(from_world.vector(ray.direction))};",
    target: "test_accelerators",
    tests: ["Instance.IsMetWhereItsMeshWouldBe"],
  },
];
