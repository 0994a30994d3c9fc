/* charts.js - histograms and curves, as SVG. */

const SVG = "http://www.w3.org/2000/svg";
const HUES = ["var(--hue-1)", "var(--hue-2)", "var(--hue-3)", "var(--hue-4)", "var(--hue-5)", "var(--hue-6)"];

function draw(tag, attributes = {}, ...children) {
  const element = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

const write = (x, y, text, attributes = {}) => draw("text", { x, y, ...attributes }, text);

/* A frame with ticks; gives the functions that place numbers in it. */
function frame({ width, height, x, y, xTicks, yTicks = [], xLabel, about, left = 14 }) {
  const box = { left, right: 14, top: 16, bottom: 42 };
  const inside = { width: width - box.left - box.right, height: height - box.top - box.bottom };
  const atX = (value) => box.left + (value - x[0]) / (x[1] - x[0]) * inside.width;
  const atY = (value) => box.top + (y[1] - value) / (y[1] - y[0]) * inside.height;
  const svg = draw("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": about });
  for (const [value, label] of yTicks) {
    svg.append(draw("line", { class: "grid", x1: box.left, x2: width - box.right, y1: atY(value), y2: atY(value) }),
      write(box.left - 6, atY(value) + 4, label, { class: "tick", "text-anchor": "end" }));
  }
  for (const [value, label] of xTicks) {
    svg.append(draw("line", { class: "axis", x1: atX(value), x2: atX(value), y1: height - box.bottom, y2: height - box.bottom + 4 }),
      write(atX(value), height - box.bottom + 17, label, { class: "tick", "text-anchor": "middle" }));
  }
  svg.append(draw("line", { class: "axis", x1: box.left, x2: width - box.right, y1: height - box.bottom, y2: height - box.bottom }),
    write(box.left + inside.width / 2, height - 6, xLabel, { class: "label", "text-anchor": "middle" }));
  return { svg, atX, atY, bottom: height - box.bottom, right: width - box.right };
}

const SUPER = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const power = (base, n) => base + [...String(n)].map((digit) => SUPER[digit]).join("");
const total = (h) => Math.max(1, h.count.reduce((sum, n) => sum + n, 0) + h.below + h.above + h.notFinite);
const edge = (h, i) => h.low + i * h.step;

function range(h, others = []) {
  let first = h.count.length, last = -1;
  for (const one of [h, ...others]) {
    one.count.forEach((n, i) => {
      if (n > 0) {
        first = Math.min(first, i);
        last = Math.max(last, i);
      }
    });
  }
  return last < 0 ? [0, h.count.length] : [Math.max(0, first - 1), Math.min(h.count.length, last + 2)];
}

function bars(chart, h, [first, last], className) {
  for (let i = first; i < last; i++) {
    if (h.count[i] === 0) continue;
    const x = chart.atX(edge(h, i)), top = chart.atY(h.count[i] / total(h));
    chart.svg.append(draw("rect", { class: className, x: x + 0.5, y: top, height: Math.max(chart.bottom - top, 1),
      width: Math.max(chart.atX(edge(h, i + 1)) - x - 1, 0.5) }));
  }
}

function steps(chart, h, [first, last], className) {
  let path = `M${chart.atX(edge(h, first))} ${chart.bottom}`;
  for (let i = first; i < last; i++) {
    const y = chart.atY(h.count[i] / total(h));
    path += `V${y}H${chart.atX(edge(h, i + 1))}`;
  }
  chart.svg.append(draw("path", { class: className, d: path + `V${chart.bottom}` }));
}

const SIZE = { width: 400, height: 230 };
const highest = (...list) => Math.max(1e-9, ...list.flatMap((h) => h.count.map((n) => n / total(h)))) * 1.08;

function figure(svg, title, ...notes) {
  return make("figure", { className: "chart" }, make("h3", {}, title), svg, make("figcaption", {}, ...notes));
}

