// Mistakes of path tracing, as faults.mjs has them: fault 26 draws light or directions wrongly, 27 shares paths wrongly,
// 28 tells another error than the picture has.

const entry = (fault, about, file, from, to, target, ...tests) => ({ fault, about, file, from, to, target, tests });

export const lightFaults = [
  entry(26, "dimensions of one sample come in one order", "core/math/sampling.h", "scramble_reversed<Bits>(Bits(reverse_bits(sample)), order)",
        "Bits(reverse_bits(sample)) + order * 0u", "test_math", "Sampling.TwoStreams*"),
  entry(26, "light that is met by chance counts in full", "core/stages/sampled_light.cpp",
        "select(by_lobe > zero && by_light > zero, power_heuristic(by_lobe, by_light), one)", "one", "test_techniques",
        "Path.IrradianceOf*", "Rooms/PathFurnace.*"),
  entry(26, "a flat lamp lights itself", "core/lights/emitters.cpp", "const N reach = distance - step /", "const N reach = distance - N(T(0)) * step /",
        "test_techniques", "Path.ConvexLamps*"),
  entry(26, "paths that survive carry no more than before", "core/techniques/path.cpp", "throughput = throughput * (one / chance);", "",
        "test_techniques", "Rooms/PathFurnace.*"),
  entry(27, "what mirrors find is shared", "core/stages/path_reuse.cpp", "if (!(pdf_[slot] > 0)) continue;", "", "test_techniques",
        "Path.SharingLeavesOut*"),
  entry(27, "a second vertex is weighted by its own density alone", "core/stages/path_reuse.cpp", "turn < group_; ++turn)\n      sum +=",
        "turn < 1; ++turn)\n      sum +=", "test_techniques", "Path.Sharing*"),
  entry(28, "the error is that of a half", "core/render/tile_renderer.cpp", "(2 * first_half_[c][i] - sums_.radiance[c][i]) * share",
        "(2 * first_half_[c][i] - sums_.radiance[c][i]) * share * 2", "test_render", "SampledError.IsTheError*"),
];
