// Mistakes of rounding, as faults.mjs has them: fault 24 loses hits or digits where a formula cancels, or takes float
// for fine enough where it is not.

const entry = (about, file, from, to, target, ...tests) => ({ fault: 24, about, file, from, to, target, tests });
const limit = (about, from, to, ...scenes) =>
  entry(about, "core/plan/rounding.cpp", from, to, "test_plan", ...scenes.map((name) => `Scenes/HardForFloat.*/${name}*`));
const spacing = (about, from, to, ...scenes) =>
  entry(about, "core/load/spacing.cpp", from, to, "test_plan", ...scenes.map((name) => `Scenes/HardForFloat.*/${name}*`));
const triangle = (about, from, to, ...tests) =>
  entry(about, "core/shapes/triangle_hit.h", from, to, "test_shapes", ...tests.map((name) => `Triangle.${name}`));

const exact = (about, file, from, to, ...classes) =>
  entry(about, file, from, to, "test_exact", ...classes.map((name) => `Classes/Exact.*/${name}`));

export const roundingFaults = [
  entry("boxes of nearly axis-aligned disks are flat", "core/shapes/round_hull.h", "std::hypot(axis.x, axis.z)",
        "std::sqrt(std::max(0.0, 1 - axis.y * axis.y))", "test_accelerators", "NearlyAxisAligned.*"),
  entry("the point that places a plane does not count", "core/load/facts.cpp", "shapes.anchor_magnitude(index)", "0.0",
        "test_plan", "Precision.SaysWhatNeedsDouble"),
  entry("narrow beams do not count", "core/lights/spot.cpp", "kMostError * width", "1.0", "test_plan",
        "Scenes/HardForFloat.*/spot*"),
  entry("sharp highlights do not count", "core/materials/rough.cpp", "kMostError / shininess", "1.0", "test_plan",
        "Scenes/HardForFloat.*/shininess*"),
  limit("what is too small for float is left to it", "facts_.smallest_feature.value < kLeastLengthInFloat", "false", "mesh"),
  limit("a pixel is measured at look_at alone", "std::min(plan_.frame.distance, nearest())", "plan_.frame.distance", "tele"),
  limit("mirrors do not count", "    take_mirrors();\n", "", "mirror_tubes"),
  limit("layers do not count", "take_length(facts_.layer_distance.value,", "take_length(1e9,", "bubble", "decal", "film"),
  spacing("layers are looked for on the outside alone", "    take_layer(from, at, -1);\n", "", "film"),
  spacing("layers that overlap in part are not looked for", "measure_pair(placed_[i], placed_[k]);", "(void)k;", "disks_that"),
  spacing("mirrors of smooth meshes count as flat", "if (at.shading != at.outward) return true;", "", "mirror_tubes_of"),
  spacing("the times of keys are no moments", "times.push_back(keys[i]);", "(void)i;", "lands_between"),
  entry("spheres that touch are layers", "core/load/spacing.cpp", "for (const SurfaceAt& one : at)",
        "for (const SurfaceAt& one : {at[0]})", "test_plan", "Precision.OfSamples*"),
  entry("the discriminant of a sphere cancels far away", "core/shapes/sphere.h",
        "const N discriminant = radius * radius - dot(residue, residue);",
        "const N discriminant = b * b / a - (dot(f, f) - radius * radius);", "test_stability",
        "Rows/Stability.*/A1"),
  exact("the box of a tilted cylinder leaves out its caps", "core/shapes/cylinder.h",
        "abs(axis) * half_length + round_reach(axis) * radius", "abs(axis) * half_length", "mixed"),
  exact("the constant term of a cylinder's wall is from its centre", "core/shapes/cylinder.h",
        "const N from_axis = length(f_across);", "const N from_axis = length(f);", "mixed", "instances"),
  triangle("hits slide along slivers", "const N v = difference_of_products(sa.x, sc.y, sa.y, sc.x);",
           "const N v = sa.x * sc.y - sa.y * sc.x;", "HitsDoNotSlide*"),
  triangle("a ray that starts on a triangle meets it", "t > zero &&\n                   abs(z) > farthest * (4 * std::numeric_limits<T>::epsilon());",
           "t > zero;", "IsNotMetByRaysThatStartOnIt"),
  entry("normals of slivers lose digits", "core/math/face_normal.h",
        "difference_of_products(e[i].high, f[j].high, e[j].high, f[i].high)", "e[i].high * f[j].high - e[j].high * f[i].high",
        "test_shapes", "Triangle.NormalsOfSlivers*"),
  entry("the products of a triangle's edges are rounded, so that structures differ", "core/math/products.h",
        "return (ab - cd) + (product_error(a, b, ab) - product_error(c, d, cd));", "return ab - cd;", "test_accelerators",
        "Structures/HardScenes.*", "Structures/Slivers.*"),
];
