// Mistakes of path tracing, as faults.mjs has them: fault 26 draws light or directions wrongly, 27 shares paths wrongly,
// 28 tells another error than the picture has, 29 scatters
// other light at a surface than arrives.

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
  entry(27, "who failed to draw takes no part in sharing", "core/stages/path_reuse.cpp", "const bool connected = lit_[slot] > 0",
        "const bool connected = pdf_[slot] > 0", "test_techniques", "PathMaterials.Sharing*"),
  entry(29, "refracted light is spread as if it were mirrored", "core/materials/glass.h", "to_light * eta * eta /", "to_light * eta /",
        "test_materials", "Glass.LosesAndMakes*", "Materials/Scattering.DrawsInProportion*Glass*"),
  entry(29, "a reflected draw that sinks counts as refracted", "core/materials/lobes.h", "(local_light.z < zero) == drawn.through &&", "",
        "test_materials", "Glass.LosesAndMakes*", "Glass.LosesNoLight*"),
  entry(29, "light comes out of rough glass as it went in", "core/materials/glass.h", "const auto filters = is_inside &&",
        "const auto filters = !is_inside &&", "test_materials", "Glass.RoughFilters*"),
  entry(29, "the base under a coat gets what the coat has mirrored", "core/materials/plastic.h", "(one - mirrors) * (one - mirrored(cosine)) * cosine",
        "(one - mirrors) * cosine", "test_materials", "Plastic.*", "Materials/Scattering.IsTheSame*Plastic"),
  entry(29, "the base of metallic-roughness gets what facets have mirrored", "core/materials/metallic_roughness.h", "left(seen) * left(given)",
        "left(seen)", "test_materials", "MetallicRoughness.CreatesNoEnergy", "Materials/Scattering.IsTheSame*/MetallicRoughness"),
  entry(29, "a sheet sends through what it should send back", "core/materials/translucent.cpp",
        "select(through, sheet.transmittance, sheet.reflectance)", "sheet.reflectance", "test_materials", "Translucent.*"),
];
