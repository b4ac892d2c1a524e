// Mistakes that textbooks and slides on ray tracing make, each put back into the code. check.mjs applies them
// one at a time, to a copy of the tree, and wants the named tests to fail.
//
//   fault    number of the mistake; several entries are faces of one
//   about    what is wrong, in a few words
//   file     where; `from` stands there exactly once and becomes `to`
//   target   the GoogleTest executable, or a test script that needs neither the program nor a browser
//   tests    patterns for --gtest_filter, or names of the script's tests; a test of each must fail

import {certificateFaults} from "./certificates.mjs";
import {gateFaults} from "./gate.mjs";
import {imageFaults} from "./image.mjs";
import {meshFaults} from "./meshes.mjs";
import {motionFaults} from "./motion.mjs";
import {pageFaults} from "./page.mjs";
import {planFaults} from "./plan.mjs";
import {roundingFaults} from "./rounding.mjs";
import {serviceFaults} from "./service.mjs";
import {stabilityFaults} from "./stability.mjs";
import {stageFaults} from "./stages.mjs";
import {lightFaults} from "./light.mjs";
import {optionFaults} from "./options.mjs";
import {structureFaults} from "./structures.mjs";
import {studyFaults} from "./study.mjs";

const kShapes = "core/shapes";
const kNear = "N(T(1e-4))";  // the fixed epsilon of fault 4

const cylinderRoots = [
  {
    fault: 1,
    about: "cylinder roots are multiplied by A instead of divided",
    file: `${kShapes}/cylinder.h`,
    from: "const N t0 = (from_axis - radius) * (from_axis + radius) / q, t1 = q / a;",
    to: "const N t0 = (b - root) * a, t1 = (b + root) * a;",
    target: "test_shapes",
    tests: ["Cylinder.RootsAreDividedByTwiceA"],
  },
  {
    fault: 1,
    about: "cylinder rays along the axis (A = 0) have no case of their own",
    file: `${kShapes}/cylinder.h`,
    from: "const auto parallel = a == zero;",
    to: "const auto parallel = a < zero;",
    target: "test_shapes",
    tests: ["Cylinder.RaysAlongTheAxisMeetTheCaps"],
  },
];

const originAsSign = ["base", "top"].map((end) => ({
  fault: 2,
  about: `a cylinder whose ${end} is the origin counts as infinite`,
  file: `${kShapes}/cylinder.cpp`,
  from: "radius, length(top - base) / 2, reach});",
  to: `radius, ${end} == Vec3d() ? infinity : length(top - base) / 2, reach});`,
  target: "test_shapes",
  tests: ["Cylinder.OriginIsNoSentinel"],
}));

const lightDirections = [
  {
    fault: 3,
    about: "the direction of a directional light keeps its length",
    file: "core/lights/directional.cpp",
    from: 'const Vec3d from = p.direction("from",',
    to: 'const Vec3d from = p.point("from",',
    target: "test_lights",
    tests: ["Directional.DirectionIsOfUnitLengthHoweverItWasWritten", "AllLights.*"],
  },
  {
    fault: 3,
    about: "the beam of a spot keeps its length",
    file: "core/lights/spot.cpp",
    from: 'const Vec3d direction = p.direction("direction",',
    to: 'const Vec3d direction = p.point("direction",',
    target: "test_lights",
    tests: ["Spot.BeamGoesWhereItPointsWhateverTheLengthOfThat"],
  },
  {
    fault: 3,
    about: "the way to a point light is as long as the distance",
    file: "core/lights/point.h",
    from: "return {toward / distance,",
    to: "return {toward,",
    target: "test_lights",
    tests: ["AllLights.SendUnitDirectionsAndNoMoreThanTheirIntensity"],
  },
  {
    fault: 3,
    about: "the way to a spot is as long as the distance",
    file: "core/lights/spot.h",
    from: "const Vec3<N> to_light = toward / distance;",
    to: "const Vec3<N> to_light = toward;",
    target: "test_lights",
    tests: ["AllLights.SendUnitDirectionsAndNoMoreThanTheirIntensity"],
  },
  {
    fault: 3,
    about: "no direction of any input is normalised",
    file: "core/params/params.cpp",
    from: "return safe_normalize(do_three(key, doc, Kind::direction, range, fallback));",
    to: "return do_three(key, doc, Kind::direction, range, fallback);",
    target: "test_params",
    tests: ["Reader.DirectionsComeNormalisedFromAnyLength"],
  },
];

