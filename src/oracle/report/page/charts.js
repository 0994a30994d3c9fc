/* charts.js - histograms and curves, as SVG. */

const SVG = "http://www.w3.org/2000/svg";
const HUES = [1, 2, 3, 4, 5, 6].map((n) => `var(--hue-${n})`);

function draw(tag, attributes = {}, ...children) {
  const element = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

const write = (x, y, text, attributes = {}) => draw("text", { x, y, ...attributes }, text);
const line = (className, x1, y1, x2, y2) => draw("line", { class: className, x1, x2, y1, y2 });

/* A frame with ticks; gives the functions that place numbers in it. */
function frame({ width, height, x, y, xTicks, yTicks = [], xLabel, about, left = 14 }) {
  const top = 16, right = width - 14, bottom = height - 42;
  const atX = (value) => left + (value - x[0]) / (x[1] - x[0]) * (right - left);
  const atY = (value) => top + (y[1] - value) / (y[1] - y[0]) * (bottom - top);
  const svg = draw("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": about });
  for (const [value, label] of yTicks) {
    const at = atY(value);
    svg.append(line("grid", left, at, right, at),
      write(left - 6, at + 4, label, { class: "tick", "text-anchor": "end" }));
  }
  for (const [value, label] of xTicks) {
    const at = atX(value);
    svg.append(line("axis", at, bottom, at, bottom + 4),
      write(at, bottom + 17, label, { class: "tick", "text-anchor": "middle" }));
  }
  const center = left + (right - left) / 2;
  svg.append(line("axis", left, bottom, right, bottom),
    write(center, height - 6, xLabel, { class: "label", "text-anchor": "middle" }));
  return { svg, atX, atY, bottom, right };
}

/* ---- histograms ---- */

const SUPER = {
  "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹",
};
const power = (base, n) => base + [...String(n)].map((digit) => SUPER[digit]).join("");
const total = (h) => Math.max(1, sum(h.count) + h.below + h.above + h.notFinite);
const edge = (h, i) => h.low + i * h.step;
const edges = (h, [first, last]) => [edge(h, first), edge(h, last)];

/* The bins [first, last) that are worth drawing: with a value in any histogram, and one more. */
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

/* Ticks at whole exponents. */
function exponents([low, high], step, label) {
  const ticks = [];
  for (let e = Math.ceil(low); e <= high; e += step) ticks.push([e, label(e)]);
  return ticks;
}

