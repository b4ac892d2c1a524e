// Mistakes of what a picture tells of its error, as faults.mjs has them: fault 32.

const entry = (about, file, from, to, ...tests) => ({ fault: 32, about, file, from, to, target: "test_render", tests });

const kRange = "core/load/radiance_range.cpp", kWavefront = "core/techniques/wavefront.cpp";
const kRandom = "Ledger.BoundsTheErrorOfRandomScenes";

export const certificateFaults = [
  entry("no highlight is brighter than its surface", "core/materials/rough.cpp", "diffuse + specular, diffuse", "diffuse, diffuse",
        "RadianceRange.OfThePapersScene*", "RadianceRange.HoldsAllRadiance*"),
  entry("nothing is brighter than 1", kRange, "shines + product(limits.light, light.of_points)", "Vec3d(1)",
        "RadianceRange.OfThePapersScene*"),
  entry("a lamp that mirrors is as bright as one that does not", kRange, "Vec3d(limits.specular ? 1 : 0)", "Vec3d(0)",
        "RadianceRange.IsUnknown*"),
  entry("what is not traced is taken for ambient light", "core/plan/plan.cpp", "facts.tree_radiance.most_off(scene_.ambient)",
        "scene_.ambient", "Ledger.CountsASubstitute*", "Ledger.OfALightGuide*"),
  entry("a substitute is never too bright", "core/model/radiance_range.h", "largest(most - substitute, substitute - least)",
        "most - substitute", "Ledger.CountsASubstitute*"),
  entry("the ledger has one channel", kWavefront, "product(weight.z[lane], range.z)", "T(0)", kRandom),
  entry("the ledger has the largest ray instead of all", kWavefront, "out_->omitted[slot] + most", "largest(out_->omitted[slot], most)",
        kRandom),
  entry("what is clamped goes without a word", "core/techniques/path_tracer.cpp", "this->clamped().put(i, all - some);",
        "this->clamped().put(i, Vec3<N>(N(T(0))));", "Clamp.LedgerIs*"),
  entry("lamps that a lobe meets are clamped", "core/techniques/path_tracer.cpp", "second && (reuse_ || indirect_)", "second && reuse_",
        "Clamp.KeepsDirect*"),
  entry("what was not seen is not there", "core/render/unit_histogram.cpp", "double kept = std::max(mean(), 1e-18), rejected = 1;",
        "return mean(); double kept = 0, rejected = 1;", "UpperMean.OfNothing*", "UpperMean.HoldsWhere*", "Certificate.NeverTells*"),
  entry("halves differ by half as much", "core/render/tile_renderer.cpp", "const double scale = 2.0 /", "const double scale = 1.0 /",
        "Certificate.OfSamplesIsNotFar*"),
  entry("a total is as strong as its strongest term", "core/model/bound.h", "std::max(kind, other.kind)", "std::min(kind, other.kind)",
        "Certificate.IsAsWeak*"),
  entry("the ledger of the last pass is that of the picture", "core/render/frame.cpp",
        "stats_.omitted.join(omitted_before);", "", "Certificate.OfPasses*"),
  entry("an estimate counts as a bound", "core/render/budget.cpp",
        "return certificate_.total().rms && *certificate_.total().rms <= error_;", "return *certificate_.estimate <= error_;",
        "ErrorBudget.IsMet*", "ErrorBudget.NamesWhat*"),
  entry("a budget changes the samples that were asked", "core/render/budget.cpp", "error_ > 0 && plan_->free_samples && is_near_enough()",
        "error_ > 0 && is_near_enough()", "ErrorBudget.KeepsWhat*"),
  entry("a pass that was given up stays in the film", "core/render/budget.cpp", "kept_ = passes.film().copy();", "", "TimeBudget.EndsInTime*"),
  entry("what does not fit is begun", "core/render/budget.cpp", "if (fit < next) {", "if (fit < 0) {", "TimeBudget.EndsInTime*"),
  entry("halves are taken in radiance where a display is asked", "core/render/tile_renderer.cpp",
        "display ? encode_srgb(first * share) - encode_srgb(second * share) : (first - second) * scale",
        "(first - second) * scale", "ErrorBudget.HoldsOverSeeds", "ErrorBudget.IsMet*"),
  entry("codes of 8 bits are exact", "core/render/certificate.cpp", "if (display) found.terms.push_back(encoding_term());", "",
        "ErrorBudget.NamesWhat*"),
];