const kStep = {
  fault: 4,
  file: `${kShapes}/primitive_set.h`,
  from: "out.step.put(i, mine, s.magnitude * (8 * std::numeric_limits<T>::epsilon()));",
  to: `out.step.put(i, mine, ${kNear});`,
};
const fixedEpsilons = [
  {
    ...kStep,
    about: "rays leave a surface by one fixed step",
    target: "test_shapes",
    tests: ["Step.IsBelowTwoNanometresAThousandKilometresAway", "Shapes/Respawn.NoFloatRay*"],
  },
  {
    ...kStep,
    about: "rays leave a surface by one fixed step, seen in pictures",
    target: "test_render",
    tests: ["RandomScenes.LookTheSameAtAnyScale", "Scenes/EveryScene.LooksTheSameAtAnyScale/paper"],
  },
  ...[
    ["sphere", "select(first > N(T(0)), first,", `select(first > ${kNear}, first,`],
    ["plane", "select(t > N(T(0)), t,", `select(t > ${kNear}, t,`],
    ["disk", "select(t > N(T(0)) && inside,", `select(t > ${kNear} && inside,`],
    ["box", "enter <= leave && t > N(T(0))", `enter <= leave && t > ${kNear}`],
    ["cylinder", "enter <= leave && t > zero", `enter <= leave && t > ${kNear}`],
  ].map(([shape, from, to]) => ({
    fault: 4,
    about: `a ${shape} nearer than a fixed epsilon is missed`,
    file: `${kShapes}/${shape}.h`,
    from,
    to,
    target: "test_shapes",
    tests: [`Shapes/ShapeSurface.*PositionsLieOnTheShape/${shape}`],
  })),
  {
    fault: 4,
    about: "a triangle nearer than a fixed epsilon is missed",
    file: `${kShapes}/triangle_hit.h`,
    from: "determinant != zero && t > zero &&",
    to: `determinant != zero && t > ${kNear} &&`,
    target: "test_shapes",
    tests: ["Shapes/ShapeSurface.*Positions*/triangle", "Shapes/ShapeSurface.*Positions*/mesh"],
  },
  {
    fault: 4,
    about: "a triangle with a determinant below a fixed epsilon is missed",
    file: `${kShapes}/triangle_hit.h`,
    from: "determinant != zero && t > zero &&",
    to: "determinant * determinant > N(T(1e-12)) && t > zero &&",
    target: "test_shapes",
    tests: ["Shapes/ShapeSurface.*/triangle", "Shapes/ShapeSurface.*/mesh"],
  },
  {
    fault: 4,
    about: "boxes in float are padded by a fixed epsilon",
    file: "core/math/bounds.h",
    from: "const T pad = static_cast<T>(b.magnitude()) * std::numeric_limits<T>::epsilon() * 4;",
    to: "const T pad = T(1e-4);",
    target: "test_math",
    tests: ["Bounds.PaddingCoversTheRoundingToFloat"],
  },
  {
    fault: 4,
    about: "the far side of a box grows by a fixed epsilon",
    file: "core/math/bounds.h",
    from: "N(select(negative, t0, t1) * kFarPad)",
    to: "N(select(negative, t0, t1) + T(1e-4))",
    target: "test_math",
    tests: ["Slabs/?.LoseNoneOfAMillionRaysThroughCorners"],
  },
];