function bars(chart, h, [first, last], className) {
  for (let i = first; i < last; i++) {
    if (h.count[i] === 0) continue;
    const x = chart.atX(edge(h, i)), next = chart.atX(edge(h, i + 1));
    const y = chart.atY(h.count[i] / total(h));
    const height = Math.max(chart.bottom - y, 1), width = Math.max(next - x - 1, 0.5);
    chart.svg.append(draw("rect", { class: className, x: x + 0.5, y, height, width }));
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

/* The top of the scale: the largest share of a bin, and room above it. */
function highest(...list) {
  const shares = list.flatMap((h) => h.count.map((n) => n / total(h)));
  return Math.max(1e-9, ...shares) * 1.08;
}

function figure(svg, title, ...notes) {
  const caption = make("figcaption", {}, ...notes);
  return make("figure", { className: "chart" }, make("h3", {}, title), svg, caption);
}

const nothing = (title, text, note) => figure(make("p", { className: "nothing" }, text), title, note);

const keysOf = (...keys) => make("span", { className: "keys" },
  ...keys.map(([name, what]) => make("span", { className: "key key-" + name }, what)));

function luminanceChart(entry) {
  const a = reference.luminance, b = entry.luminance, span = range(a, [b]), x = edges(a, span);
  const step = Math.max(1, Math.round((span[1] - span[0]) / 16));
  const chart = frame({
    ...SIZE, x, y: [0, highest(a, b)], xTicks: exponents(x, step, (e) => power("2", e)),
    xLabel: "luminance, W/(m² sr)", about: "Histogram of luminance of reference and candidate",
  });
  steps(chart, a, span, "area-reference");
  steps(chart, b, span, "line-candidate");
  const dark = (h) => h.below > 0 ? percent(h.below / total(h), 2) : "none";
  return figure(chart.svg, "Luminance",
    keysOf(["reference", "reference"], ["candidate", "candidate"]),
    `Black: ${dark(a)} of the reference, ${dark(b)} of the candidate.`);
}

function quantile(h, share) {
  let left = share * total(h) - h.below;
  for (let i = 0; i < h.count.length; i++) {
    if (left <= h.count[i]) return edge(h, i) + h.step * Math.max(0, left) / (h.count[i] || 1);
    left -= h.count[i];
  }
  return edge(h, h.count.length);
}

const allEqual = (h) => h.equal === 3 * PIXELS;

function sayEqual(h) {
  const share = h.equal / (3 * PIXELS);
  return h.equal > 0 ? `${percent(share, 2)} of all values are equal and not counted. ` : "";
}

/* A tick of relative errors: as a percentage where that is short. */
const errorTick = (e) => e >= -3 && e <= 2 ? `${+(10 ** (e + 2)).toPrecision(1)} %` : power("10", e);

function relativeChart(entry) {
  const h = entry.relativeHistogram;
  if (allEqual(h)) return nothing("Relative error", "No value differs.", "");
  const span = range(h), x = edges(h, span);
  const chart = frame({
    ...SIZE, x, y: [0, highest(h)], xTicks: exponents(x, 1, errorTick),
    xLabel: "relative error of a channel", about: "Histogram of relative errors",
  });
  bars(chart, h, span, "bar");
  if (total(h) > 1 && h.below < total(h) / 2) {
    const median = quantile(h, 0.5), at = chart.atX(clamp(median, ...x));
    chart.svg.append(line("mark", at, 12, at, chart.bottom),
      write(at + 5, 22, `median ${percent(10 ** median, 2)}`, { class: "tick" }));
  }
  const most = `95 % of them are within ${percent(10 ** quantile(h, 0.95), 2)}. `;
  const strange = h.notFinite > 0 ? `${count(h.notFinite)} are not finite.` : "";
  return figure(chart.svg, "Relative error", most + sayEqual(h) + strange);
}

const NOISE_OF = ["", "of the reference alone", "of the candidate alone", "of both images"];

function zChart(entry) {
  const h = entry.zHistogram;
  if (!h) {
    return nothing("z-score", "Neither image says how noisy it is (no Variance channels, or of one sample a pixel).",
      "Where one does, this compares the difference with the noise.");
  }
  if (allEqual(h)) return nothing("z-score", "No value differs.", "");
  const span = [0, h.count.length];
  const normal = (z) => h.step * Math.exp(-z * z / 2) / Math.sqrt(2 * Math.PI);
  const chart = frame({
    ...SIZE, x: edges(h, span), y: [0, Math.max(highest(h), 1.08 * normal(0))],
    xTicks: [-6, -4, -2, 0, 2, 4, 6].map((z) => [z, format(z)]),
    xLabel: "difference in standard errors, σ", about: "Histogram of z-scores and the normal curve",
  });
  bars(chart, h, span, "bar");
  let path = "";
  for (let z = -6; z <= 6; z += 0.1) {
    path += `${path ? "L" : "M"}${chart.atX(z).toFixed(1)} ${chart.atY(normal(z)).toFixed(1)}`;
  }
  chart.svg.append(draw("path", { class: "mark", d: path }));

  const beyond6 = h.below + h.above;
  const beyond3 = beyond6 + sum(h.count.filter((_, i) => edge(h, i) < -3 || edge(h, i + 1) > 3));
  return figure(chart.svg, "z-score", keysOf(["mark", "noise alone"]),
    `With the noise ${NOISE_OF[entry.noise]}. `
    + `Beyond 3 σ: ${percent(beyond3 / total(h), 2)}; noise alone: 0.27 %. `
    + sayEqual(h)
    + (beyond6 > 0 ? `${count(beyond6)} values are beyond 6 σ and not drawn.` : ""));
}

/* ---- error against what it cost ---- */

const COSTS = {
  samples: { label: "samples a pixel", of: (entry) => entry.samples || null },
  seconds: { label: "seconds to render", of: (entry) => entry.cost?.seconds },
  records: { label: "records", of: (entry) => entry.cost?.records || entry.records?.count || null },
};
const errorOf = (entry) => overall(entry, "relativeRmse");

function pointsBy(cost) {
  const points = candidates.map((entry) => ({ entry, x: COSTS[cost].of(entry), y: errorOf(entry) }));
  return points.filter((p) => p.x > 0 && p.y > 0);
}

/* Where ticks of a logarithmic axis stand: at powers of ten, on a short axis at 2 and 5 of them, too. */
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

/* The curve's name at its last point, moved up until it is clear of the `labels` already there. */
function nameCurve(chart, labels, [x, y], name, hue) {
  const toLeft = x > chart.right - 130;
  const isTaken = (at) => labels.some((l) => Math.abs(l.x - x) < 150 && Math.abs(l.y - at) < 15);
  let at = y - 9;
  while (isTaken(at)) at -= 4;
  labels.push({ x, y: at });
  chart.svg.append(write(x + (toLeft ? -9 : 9), at, name,
    { class: "curve-name", style: `fill: ${hue}`, "text-anchor": toLeft ? "end" : "start" }));
}

function convergenceChart(cost) {
  const { label } = COSTS[cost], points = pointsBy(cost);
  const axis = (key, pad) => {
    const logs = points.map((p) => Math.log10(p[key]));
    return [Math.min(...logs) - pad, Math.max(...logs) + pad];
  };
  const x = axis("x", 0.18), y = axis("y", 0.2);
  const chart = frame({
    width: Math.max($("curves").clientWidth, 300), height: 380, left: 58, x, y,
    xTicks: decades(x).map((v) => [v, format(10 ** v, 2)]),
    yTicks: decades(y).map((v) => [v, percent(10 ** v, 2)]),
    xLabel: label, about: `Relative RMSE against ${label}`,
  });
  const curveOf = (p) => p.entry.method ?? p.entry.name;
  const labels = [];
  [...new Set(points.map(curveOf))].forEach((name, n) => {
    const hue = HUES[n % HUES.length];
    const curve = points.filter((p) => curveOf(p) === name).sort((p, q) => p.x - q.x);
    const at = curve.map((p) => [chart.atX(Math.log10(p.x)), chart.atY(Math.log10(p.y))]);
    if (at.length > 1) {
      const style = `stroke: ${hue}`;
      chart.svg.append(draw("polyline", { class: "curve", points: at.join(" "), style }));
    }
    curve.forEach((p, i) => {
      const [cx, cy] = at[i], says = `${p.entry.name}: ${format(p.x)} ${label}, ${percent(p.y)}`;
      chart.svg.append(draw("circle", { cx, cy, r: 4.5, style: `fill: ${hue}` }, draw("title", {}, says)));
    });
    nameCurve(chart, labels, at[at.length - 1], name, hue);
  });
  return chart.svg;
}
