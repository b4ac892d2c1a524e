// SVG charts: panels with scatter and line plots.

const PANEL = { width: 300, height: 250 },
  MARGIN = { left: 52, right: 14, top: 34, bottom: 42 };
const COLORS = ["#0b6e99", "#d9730d", "#0f7b6c", "#ad1a72", "#6940a5", "#8a6d1d"];

const escape = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");
const round = (x) => Math.round(x * 100) / 100;

function text(x, y, words, { size = 11, anchor = "middle", color = "#333", weight = "normal", turn = 0 } = {}) {
  const turned = turn ? ` transform="rotate(${turn} ${round(x)} ${round(y)})"` : "";
  return (
    `<text x="${round(x)}" y="${round(y)}" font-size="${size}" text-anchor="${anchor}" fill="${color}"` +
    ` font-weight="${weight}"${turned}>${escape(words)}</text>`
  );
}

// Returns the mark of series i: a dot, or a square if i is at least the number of colours.
function mark(i, x, y, title) {
  const color = COLORS[i % COLORS.length],
    inside = title ? `<title>${escape(title)}</title>` : "";
  if (i < COLORS.length) return `<circle cx="${x}" cy="${y}" r="4.5" fill="${color}">${inside}</circle>`;
  return `<rect x="${round(x - 4.5)}" y="${round(y - 4.5)}" width="9" height="9" fill="${color}">${inside}</rect>`;
}

// Returns a logarithmic axis between the powers of ten that enclose the values.
function logAxis(values, from, to) {
  const lo = Math.floor(Math.log10(Math.min(...values)) - 1e-9),
    hi = Math.ceil(Math.log10(Math.max(...values)) + 1e-9);
  const at = (value) => from + ((Math.log10(value) - lo) / (hi - lo)) * (to - from);
  const ticks = Array.from({ length: hi - lo + 1 }, (_, i) => 10 ** (lo + i));
  return { at, ticks };
}
function linearAxis(values, from, to) {
  const most = Math.max(...values),
    step = 10 ** Math.floor(Math.log10(most));
  const tick = [0.2, 0.5, 1, 2].map((f) => f * step).find((t) => most / t <= 6) ?? 2 * step;
  const top = Math.ceil(most / tick) * tick;
  const at = (value) => from + (value / top) * (to - from);
  return { at, ticks: Array.from({ length: Math.round(top / tick) + 1 }, (_, i) => i * tick) };
}

const tickName = (value) => {
  if (value >= 1e4 || (value > 0 && value < 1e-3)) return `1e${Math.round(Math.log10(value))}`;
  return String(Number(value.toPrecision(3)));
};

// Draws a panel of {title, x, y, series, yAxis}. `x` and `y` are axis names, `yAxis` is "log" or "linear". A
// series is {name, points: [{x, y, label?, ring?}], line?}.
function panel({ title, x, y, series, yAxis = "log" }, left, top) {
  const inner = {
    x0: left + MARGIN.left,
    x1: left + PANEL.width - MARGIN.right,
    y0: top + PANEL.height - MARGIN.bottom,
    y1: top + MARGIN.top,
  };
  const points = series.flatMap((s) => s.points);
  const across = logAxis(
    points.map((p) => p.x),
    inner.x0,
    inner.x1,
  );
  const up = (yAxis === "log" ? logAxis : linearAxis)(
    points.map((p) => p.y),
    inner.y0,
    inner.y1,
  );
  const parts = [text((inner.x0 + inner.x1) / 2, top + 18, title, { size: 13, weight: "bold" })];
  for (const tick of across.ticks) {
    const at = round(across.at(tick));
    parts.push(`<line x1="${at}" y1="${inner.y0}" x2="${at}" y2="${inner.y1}" stroke="#e4e4e4"/>`);
    parts.push(text(at, inner.y0 + 15, tickName(tick), { size: 10, color: "#666" }));
  }
  for (const tick of up.ticks) {
    const at = round(up.at(tick));
    parts.push(`<line x1="${inner.x0}" y1="${at}" x2="${inner.x1}" y2="${at}" stroke="#e4e4e4"/>`);
    parts.push(text(inner.x0 - 6, at + 3, tickName(tick), { size: 10, color: "#666", anchor: "end" }));
  }
  parts.push(text((inner.x0 + inner.x1) / 2, inner.y0 + 32, x, { color: "#555" }));
  parts.push(text(left + 14, (inner.y0 + inner.y1) / 2, y, { color: "#555", turn: -90 }));
  series.forEach((one, i) => parts.push(...drawSeries(one, i, across, up)));
  return parts;
}

function drawSeries({ points, line }, i, across, up) {
  const color = COLORS[i % COLORS.length],
    parts = [];
  const place = (p) => [round(across.at(p.x)), round(up.at(p.y))];
  if (line) {
    const path = points.map((p) => place(p).join(",")).join(" ");
    parts.push(`<polyline points="${path}" fill="none" stroke="${color}" stroke-width="2"/>`);
  }
  for (const p of points) {
    const [x, y] = place(p);
    if (p.ring) parts.push(`<circle cx="${x}" cy="${y}" r="9" fill="none" stroke="${color}" stroke-width="2"/>`);
    parts.push(mark(i, x, y, p.label));
  }
  return parts;
}

// Returns a chart of panels in rows of `columns`, with a legend of `names` in the colours of the series.
export function chart({ title, note, panels, columns, names }) {
  const rows = Math.ceil(panels.length / columns),
    wide = columns * PANEL.width;
  const legendRows = Math.ceil(names.length / Math.max(1, Math.floor(wide / 140)));
  const top = 46,
    height = top + rows * PANEL.height + 24 * legendRows + 34;
  const parts = [text(wide / 2, 26, title, { size: 17, weight: "bold" })];
  panels.forEach((one, i) => {
    parts.push(...panel(one, (i % columns) * PANEL.width, top + Math.floor(i / columns) * PANEL.height));
  });
  const aRow = Math.ceil(names.length / legendRows);
  names.forEach((name, i) => {
    const x = ((i % aRow) + 0.5) * (wide / aRow) - 50;
    const y = top + rows * PANEL.height + 16 + 24 * Math.floor(i / aRow);
    parts.push(mark(i, round(x), y));
    parts.push(text(x + 10, y + 4, name, { anchor: "start" }));
  });
  parts.push(text(wide / 2, height - 12, note, { size: 11, color: "#555" }));
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${wide} ${height}" width="${wide}" height="${height}"` +
    ` font-family="system-ui, sans-serif">\n<rect width="100%" height="100%" fill="#fff"/>\n${parts.join("\n")}\n</svg>\n`
  );
}
