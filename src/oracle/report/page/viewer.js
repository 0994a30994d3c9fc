/* viewer.js - the controls about the stage: which picture, which view, exposure, scale, values. */

function format(x, digits = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : "−∞";
  const size = Math.abs(x), isPlain = size === 0 || (size >= 1e-3 && size < 1e5);
  const text = isPlain ? String(+x.toPrecision(digits)) : x.toExponential(Math.max(digits - 2, 1));
  return text.replace("e+", "e").replace(/-/g, "−");
}

const percent = (x, digits = 3) => Number.isFinite(x) ? `${format(100 * x, digits)} %` : format(x);
const count = (x) => Math.round(x).toLocaleString("en").replace(/,/g, " ");

const PICTURES = ["reference", "candidate", "difference", "relative", "z", "flip"];
const COLOURS = { reference: "Reference", candidate: "Candidate" };
const available = (name) => name in COLOURS || name in shown().maps;
const labelOf = (name) => COLOURS[name] ?? MAPS[name].label;

/* Over R, G and B: the mean of means, and the root mean square of root mean squares. */
const mean = ({ channels }, key) => sum(channels.map((c) => c[key])) / channels.length;
const overall = ({ channels }, key) => Math.sqrt(sum(channels.map((c) => c[key] ** 2)) / channels.length);
const isNoiseKnown = ({ channels }) => !channels.some((c) => c.zRms === null);

/* The number that says most about a picture. */
function numberOf(name, entry) {
  switch (name) {
    case "difference": return `mean ${format(mean(entry, "bias"), 3)}`;
    case "relative": return `rms ${percent(overall(entry, "relativeRmse"))}`;
    case "z":
      return isNoiseKnown(entry) ? `rms ${format(overall(entry, "zRms"), 3)} σ` : "noise known in part";
    case "flip": return `mean ${format(entry.flip?.mean, 3)}`;
    default: return (name === "reference" ? reference : entry).method ?? "";
  }
}

/* A number of a map, in what the map is measured in. */
function inUnits(map, x, digits = 3) {
  if (map.percent) return percent(x, digits);
  return format(x, digits) + (map.unit ? " " + map.unit : "");
}

/* A scale that shows what is there: the floor of a packed map is what all but a few are below. */
function startScales() {
  MAPS.difference.scale = shown().maps.difference.floor;
}

/* What paper must say, where no control tells it. */
function sayOnPaper() {
  const scales = Object.keys(shown().maps).map((name) => {
    const map = MAPS[name];
    return `${map.label} ${map.signed ? "±" : "0 to "}${inUnits(map, fullScale(name))}`;
  });
  $("paper").textContent = `Candidate: ${shown().name}. `
    + `Exposure ${$("exposure-value").textContent}. Full scales: ${scales.join(", ")}.`;
}

/* ---- thumbnails ---- */

let drawing = 0;
async function drawThumbnails() {
  sayOnPaper();
  const turn = ++drawing, whole = make("canvas", { width: WIDTH, height: HEIGHT });
  const data = whole.getContext("2d").createImageData(WIDTH, HEIGHT);
  for (const thumb of document.querySelectorAll("#pictures canvas")) {
    await paint(thumb.dataset.picture, new Uint32Array(data.data.buffer));
    if (turn !== drawing) return;
    whole.getContext("2d").putImageData(data, 0, 0);
    const context = thumb.getContext("2d");
    context.imageSmoothingQuality = "high";
    context.drawImage(whole, 0, 0, thumb.width, thumb.height);
  }
  document.body.dataset.thumbnails = turn;
}

function buildThumbnails() {
  const width = Math.min(480, WIDTH), height = Math.max(1, Math.round(width * HEIGHT / WIDTH));
  $("pictures").replaceChildren(...PICTURES.filter(available).map((name, index) =>
    make("label", { className: "thumb" },
      make("input", { type: "radio", name: "picture", value: name, checked: name === state.picture }),
      make("canvas", { width, height, "data-picture": name, "aria-hidden": "true" }),
      make("span", { className: "thumb-name" }, labelOf(name), make("kbd", {}, String(index + 1))),
      make("span", { className: "thumb-number" }, numberOf(name, shown())))));
  drawThumbnails();
}

/* ---- what stands beside the stage ---- */

function drawLegend() {
  const map = MAPS[state.picture], legend = $("legend");
  legend.hidden = !map;
  $("scale-row").hidden = !map || state.picture === "flip";
  if (!map) return;
  const canvas = $("legend-bar"), context = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; x++) {
    const t = x / (canvas.width - 1);
    context.fillStyle = `rgb(${colourOf(map, map.signed ? 2 * t - 1 : t).join(" ")})`;
    context.fillRect(x, 0, 1, canvas.height);
  }
  const full = fullScale(state.picture), ticks = map.signed ? [-full, 0, full] : [0, full / 2, full];
  $("legend-ticks").replaceChildren(...ticks.map((x) => make("span", {}, inUnits(map, x))));
  $("legend-about").textContent = map.about;
  $("scale-value").textContent = (map.signed ? "±" : "") + inUnits(map, full);
  $("scale").value = Math.log2(full / map.scale);
}

