// SVG chart of ratios with one line per row, worst first, and one dot per kind on a logarithmic axis around
// 1.

const COLORS = ["#0b6e99", "#d9730d", "#0f7b6c", "#ad1a72", "#6940a5", "#8a6d1d"];
const LINE = 17,
  LEFT = 190,
  WIDTH = 620,
  TOP = 66,
  TICKS = [0.25, 0.5, 0.75, 1, 1.5, 2, 3, 4];

const text = (x, y, words, { anchor = "start", size = 11, weight = "normal", color = "#333" } = {}) =>
  `<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" font-size="${size}" text-anchor="${anchor}" font-weight="${weight}" ` +
  `fill="${color}">${words}</text>`;

// Returns the chart of rows {name, ratios: {kind: ratio}}.
export function ratioChart(title, rows, kinds) {
  const worst = ({ ratios }) => Math.min(...kinds.filter((k) => ratios[k]).map((k) => ratios[k]));
  const sorted = [...rows].sort((a, b) => worst(a) - worst(b));
  const lo = Math.min(0.5, worst(sorted[0])),
    hi = Math.max(2, ...rows.flatMap((r) => kinds.map((k) => r.ratios[k] ?? 1)));
  const at = (ratio) => LEFT + (Math.log(ratio / lo) / Math.log(hi / lo)) * (WIDTH - LEFT - 20);
  const bottom = TOP + LINE * sorted.length + 6;
  const parts = [text(10, 20, title, { size: 14, weight: "bold" })];
  kinds.forEach((kind, i) => {
    const x = 10 + i * 92;
    parts.push(`<circle cx="${x + 4}" cy="37" r="4.5" fill="${COLORS[i]}"/>`, text(x + 13, 41, kind));
  });
  for (const tick of TICKS.filter((t) => t >= lo && t <= hi)) {
    const x = at(tick).toFixed(1),
      heavy = tick === 1;
    parts.push(`<line x1="${x}" y1="${TOP - 8}" x2="${x}" y2="${bottom}" stroke="${heavy ? "#444" : "#e4e4e4"}"/>`);
    parts.push(
      text(at(tick), bottom + 14, heavy ? "1 (equal)" : String(tick), { anchor: "middle", size: 10, color: "#666" }),
    );
  }
  sorted.forEach(({ name, ratios }, row) => {
    const y = TOP + LINE * row + 4;
    parts.push(text(LEFT - 8, y + 4, name, { anchor: "end" }));
    kinds.forEach((kind, i) => {
      if (!ratios[kind]) return;
      const inside = `<title>${name} ${kind}: ${ratios[kind].toFixed(2)}</title>`;
      parts.push(
        `<circle cx="${at(ratios[kind]).toFixed(1)}" cy="${y}" r="4.5" fill="${COLORS[i]}" fill-opacity="0.85">${inside}</circle>`,
      );
    });
  });
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${WIDTH}" height="${bottom + 24}" font-family="sans-serif">` +
    `<rect width="100%" height="100%" fill="white"/>${parts.join("")}</svg>\n`
  );
}