const insideOfGlass = [
  {
    fault: 5,
    about: "a ray inside glass keeps the outside ratio of indices",
    file: "core/materials/refractive.h",
    from: "const N eta = select(inside, ior, N(one / ior));",
    to: "const N eta = N(one / ior);",
    target: "test_materials",
    tests: ["Refraction.LeavesGlassAtTheAngleOfSnell"],
  },
  {
    fault: 5,
    about: "Schlick's approximation keeps the inside angle",
    file: "core/materials/refractive.h",
    from: "const N thinner = select(eta > one, cos_transmitted, cos_incident);",
    to: "const N thinner = cos_incident;",
    target: "test_materials",
    tests: ["Fresnel.SchlickIsOffByWhatTheCatalogueSays"],
  },
  {
    fault: 5,
    about: "a ray inside glass keeps the outside normal",
    file: `${kShapes}/primitive_set.h`,
    from: "out.normal.put(i, mine, s.normal * side);",
    to: "out.normal.put(i, mine, s.normal);",
    target: "test_techniques",
    tests: ["Slab.LightLeavesParallelAndShifted", "BallLens.*"],
  },
  {
    fault: 5,
    about: "a ray inside a body keeps the outside true normal",
    file: `${kShapes}/primitive_set.h`,
    from: "out.geometric.put(i, mine, s.geometric * side);",
    to: "out.geometric.put(i, mine, s.geometric);",
    target: "test_shapes",
    tests: ["Shapes/ShapeSurface.*PositionsLieOnTheShape/sphere"],
  },
  {
    fault: 5,
    about: "every ray counts as coming from the outside",
    file: `${kShapes}/primitive_set.h`,
    from: "out.side.put(i, mine, side);",
    to: "out.side.put(i, mine, N(1));",
    target: "test_techniques",
    tests: ["Slab.LightLeavesParallelAndShifted", "Prism.*"],
  },
];

const totalReflection = [
  {
    fault: 6,
    about: "beyond the critical angle light leaves that should be mirrored",
    file: "core/materials/refractive.h",
    from: "return {select(total, one, r),",
    to: "return {select(total, fresnel_schlick(f0, cos_incident), r),",
    target: "test_materials",
    tests: ["Refraction.BeyondTheCriticalAngleAllIsMirrored"],
  },
  {
    fault: 6,
    about: "light is lost on its way into glass",
    file: "core/materials/refractive.cpp",
    from: "Vec3<N>(one - split.reflectance)",
    to: "Vec3<N>((one - split.reflectance) * (one - split.reflectance))",
    target: "test_techniques",
    tests: ["Furnace.GlassUnderAnEvenSkyIsInvisible"],
  },
];

const negativeCosines = [
  {
    fault: 7,
    about: "metal takes the fifth power of 1 - cos with a negative cosine",
    file: "core/materials/reflective.cpp",
    from: "metal.reflectance(min_first(one, max_first(zero, cosine)))",
    to: "metal.reflectance(cosine)",
    target: "test_materials",
    tests: ["Fresnel.NormalsThatFaceAwayCreateNoLight"],
  },
  {
    fault: 7,
    about: "glass takes the fifth power of 1 - cos with a negative cosine",
    file: "core/materials/refractive.h",
    from: "const N cos_incident = min_first(one, max_first(zero, N(-dot(direction, normal))));",
    to: "const N cos_incident = N(-dot(direction, normal));",
    target: "test_materials",
    tests: ["Fresnel.NormalsThatFaceAwayCreateNoLight"],
  },
  {
    fault: 7,
    about: "a highlight is an even power of a negative cosine",
    file: "core/materials/rough.h",
    from: "return min_first(N(T(1)), max_first(N(T(0)), c));",
    to: "return min_first(N(T(1)), select(c < N(T(0)), N(-c), c));",
    target: "test_materials",
    tests: ["Highlight.HasNoNumberlessCorner"],
  },
];

const kAcross = {fault: 8, file: "core/cameras/camera_of.h", from: "- T(width)) * scale;"};
const aspect = [
  {
    ...kAcross,
    about: "both axes are centred by the height",
    to: "- T(height)) * scale;",
    target: "test_cameras",
    tests: ["CameraRays.HeightScalesBothAxes", "CameraRays.MirrorAboutTheMiddleToTheBit"],
  },
  {
    ...kAcross,
    about: "both axes are stretched to the same extent",
    to: "- T(width)) * (scale * T(height) / T(width));",
    target: "test_cameras",
    tests: ["CameraRays.HeightScalesBothAxes", "CameraRays.OrthographicRaysAreParallelAndSpacedByTheHeight"],
  },
  {
    ...kAcross,
    about: "both axes are stretched to the same extent, seen in pictures",
    to: "- T(width)) * (scale * T(height) / T(width));",
    target: "test_render",
    tests: ["Coverage.BallsAreRoundInAnyAspect"],
  },
];

