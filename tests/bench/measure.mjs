// Interleaved runs: the speed of a machine drifts, but not the ratio of two neighbouring runs.

export function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

// Shows one line on a terminal, which the next call overwrites. "" clears it.
export function show_progress(text) {
  if (process.stderr.isTTY) process.stderr.write(`\r\x1b[K${text}`);
}

// Runs each side `pairs` times in the order ABBA, after a warm-up of each. The ratio is the median of theirs
// / ours by pair. Seconds are medians.
export async function measure(benchmark, pairs) {
  const sides = await benchmark.start();
  const ratios = [],
    ours_cpu_s = [],
    theirs_cpu_s = [];
  try {
    await sides.ours();
    await sides.theirs();
    for (let pair = 0; pair < pairs; ++pair) {
      show_progress(`${benchmark.name}: pair ${pair + 1} of ${pairs}`);
      let ours;
      if (pair % 2 === 0) ours = await sides.ours();
      const theirs = await sides.theirs();
      ours ??= await sides.ours();
      ratios.push(theirs.cost / ours.cost);
      ours_cpu_s.push(ours.cpu_s);
      theirs_cpu_s.push(theirs.cpu_s);
    }
  } finally {
    show_progress("");
    await sides.stop?.();
  }
  const { name, what, cost, reach, aim } = benchmark;
  return {
    name,
    what,
    cost,
    ratio: median(ratios),
    ratio_min: Math.min(...ratios),
    ratio_max: Math.max(...ratios),
    reach,
    aim,
    runs: pairs,
    ours_cpu_s: median(ours_cpu_s),
    theirs_cpu_s: median(theirs_cpu_s),
    remark: sides.remark,
  };
}
