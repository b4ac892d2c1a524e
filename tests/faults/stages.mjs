// Mistakes of the stages in front of a structure, as faults.mjs has them: fault 14 believes a prediction, 15
// mixes up rays, 16 does not learn.

const entry = (fault, about, file, from, to, ...tests) => ({
  fault, about, file: file.includes("/") ? file : `core/stages/${file}`, from, to, target: "test_accelerators", tests,
});

export const stageFaults = [
  entry(14, "what is proposed is taken for an occluder", "prediction.cpp",
        "proposed.kernel->occlude(proposed.index, rays_, one, counts_);",
        "rays_.t_max.put(i, Lanes<T>(T(proposed.index < 0 ? 1 : -1)));", "PredictionOfShadows.*"),
  entry(14, "a ray for which nothing is proved is taken for lit", "prediction.cpp",
        "this->behind_->occlude(rays, with_active_rays(rays, active), counts);", "", "PredictionOfShadows.*"),
  entry(14, "a proposal may be a number of no primitive", "prediction.cpp",
        "if (primitive < 0 || primitive >= static_cast<std::int64_t>(primitives_.size())) return;", "",
        "PredictionOfShadows.*"),
  entry(14, "the ray that tells the last occluder is lit afterwards", "prediction.cpp",
        "rays.t_max.put(i, others);", "if (before[0] != before[0]) rays.t_max.put(i, others);", "PredictionOfShadows.*"),
  entry(14, "every proposal counts as a proof", "prediction.cpp", "open - active_rays(rays_, one)", "open",
        "PredictionCounts.TellProposalsFromProofs"),
  entry(14, "a hit that is known is forgotten by its number", "core/accelerators/single_ray.h", "{hits.t[i], hits.primitive[i]}",
        "{hits.t[i], IndexOf<T>(kNoPrimitive)}", "All/KnownHits.*"),
  entry(15, "distances go back to the places of others", "reordered.cpp",
        "hits.t[place_of(order, from)] = found.t[from];", "hits.t[from] = found.t[from];", "All/Reordering.*"),
  entry(15, "rays of one key change places", "reordered.cpp",
        "for (std::size_t i = 0; i < count; ++i) {", "for (std::size_t i = count; i-- > 0;) {",
        "RayOrders/0.KeepTheOrderOfEqualKeys", "RayOrders/1.KeepTheOrderOfEqualKeys"),
  entry(15, "a NaN becomes a cell", "reordered.cpp", "max_first(N(0), N((x - lo) * scale))",
        "max_first(N((x - lo) * scale), N(0))", "RayOrders/0.PutNaNInTheLowestCell",
        "RayOrders/1.PutNaNInTheLowestCell"),
  entry(16, "a layer forgets what is added", "network.h", "N a = weight(row[kIn])", "N a = weight(0)",
        "Scores/*.AreThoseOfAPlainEvaluation"),
  entry(16, "training climbs", "network.cpp", "network.weights[i] -= rate", "network.weights[i] += rate",
        "Training.LowersTheLossAlsoOfWhatWasNotSeen", "NetworkPredictor.ProposesWhatStoodInTheWay"),
];
