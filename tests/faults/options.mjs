// Mistakes of what the option table is used for, as faults.mjs has them: fault 23 gives a picture a key that is not
// its own, 24 loses what was asked on its way.

const options = (fault, about, from, to, target, ...tests) => ({
  fault, about, file: "core/plan/options.cpp", from, to, target, tests,
});

export const optionFaults = [
  options(23, "an option that changes no pixel is in the key",
          '.help = "How rays find what they meet.",\n      .changes_pixels = false}', '.help = "How rays find what they meet."}',
          "test_app", "RenderOptions.AreInTheKeyIfTheyChangePixels"),
  options(23, "an option that changes pixels is not in the key",
          '.help = "Seed of all random choices."}', '.help = "Seed of all random choices.",\n      .changes_pixels = false}',
          "test_app", "RenderOptions.AreInTheKeyIfTheyChangePixels"),
  options(23, "the same moment of the motion has several keys", "all.time = scene.motion.moment(*all.time, *all.shutter);", "",
          "test_app", "RenderOptions.ThatSayWhatTheSceneSays*"),
  options(24, "the scene's own settings come before the request's", "if (!option.given(all)) option.copy(otherwise, all);",
          "if (option.given(otherwise)) option.copy(otherwise, all);", "test_plan", "RenderOptions.OfARequestComeBefore*"),
  options(24, "missing options of a request become defaults", "if (p.has(key)) settings.*of.member", "settings.*of.member",
          "test_plan", "RenderOptions.AreReadUpToTheirLimits*"),
  options(24, "a budget of time keeps rays as short as the scene says", "if (!settings.max_depth) settings",
          "if (!settings.max_depth && settings.error.value_or(0) > 0) settings", "test_plan", "RenderOptions.BudgetsFree*"),
  {
    fault: 24,
    about: "the written plan leaves the precision to the next plan",
    file: "core/plan/plan.cpp",
    from: "  settings.precision = plan.double_precision ? Precision::double_precision : Precision::single_precision;\n",
    to: "",
    target: "test_plan",
    tests: ["Plan.WrittenAsARequest*"],
  },
];