const keysOf = (...keys) => make("span", { className: "keys" },
  ...keys.map(([name, what]) => make("span", { className: "key key-" + name }, what)));

function luminanceChart(entry) {
  const a = reference.luminance, b = entry.luminance, span = range(a, [b]);
  const ticks = [];
  for (let e = Math.ceil(edge(a, span[0])); e <= edge(a, span[1]); e += Math.max(1, Math.round((span[1] - span[0]) / 16))) ticks.push([e, power("2", e)]);
  const chart = frame({ ...SIZE, x: [edge(a, span[0]), edge(a, span[1])], y: [0, highest(a, b)], xTicks: ticks,
    xLabel: "luminance, W/(m² sr)", about: "Histogram of luminance of reference and candidate" });
  steps(chart, a, span, "area-reference");
  steps(chart, b, span, "line-candidate");
  const dark = (h) => h.below > 0 ? percent(h.below / total(h), 2) : "none";
  return figure(chart.svg, "Luminance", keysOf(["reference", "reference"], ["candidate", "candidate"]), `Black: ${dark(a)} of the reference, ${dark(b)} of the candidate.`);
}

function quantile(h, share) {
  let left = share * total(h) - h.below;
  for (let i = 0; i < h.count.length; i++) {
    if (left <= h.count[i]) return edge(h, i) + h.step * Math.max(0, left) / (h.count[i] || 1);
    left -= h.count[i];
  }
  return edge(h, h.count.length);
}

const sayEqual = (h) => h.equal > 0 ? `${percent(h.equal / (3 * PIXELS), 2)} of all values are equal and not counted. ` : "";

const nothing = (title, text, note) => figure(make("p", { className: "nothing" }, text), title, note);
const allEqual = (h) => h.equal === 3 * PIXELS;

function relativeChart(entry) {
  const h = entry.relativeHistogram;
  if (allEqual(h)) return nothing("Relative error", "No value differs.", "");
  const span = range(h), ticks = [];
  for (let e = Math.ceil(edge(h, span[0])); e <= edge(h, span[1]); e++) ticks.push([e, e >= -3 && e <= 2 ? `${+(10 ** (e + 2)).toPrecision(1)} %` : power("10", e)]);
  const chart = frame({ ...SIZE, x: [edge(h, span[0]), edge(h, span[1])], y: [0, highest(h)], xTicks: ticks,
    xLabel: "relative error of a channel", about: "Histogram of relative errors" });
  bars(chart, h, span, "bar");
  if (total(h) > 1 && h.below < total(h) / 2) {
    const median = quantile(h, 0.5), x = chart.atX(clamp(median, edge(h, span[0]), edge(h, span[1])));
    chart.svg.append(draw("line", { class: "mark", x1: x, x2: x, y1: 12, y2: chart.bottom }),
      write(x + 5, 22, `median ${percent(10 ** median, 2)}`, { class: "tick" }));
  }
  return figure(chart.svg, "Relative error", `95 % of them are within ${percent(10 ** quantile(h, 0.95), 2)}. `
    + sayEqual(h) + (h.notFinite > 0 ? `${count(h.notFinite)} are not finite.` : ""));
}

