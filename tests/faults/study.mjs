// Mistakes of charts, as faults.mjs has them: fault 24 measures something else than it says.

const entry = (about, file, from, to, ...tests) => ({
  fault: 24, about, file: `core/study/${file}`, from, to, target: "test_study", tests,
});

export const studyFaults = [
  entry("a bias has no sign", "difference.cpp", "sum += d;", "sum += std::fabs(d);", "Difference.HasASign"),
  entry("relative errors in the dark are infinite", "difference.cpp", "((r + kDark) * (r + kDark))", "(r * r)",
        "Difference.IsRelativeToTheReferenceAndAHundredth"),
  entry("a NaN of the reference counts as an error", "difference.cpp", "!std::isfinite(x) || !std::isfinite(r)",
        "!std::isfinite(x)", "Difference.LeavesOutWhatIsNotFiniteAndCountsIt"),
  entry("what no screen shows counts in PSNR", "difference.cpp", "std::clamp(x, 0.0, 1.0) - std::clamp(r, 0.0, 1.0)", "d",
        "Difference.SeesNoMoreThanAScreenWhereItIsCut"),
  entry("the median of two is the larger", "chart.cpp",
        "times.size() % 2 == 1 ? times[half] : (times[half - 1] + times[half]) / 2", "times[half]",
        "Point.SumsUpItsRounds"),
  entry("a standard deviation divides by n", "chart.cpp", "static_cast<double>(rounds.size() - 1)",
        "static_cast<double>(rounds.size())", "Point.SumsUpItsRounds"),
  entry("noise makes a front", "chart.cpp", "kNearer = 0.99", "kNearer = 1", "Front.TakesAOnePercentSmallerErrorForNoSmaller"),
  entry("every round repeats the same random numbers", "study.cpp", "kReferences + rounds_before", "kReferences",
        "Study.TurnsThroughTheRungsRoundByRoundWithOtherSeeds"),
  entry("the reference is its last picture alone", "study.cpp", "(double(reference_[i]) + double(values[i])) / kReferences",
        "double(values[i])", "Study.MeasuresWhatAnyoneWould"),
];