const slabs = [
  {
    fault: 9,
    about: "a NaN on the near side of a slab loses the box",
    file: "core/math/bounds.h",
    from: "near = max_first(near, select(negative, t1, t0));",
    to: "near = max_first(N(select(negative, t1, t0)), near);",
    target: "test_math",
    tests: ["Slabs/?.KeepRaysInTheFacesAndRefuseTheOthers"],
  },
  {
    fault: 9,
    about: "a NaN on the far side of a slab loses the box",
    file: "core/math/bounds.h",
    from: "far = min_first(far, N(select(negative, t0, t1) * kFarPad));",
    to: "far = min_first(N(select(negative, t0, t1) * kFarPad), far);",
    target: "test_math",
    tests: ["Slabs/?.KeepRaysInTheFacesAndRefuseTheOthers"],
  },
  {
    fault: 9,
    about: "near <= far is decided without a margin for rounding",
    file: "core/math/bounds.h",
    from: "constexpr T kFarPad = 1 + 4 * std::numeric_limits<T>::epsilon();",
    to: "constexpr T kFarPad = 1;",
    target: "test_math",
    tests: ["Slabs/?.LoseNoneOfAMillionRaysThroughCorners"],
  },
  {
    fault: 9,
    about: "a NaN where a ray enters a box shape loses the hit",
    file: `${kShapes}/box.h`,
    from: "enter = max_first(enter, N((select(negative, hi_i, lo_i) - o) / d));",
    to: "enter = max_first(N((select(negative, hi_i, lo_i) - o) / d), enter);",
    target: "test_shapes",
    tests: ["Flat/?.BoxesAreMetByRaysWithinTheirFaces"],
  },
  {
    fault: 9,
    about: "a NaN where a ray leaves a box shape loses the hit",
    file: `${kShapes}/box.h`,
    from: "leave = min_first(leave, N((select(negative, lo_i, hi_i) - o) / d));",
    to: "leave = min_first(N((select(negative, lo_i, hi_i) - o) / d), leave);",
    target: "test_shapes",
    tests: ["Flat/?.BoxesAreMetByRaysWithinTheirFaces"],
  },
  {
    fault: 9,
    about: "a NaN at the near cap of a cylinder loses the hit",
    file: `${kShapes}/cylinder.h`,
    from: "max_first(select(parallel, -infinity, min_first(t0, t1)), near_cap);",
    to: "max_first(near_cap, select(parallel, -infinity, min_first(t0, t1)));",
    target: "test_shapes",
    tests: ["Cylinder.RaysInThePlaneOfACapMeetTheWall"],
  },
  {
    fault: 9,
    about: "a NaN at the far cap of a cylinder loses the hit",
    file: `${kShapes}/cylinder.h`,
    from: "min_first(select(parallel, infinity, max_first(t0, t1)), far_cap);",
    to: "min_first(far_cap, select(parallel, infinity, max_first(t0, t1)));",
    target: "test_shapes",
    tests: ["Cylinder.RaysInThePlaneOfACapMeetTheWall"],
  },
];