function zChart(entry) {
  const h = entry.zHistogram;
  if (!h) return nothing("z-score", "Neither image says how noisy it is (no Variance channels).", "Where one does, this compares the difference with the noise.");
  if (allEqual(h)) return nothing("z-score", "No value differs.", "");
  const span = [0, h.count.length], normal = (z) => h.step * Math.exp(-z * z / 2) / Math.sqrt(2 * Math.PI);
  const chart = frame({ ...SIZE, x: [edge(h, 0), edge(h, span[1])], y: [0, Math.max(highest(h), 1.08 * normal(0))],
    xTicks: [-6, -4, -2, 0, 2, 4, 6].map((z) => [z, format(z)]), xLabel: "difference in standard errors, σ", about: "Histogram of z-scores and the normal curve" });
  bars(chart, h, span, "bar");
  let path = "";
  for (let z = -6; z <= 6; z += 0.1) path += `${path ? "L" : "M"}${chart.atX(z).toFixed(1)} ${chart.atY(normal(z)).toFixed(1)}`;
  chart.svg.append(draw("path", { class: "mark", d: path }));
  const outside = h.below + h.above + h.count.filter((_, i) => edge(h, i) < -3 || edge(h, i + 1) > 3).reduce((sum, n) => sum + n, 0);
  const known = ["", "of the reference alone", "of the candidate alone", "of both images"][entry.noise];
  return figure(chart.svg, "z-score", keysOf(["mark", "noise alone"]),
    `With the noise ${known}. Beyond 3 σ: ${percent(outside / total(h), 2)}; noise alone: 0.27 %. ` + sayEqual(h)
    + (h.below + h.above > 0 ? `${count(h.below + h.above)} values are beyond 6 σ and not drawn.` : ""));
}

/* ---- error against what it cost ---- */

const COSTS = {
  samples: { label: "samples a pixel", of: (entry) => entry.samples || null },
  seconds: { label: "seconds to render", of: (entry) => entry.cost?.seconds },
  records: { label: "records", of: (entry) => entry.cost?.records || entry.records?.count || null },
};
const errorOf = (entry) => overall(entry, "relativeRmse");
const pointsBy = (cost) => candidates.map((entry, index) => ({ entry, index, x: COSTS[cost].of(entry), y: errorOf(entry) }))
  .filter((p) => p.x > 0 && p.y > 0);

function decades([low, high]) {
  const ticks = [];
  for (let e = Math.floor(low); e <= Math.ceil(high); e++) {
    for (const m of high - low > 2.5 ? [1] : [1, 2, 5]) {
      const value = e + Math.log10(m);
      if (value >= low && value <= high) ticks.push(value);
    }
  }
  return ticks;
}

function convergenceChart(cost) {
  const points = pointsBy(cost), logs = (key) => points.map((p) => Math.log10(p[key]));
  const pad = (values, by) => [Math.min(...values) - by, Math.max(...values) + by];
  const x = pad(logs("x"), 0.18), y = pad(logs("y"), 0.2);
  const chart = frame({ width: Math.max($("curves").clientWidth, 300), height: 380, left: 58, x, y, xLabel: COSTS[cost].label, about: `Relative RMSE against ${COSTS[cost].label}`,
    xTicks: decades(x).map((v) => [v, format(10 ** v, 2)]), yTicks: decades(y).map((v) => [v, percent(10 ** v, 2)]) });
  const labels = [];
  const methods = [...new Set(points.map((p) => p.entry.method ?? p.entry.name))];
  methods.forEach((method, m) => {
    const line = points.filter((p) => (p.entry.method ?? p.entry.name) === method).sort((p, q) => p.x - q.x);
    const at = line.map((p) => [chart.atX(Math.log10(p.x)), chart.atY(Math.log10(p.y))]), hue = HUES[m % HUES.length];
    if (at.length > 1) chart.svg.append(draw("polyline", { class: "curve", points: at.join(" "), style: `stroke: ${hue}` }));
    line.forEach((p, i) => chart.svg.append(draw("circle", { cx: at[i][0], cy: at[i][1], r: 4.5, style: `fill: ${hue}` },
      draw("title", {}, `${p.entry.name}: ${format(p.x)} ${COSTS[cost].label}, ${percent(p.y)}`))));
    const [lastX, lastY] = at[at.length - 1], toLeft = lastX > chart.right - 130;
    let labelY = lastY - 9;
    while (labels.some(([x, y]) => Math.abs(x - lastX) < 150 && Math.abs(y - labelY) < 15)) labelY -= 4;
    labels.push([lastX, labelY]);
    chart.svg.append(write(lastX + (toLeft ? -9 : 9), labelY, method, { class: "curve-name", style: `fill: ${hue}`, "text-anchor": toLeft ? "end" : "start" }));
  });
  return chart.svg;
}
