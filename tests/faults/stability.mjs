// Mistakes of numerical methods and of the page that tells about them, as faults.mjs has them: fault 33.

const entry = (about, file, from, to, ...tests) => ({ fault: 33, about, file, from, to, target: "test_stability", tests });

export const stabilityFaults = [
  entry("unit vectors are not scaled first", "core/math/vec3.h", "const Vec3<N> scaled = a / largest;", "const Vec3<N> scaled = a;",
        "Rows/Stability.*/A31"),
  entry("a basis about a normal has no side for -z", "core/math/hemisphere.h", "sign = select(signbit(n.z), N(-one), one);",
        "sign = select(signbit(n.z), N(one), one);", "Rows/Stability.*/A30"),
  entry("every row keeps its bound", "core/stability/row.h", "return figures.ours <= row.ours_at_most;", "return true;",
        "StabilityReport.SaysWhatIsNotKept"),
  entry("zeros are drawn at the least value", "core/stability/line_chart.cpp", "kBottom - kZeroLane / 3", "kBottom - kZeroLane",
        "StabilityChart.ShowsZeros*"),
];
