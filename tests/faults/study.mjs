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
  entry("a standard deviation divides by n", "chart.cpp", "static_cast<double>(rounds.size() - 1)",
        "static_cast<double>(rounds.size())", "Point.SumsUpItsRounds"),
  entry("noise makes a front", "chart.cpp", "kNearer = 0.99", "kNearer = 1", "Front.TakesAOnePercentSmallerErrorForNoSmaller"),
  entry("rounds that shift alike count as noise", "chart.cpp", "values.push_back(difference(a.rounds[i], b.rounds[i]));",
        "values.push_back(difference(a.rounds[i], b.rounds[b.rounds.size() - 1 - i]));", "Front.ComparesPointsRoundByRound"),
  entry("what is beaten beyond the intervals stays on the front", "chart.cpp", "return is_apart(*p, q);", "return false && is_apart(*p, q);",
        "Front.HoldsNothingThatIsBeatenBeyondTheIntervals"),
  entry("errors that the reference cannot tell make a front", "chart.cpp", "std::max(rmse_of(a), floor)", "rmse_of(a)",
        "Front.TakesErrorsBelowTheFloorForTheFloor"),
  entry("an interval is that of one round", "interval.cpp", "std::sqrt(squares / (count - 1) / count)",
        "std::sqrt(squares / (count - 1))", "Point.HasIntervalsOfItsMeans", "Point.IntervalsHoldTheMeanThatTheyPromise"),
  entry("three rounds tell as much as endlessly many", "interval.cpp",
        "static_cast<int>(values.size()) - 1)", "200)", "Point.IntervalsHoldTheMeanThatTheyPromise",
        "Study.IntervalsHoldTheErrorsOfOtherSeeds"),
  entry("every round repeats the same random numbers", "study.cpp", "kReferences + turn.round", "kReferences",
        "Study.TakesTurnsRoundByRoundWithOtherSeeds", "Study.IntervalsHoldTheErrorsOfOtherSeeds"),
  entry("rounds go to what is beaten", "study.cpp", "if (round + 1 >= kFirstRounds && !different[i].on_front())", "if (false)",
        "Study.SpendsRoundsWhereTheyDecide"),
  entry("a plan is of another seed than its point", "study.cpp", "plans_of(request_of(point))",
        "plans_of(request(point.configuration, 0))", "Study.GivesThePlanThatRendersThePointsPicture"),
  entry("a negative is as similar as the picture", "ssim.cpp", "(2 * covariance + kFlat)", "(2 * std::fabs(covariance) + kFlat)",
        "Ssim.OfAPatternAndItsNegativeIsNegative"),
  entry("the reference is its last picture alone", "study.cpp", "(double(reference_[i]) + double(values[i])) / kReferences",
        "double(values[i])", "Study.MeasuresWhatAnyoneWould"),
];
