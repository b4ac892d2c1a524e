// Interleaved runs: a machine's speed drifts, the ratio of two runs side by side does not.

export function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const middle = sorted.length >> 1;
  return sorted.length % 2 === 1 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}

// One line on a terminal, which the next call writes over; "" clears it.
export function show_progress(text) {
  if (process.stderr.isTTY) process.stderr.write(`\r\x1b[K${text}`);
}

// `pairs` runs of each side in the order ABBA, after one of each that does not count. The ratio is that of
// theirs to ours, pair by pair; seconds are medians.
export async function measure(benchmark, pairs) {
  const sides = await benchmark.start();
  const ratios = [], ours_cpu_s = [], theirs_cpu_s = [];
  try {
    await sides.ours();
    await sides.theirs();
    for (let pair = 0; pair < pairs; ++pair) {
      show_progress(`${benchmark.name}: pair ${pair + 1} of ${pairs}`);
      let ours, theirs;
      if (pair % 2 === 0) ours = await sides.ours();
      theirs = await sides.theirs();
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
