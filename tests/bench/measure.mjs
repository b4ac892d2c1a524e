// Interleaves the runs of both sides. The speed of a machine drifts, but little between consecutive runs.

export function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

// Shows a line on a terminal. The next call overwrites it, and "" clears it.
export function showProgress(text) {
  if (process.stderr.isTTY) process.stderr.write(`\r\x1b[K${text}`);
}

// Runs each side `pairs` times in the order ABBA, after one warm-up run each. The ratio is the median of
// theirs / ours over the pairs. Seconds are medians.
export async function measure(benchmark, pairs) {
  const sides = await benchmark.start();
  const ratios = [],
    oursCpuS = [],
    theirsCpuS = [];
  try {
    await sides.ours();
    await sides.theirs();
    for (let pair = 0; pair < pairs; ++pair) {
      showProgress(`${benchmark.name}: pair ${pair + 1} of ${pairs}`);
      let ours;
      if (pair % 2 === 0) ours = await sides.ours();
      const theirs = await sides.theirs();
      ours ??= await sides.ours();
      ratios.push(theirs.cost / ours.cost);
      oursCpuS.push(ours.cpuS);
      theirsCpuS.push(theirs.cpuS);
    }
  } finally {
    showProgress("");
    await sides.stop?.();
  }
  const { name, what, cost, reach, aim } = benchmark;
  return {
    name,
    what,
    cost,
    ratio: median(ratios),
    ratioMin: Math.min(...ratios),
    ratioMax: Math.max(...ratios),
    reach,
    aim,
    runs: pairs,
    oursCpuS: median(oursCpuS),
    theirsCpuS: median(theirsCpuS),
    remark: sides.remark,
  };
}
