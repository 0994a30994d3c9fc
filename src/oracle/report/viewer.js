/* viewer.js - the controls about the stage: which picture, which view, exposure, scale, values. */

const format = (x, digits = 4) => x === null || x === undefined || Number.isNaN(x) ? "–"
  : !Number.isFinite(x) ? (x > 0 ? "∞" : "−∞")
  : (x !== 0 && (Math.abs(x) < 1e-3 || Math.abs(x) >= 1e5) ? x.toExponential(Math.max(digits - 2, 1)).replace("e+", "e")
    : String(+x.toPrecision(digits))).replace(/-/g, "−");
const percent = (x, digits = 3) => x === null || x === undefined || !Number.isFinite(x) ? format(x)
  : `${format(100 * x, digits)} %`;
const count = (x) => Math.round(x).toLocaleString("en").replace(/,/g, " ");

const PICTURES = ["reference", "candidate", "difference", "relative", "z", "flip"];
const available = (name) => name === "reference" || name === "candidate" || name in shown().maps;
const labelOf = (name) => name === "reference" ? "Reference" : name === "candidate" ? "Candidate" : MAPS[name].label;
const overall = (entry, key) => Math.sqrt(entry.channels.reduce((sum, c) => sum + c[key] ** 2, 0) / entry.channels.length);

/* The number that says most about a picture. */
function numberOf(name, entry) {
  const channels = entry.channels, mean = (key) => channels.reduce((sum, c) => sum + c[key], 0) / channels.length;
  switch (name) {
    case "difference": return `mean ${format(mean("bias"), 3)}`;
    case "relative": return `rms ${percent(overall(entry, "relativeRmse"))}`;
    case "z": return channels.some((c) => c.zRms === null) ? "noise known in part" : `rms ${format(overall(entry, "zRms"), 3)} σ`;
    case "flip": return `mean ${format(entry.flip?.mean, 3)}`;
    default: return (name === "reference" ? reference : entry).method ?? "";
  }
}

/* A scale that shows what is there: the floor of a packed map is what all but a few are below. */
function startScales() {
  MAPS.difference.scale = shown().maps.difference.floor;
}

/* What paper must say, where no control tells it. */
function sayOnPaper() {
  const scales = Object.keys(shown().maps).map((name) => {
    const map = MAPS[name], full = fullScale(name), unit = map.unit ? " " + map.unit : "";
    return `${map.label} ${map.signed ? "±" : "0 to "}${map.percent ? percent(full) : format(full, 3) + unit}`;
  });
  $("paper").textContent = `Candidate: ${shown().name}. Exposure ${$("exposure-value").textContent}. Full scales: ${scales.join(", ")}.`;
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
  const full = fullScale(state.picture), unit = map.unit ? " " + map.unit : "";
  const say = (x) => map.percent ? percent(x) : format(x, 3) + unit;
  $("legend-ticks").replaceChildren(...(map.signed ? [-full, 0, full] : [0, full / 2, full]).map((x) => make("span", {}, say(x))));
  $("legend-about").textContent = map.about;
  $("scale-value").textContent = (map.signed ? "±" : "") + say(full);
  $("scale").value = Math.log2(full / map.scale);
}

/* A value of a map; what was rounded to 0 is said to be less than what would not have been. */
function sayValue(map, picture, code) {
  const value = code === 0 ? valueOf(picture, 1) / 2 : valueOf(picture, code);
  const text = map.percent ? percent(value, 2) : format(value, 2) + (map.unit ? " " + map.unit : "");
  return code === 0 ? "< " + text : text;
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
  const colour = async (picture) => {
    const planes = await planesOf(picture), digits = roundingOf(picture) < 0.002 ? 4 : roundingOf(picture) < 0.02 ? 3 : 2;
    return planes.map((plane) => format(valueOf(picture, plane[at]), digits));
  };
  const rows = [["Reference", ...await colour(reference.colour)], ["Candidate", ...await colour(entry.colour)]];
  const maps = [];
  for (const name of Object.keys(entry.maps)) {
    const picture = entry.maps[name], code = (await planesOf(picture))[0][at];
    maps.push([MAPS[name].label, sayValue(MAPS[name], picture, code)]);
  }
  if (state.pixel !== pixel) return;
  $("pixel").textContent = `Pixel (${pixel.x}, ${pixel.y})`;
  table.hidden = false;
  table.tBodies[0].replaceChildren(...rows.map(([name, ...cells]) =>
    make("tr", {}, make("th", { scope: "row" }, name), ...cells.map((cell) => make("td", {}, cell)))),
    ...maps.map(([name, value]) => make("tr", {}, make("th", { scope: "row" }, name), make("td", { colSpan: 3 }, value))));
}

/* ---- changes of state: each makes good what depends on it ---- */

function describeStage() {
  const name = shown().name;
  $("caption-left").textContent = `Reference · ${reference.name}`;
  $("caption-right").textContent = state.picture === "candidate" ? `Candidate · ${name}`
    : state.picture === "reference" ? `Reference · ${reference.name}` : `${labelOf(state.picture)} · ${name}`;
  for (const radio of document.querySelectorAll("input[name=picture]")) radio.checked = radio.value === state.picture;
  for (const radio of document.querySelectorAll("input[name=mode]")) radio.checked = radio.value === state.mode;
  for (const radio of document.querySelectorAll("input[name=candidate]")) radio.checked = +radio.value === state.candidate;
  for (const row of document.querySelectorAll("#candidates tbody tr")) row.toggleAttribute("data-shown", +row.dataset.index === state.candidate);
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
  $("exposure-value").textContent = `${state.exposure > 0 ? "+" : ""}${state.exposure} stops`.replace("-", "−");
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
  const { width, height } = paneSize();
  const scale = clamp(Math.min(width, height) / (6 * Math.max(state.marked.width, state.marked.height)), 1, 16);
  lookAt(spot.x + (state.marked.width - 1) / 2, spot.y + (state.marked.height - 1) / 2, scale);
  inspect({ x: clamp(spot.x, 0, WIDTH - 1), y: clamp(spot.y, 0, HEIGHT - 1) });
  $("viewer").scrollIntoView({ block: "start" });
  $("stage").focus({ preventScroll: true });
}
