// Mistakes of the plan, as faults.mjs has them: fault 23 leaves out what the picture needs, or keeps what it does not;
// fault 20 (see service.mjs) expects another cost than the picture's.

const entry = (about, from, to, ...tests) => ({
  fault: 23, about, file: "core/plan/plan.cpp", from, to, target: "test_plan", tests: tests.map((name) => `Plan.${name}`),
});
const warning = (about, from, to, ...tests) => ({
  fault: 23, about, file: "core/plan/warnings.cpp", from, to, target: "test_plan",
  tests: tests.map((name) => `Warnings.${name}`),
});

const cost = (about, from, to, ...tests) => ({
  fault: 20, about, file: "core/plan/cost.cpp", from, to, target: "test_plan", tests: tests.map((name) => `Cost.${name}`),
});

export const planFaults = [
  cost("cost ignores branching", "descendants * children", "descendants * std::min(children, 1.0)", "OfGlassGrows*", "OfGlassIsCut*"),
  cost("cost ignores the least contribution", "std::min(descendants * children, most)", "std::min(descendants * children, 1e9 * most)", "OfGlassIsCut*"),
  cost("cost ignores lights", "static_cast<double>(scene.lights.size())", "1", "OfRoughThings*"),
  entry("an eye inside the only body sees no shadows", "!shapes->bounds(0).contains(plan_.frame.eye)", "true",
        "LeavesOutShadowsOfALonelyConvexBody"),
  entry("two bodies are taken for one", "scene_.primitive_count() != 1", "scene_.primitive_count() > 2",
        "LeavesOutShadowsOfALonelyConvexBody", "LonelyMirrorNeedsNoDepth"),
  entry("light that enters a lonely glass ball does not leave it", "if (!used.transmits && lonely_convex()",
        "if (lonely_convex()", "LonelyMirrorNeedsNoDepth"),
  entry("float is taken to be enough for every scene", "!(double{std::numeric_limits<float>::epsilon()} <= limit.epsilon)", "false",
        "ChoosesDoubleWhereFloatWouldShow"),
  entry("a light of intensity 0 is followed", "intensity(light.index) != Vec3d(0)", "intensity(light.index) != Vec3d(-1)",
        "LeavesOutLightThatNothingAnswers"),
  entry("coloured glass weakens nothing", "plan_.specular && used.filters", "false",
        "LeavesOutMirroredAndRefractedRays"),
  warning("paths are taken to meet lights without extent", "!lights.traits().delta) continue;", "true) continue;", "NameLights*"),
  warning("rough glass is taken for smooth", "traits.mirrors && (!traits.lit || set->mirrored_share(i) > 0)", "traits.transmits || traits.mirrors", "NameLights*"),
  warning("a camera in a room with a lamp is warned of", "return rays_.t_max[0] > 0;", "return false;", "KnowThatARoomHasALamp"),
  warning("a camera in the corner of a ball's box is taken to be in the ball",
          "return met_.side[0] < 0;", "return true;",
          "TellThatTheCameraIsInsideAnOpaqueShape"),
  warning("what is below the view counts as seen", "-y > top", "false", "TellThatNothingIsInView"),
];