const sharesOfLight = [
  {
    fault: 10,
    about: "coefficients must be at most 0",
    file: "core/params/params.cpp",
    from: "Kind::coefficient, {.min = 0, .max = max}",
    to: "Kind::coefficient, {.min = -max, .max = 0}",
    target: "test_params",
    tests: ["Reader.CoefficientsTakeANumberOrAColour"],
  },
  {
    fault: 10,
    about: "glass may make light stronger on its way inside",
    file: "core/materials/refractive.cpp",
    from: '"What remains of light after one metre inside.", Vec3d(1), 1);',
    to: '"What remains of light after one metre inside.", Vec3d(1));',
    target: "test_load",
    tests: ["Load.HoldsSharesOfLightBetweenNothingAndAll"],
  },
  {
    fault: 10,
    about: "the share that a metal mirrors is below 0",
    file: "core/materials/reflective.cpp",
    from: "out.reflectance.put(i, mine, metal.",
    to: "out.reflectance.put(i, mine, -metal.",
    target: "test_materials",
    tests: ["Fresnel.GrazingMirrorsAllAndNothingLeavesTheUnitInterval"],
  },
  {
    fault: 10,
    about: "the share that glass mirrors is below 0",
    file: "core/materials/refractive.cpp",
    from: "out.reflectance.put(i, mine, Vec3<N>(split.reflectance));",
    to: "out.reflectance.put(i, mine, Vec3<N>(-split.reflectance));",
    target: "test_materials",
    tests: ["Fresnel.GrazingMirrorsAllAndNothingLeavesTheUnitInterval"],
  },
  {
    fault: 10,
    about: "the share that glass lets through is below 0",
    file: "core/materials/refractive.cpp",
    from: "out.transmittance.put(i, mine, Vec3<N>(one - split.reflectance));",
    to: "out.transmittance.put(i, mine, Vec3<N>(split.reflectance - one));",
    target: "test_materials",
    tests: ["Fresnel.GrazingMirrorsAllAndNothingLeavesTheUnitInterval"],
  },
];

const growth = [
  {
    fault: 10,
    about: "the tree of rays is one level deeper than asked",
    file: "core/techniques/specular_tree.cpp",
    from: "if (paths.depth >= plan.max_depth)",
    to: "if (paths.depth > plan.max_depth)",
    target: "test_techniques",
    tests: ["DepthLimit.LedgerIsWhatFacingMirrorsStillCarry"],
  },
  {
    fault: 10,
    about: "every surface sends on two rays, needed or not",
    file: "core/techniques/specular_tree.cpp",
    from: "const auto wanted = mask && max_component(weight) > N(T(0));",
    to: "const auto wanted = mask;",
    target: "test_techniques",
    tests: ["Growth.CountersObeyTheLawOfTheSlides"],
  },
  {
    fault: 10,
    about: "the tree of rays does not branch",
    file: "core/techniques/whitted.cpp",
    from: "this->follow(Kind::refracted, i, mine, specular.refracted.at(i), specular.transmittance.at(i));",
    to: "",
    target: "test_techniques",
    tests: ["Growth.DoublesWhereEverySurfaceSendsTwo"],
  },
  {
    fault: 10,
    about: "the count of rays grows with the objects",
    file: "core/techniques/wavefront.cpp",
    from: "+= static_cast<std::uint64_t>(reflected_->rays.count);",
    to: "+= static_cast<std::uint64_t>(reflected_->rays.count) * geometry_.material_of.size();",
    target: "test_techniques",
    tests: ["Growth.IsByBranchesAndNotByObjects"],
  },
  {
    fault: 10,
    about: "the list's tests of objects grow by their square",
    file: "core/accelerators/exhaustive.h",
    from: "counts.primitive_tests += primitives.size() * active_rays(rays, groups);",
    to: "counts.primitive_tests += primitives.size() * primitives.size() * active_rays(rays, groups);",
    target: "test_techniques",
    tests: ["Growth.IsLinearInObjectsForTheList"],
  },
];

export const faults = [
  ...cylinderRoots, ...originAsSign, ...lightDirections, ...fixedEpsilons, ...insideOfGlass,
  ...totalReflection, ...negativeCosines, ...aspect, ...slabs, ...sharesOfLight, ...growth,
  ...meshFaults, ...structureFaults, ...stageFaults,
  ...lightFaults, ...motionFaults, ...gateFaults, ...serviceFaults,
  ...planFaults, ...roundingFaults, ...studyFaults, ...imageFaults, ...pageFaults, ...optionFaults,
  ...certificateFaults, ...stabilityFaults,
];