/* A value of a map; what was rounded to 0 is said to be less than what would not have been. */
function sayValue(map, picture, code) {
  if (code === 0) return "< " + inUnits(map, valueOf(picture, 1) / 2, 2);
  return inUnits(map, valueOf(picture, code), 2);
}

/* As many digits as the rounding leaves. */
function digitsOf(picture) {
  const rounding = roundingOf(picture);
  return rounding < 0.002 ? 4 : rounding < 0.02 ? 3 : 2;
}

async function coloursAt(picture, at) {
  const planes = await planesOf(picture), digits = digitsOf(picture);
  return planes.map((plane) => format(valueOf(picture, plane[at]), digits));
}

async function mapValuesAt(maps, at) {
  const values = [];
  for (const [name, picture] of Object.entries(maps)) {
    const [plane] = await planesOf(picture);
    values.push([MAPS[name].label, sayValue(MAPS[name], picture, plane[at])]);
  }
  return values;
}

async function inspect(pixel) {
  state.pixel = pixel;
  drawOverlay();
  const table = $("values");
  if (!pixel) {
    $("pixel").textContent = "Point at a pixel, or go there with the arrow keys.";
    table.hidden = true;
    return;
  }
  const at = pixel.y * WIDTH + pixel.x, entry = shown();
  const before = await coloursAt(reference.colour, at), after = await coloursAt(entry.colour, at);
  const maps = await mapValuesAt(entry.maps, at);
  if (state.pixel !== pixel) return;
  $("pixel").textContent = `Pixel (${pixel.x}, ${pixel.y})`;
  table.hidden = false;
  const row = (name, ...cells) => make("tr", {}, make("th", { scope: "row" }, name), ...cells);
  table.tBodies[0].replaceChildren(
    row("Reference", ...before.map((text) => make("td", {}, text))),
    row("Candidate", ...after.map((text) => make("td", {}, text))),
    ...maps.map(([name, text]) => row(name, make("td", { colSpan: 3 }, text))));
}

/* ---- changes of state: each makes good what depends on it ---- */

function captionOf(name) {
  return `${labelOf(name)} · ${(name === "reference" ? reference : shown()).name}`;
}

/* Of the radio buttons with this name, the one with this value is on. */
function check(name, value) {
  for (const radio of document.querySelectorAll(`input[name=${name}]`)) {
    radio.checked = radio.value === String(value);
  }
}

function describeStage() {
  $("caption-left").textContent = captionOf("reference");
  $("caption-right").textContent = captionOf(state.picture);
  check("picture", state.picture);
  check("mode", state.mode);
  check("candidate", state.candidate);
  for (const row of document.querySelectorAll("#candidates tbody tr")) {
    row.toggleAttribute("data-shown", +row.dataset.index === state.candidate);
  }
}

function choosePicture(name) {
  if (!available(name)) return;
  state.picture = name;
  describeStage();
  drawLegend();
  repaint();
}

function chooseMode(mode) {
  state.mode = mode;
  state.swapped = false;
  describeStage();
  if (view.fitted) fit();
  else place();
}

function chooseCandidate(index) {
  state.candidate = clamp(index, 0, candidates.length - 1);
  state.marked = null;
  if (!available(state.picture)) state.picture = "candidate";
  startScales();
  buildThumbnails();
  describeStage();
  drawLegend();
  showCandidate();
  inspect(state.pixel);
  place();
  repaint();
}

function setExposure(stops) {
  state.exposure = clamp(Math.round(4 * stops) / 4, -12, 12);
  $("exposure").value = state.exposure;
  const sign = state.exposure > 0 ? "+" : "";
  $("exposure-value").textContent = `${sign}${state.exposure} stops`.replace("-", "−");
  repaint();
  drawThumbnails();
}

function setScale(steps) {
  const map = MAPS[state.picture];
  if (!map || state.picture === "flip") return;
  state.scales[state.picture] = map.scale * 2 ** clamp(Math.round(2 * steps) / 2, -8, 8);
  drawLegend();
  repaint();
  drawThumbnails();
}

function setRecords(on) {
  state.records = on && circlesOf(shown()).length > 0;
  $("records").checked = state.records;
  drawOverlay();
}

/* Shows a place of a finding: { x, y, width, height }, pixels. */
function showPlace(spot) {
  state.marked = { width: 1, height: 1, ...spot };
  if (state.mode === "slider") chooseMode("sides");
  const pane = paneSize(), { x, y, width, height } = state.marked;
  const scale = Math.min(pane.width, pane.height) / (6 * Math.max(width, height));
  lookAt(x + (width - 1) / 2, y + (height - 1) / 2, clamp(scale, 1, 16));
  inspect({ x: clamp(spot.x, 0, WIDTH - 1), y: clamp(spot.y, 0, HEIGHT - 1) });
  $("viewer").scrollIntoView({ block: "start" });
  $("stage").focus({ preventScroll: true });
}
