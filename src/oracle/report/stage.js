/* stage.js - the pictures themselves: two canvases, one view of both, a divider between them.
 *
 * All coordinates are CSS pixels of a pane; `view` takes image pixels there. */

const $ = (id) => document.getElementById(id);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(properties)) {
    if (key in element && key !== "list") element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const state = {
  candidate: 0, picture: "candidate", mode: "slider", exposure: 0, scales: {}, divider: 0.5,
  records: false, hidden: false, swapped: false, pixel: null, marked: null,
};
const view = { scale: 1, x: 0, y: 0, fitted: true };

const panes = ["left", "right"].map((name) => {
  const canvas = $("canvas-" + name), context = canvas.getContext("2d");
  canvas.width = WIDTH;
  canvas.height = HEIGHT;
  const data = context.createImageData(WIDTH, HEIGHT);
  return { canvas, context, data, pixels: new Uint32Array(data.data.buffer) };
});

const shown = () => candidates[state.candidate];
const mapOf = (name) => shown().maps[name];
const fullScale = (name) => (state.scales[name] ?? MAPS[name].scale) || 1;

/* Paints a picture into an array of pixels: "reference", "candidate" or the name of a map. */
async function paint(name, out, candidate = shown()) {
  const picture = name === "reference" ? reference.colour : name === "candidate" ? candidate.colour : candidate.maps[name];
  const planes = await planesOf(picture);
  if (name in MAPS) paintMap(picture, planes, MAPS[name], fullScale(name), out);
  else paintColour(picture, planes, state.exposure, out);
}

let painting = 0;
async function repaint() {
  const turn = ++painting;
  for (const [pane, name] of [[panes[0], "reference"], [panes[1], state.picture]]) {
    const wanted = new Uint32Array(PIXELS);
    await paint(name, wanted);
    if (turn !== painting) return;
    pane.pixels.set(wanted);
    pane.context.putImageData(pane.data, 0, 0);
  }
  document.body.dataset.painted = turn;
}

/* Size of what one pane shows: half of the stage where both stand side by side. */
function paneSize() {
  const stage = $("stage"), sides = state.mode === "sides" ? 2 : 1;
  const tall = sides === 2 && stage.clientWidth < 640;
  return { width: stage.clientWidth / (tall ? 1 : sides), height: stage.clientHeight / (tall ? 2 : 1), tall };
}

function fit() {
  const { width, height } = paneSize(), margin = width < 480 ? 0 : 16;
  const scale = Math.min((width - 2 * margin) / WIDTH, (height - 2 * margin) / HEIGHT);
  view.scale = scale;
  view.x = (width - scale * WIDTH) / 2;
  view.y = (height - scale * HEIGHT) / 2;
  view.fitted = true;
  place();
}

function zoomAt(factor, x, y) {
  const { width, height } = paneSize();
  const scale = clamp(view.scale * factor, Math.min(width / WIDTH, height / HEIGHT) / 2, 64);
  const ratio = scale / view.scale;
  view.x = x - (x - view.x) * ratio;
  view.y = y - (y - view.y) * ratio;
  view.scale = scale;
  view.fitted = false;
  place();
}

function pan(dx, dy) {
  const { width, height } = paneSize();
  view.x = clamp(view.x + dx, 48 - view.scale * WIDTH, width - 48);
  view.y = clamp(view.y + dy, 48 - view.scale * HEIGHT, height - 48);
  view.fitted = false;
  place();
}

function lookAt(x, y, scale) {
  const { width, height } = paneSize();
  view.scale = scale;
  view.x = width / 2 - scale * (x + 0.5);
  view.y = height / 2 - scale * (y + 0.5);
  view.fitted = false;
  place();
}

/* The divider runs over what is visible of the image, not over the empty stage beside it. */
function dividerAt() {
  const { width } = paneSize();
  const from = clamp(view.x, 0, width), to = clamp(view.x + view.scale * WIDTH, 0, width);
  return from + state.divider * (to - from);
}

function place() {
  const { width, height, tall } = paneSize(), stage = $("stage");
  stage.dataset.mode = state.mode;
  const left = $("pane-left"), right = $("pane-right");
  const second = state.mode === "sides" ? (tall ? `0 ${height}px` : `${width}px 0`) : "0 0";
  for (const pane of [left, right]) {
    pane.style.width = width + "px";
    pane.style.height = height + "px";
  }
  right.style.translate = second.split(" ").map((part) => part === "0" ? "0px" : part).join(" ");
  for (const pane of panes) {
    pane.canvas.style.transform = `translate(${view.x}px, ${view.y}px) scale(${view.scale})`;
    pane.canvas.style.imageRendering = view.scale * devicePixelRatio >= 1.5 ? "pixelated" : "auto";
  }
  const at = dividerAt(), handle = $("divider");
  const alone = state.mode === "single";
  right.style.clipPath = state.mode === "slider" ? `inset(0 0 0 ${at}px)` : "none";
  right.style.visibility = alone && state.swapped ? "hidden" : "visible";
  left.style.visibility = alone && !state.swapped ? "hidden" : "visible";
  handle.style.transform = `translateX(${at}px)`;
  handle.hidden = state.mode !== "slider";
  handle.setAttribute("aria-valuenow", Math.round(100 * state.divider));
  handle.setAttribute("aria-valuetext", `${Math.round(100 * state.divider)} % of the width shows the reference`);
  drawOverlay();
  $("zoom").textContent = view.scale >= 1 ? `${+view.scale.toFixed(2)}×` : `${Math.round(100 * view.scale)} %`;
}

function moveDivider(share) {
  state.divider = clamp(share, 0, 1);
  place();
}

/* ---- what lies over the pictures: records, the marked place, the pixel that is inspected ---- */

const overlayColours = () => getComputedStyle($("stage"));

const circlesOf = (entry) => entry.records?.circles ?? [];

/* How far a record reaches: a R of [ward88], where the image says what a was. */
function reachOf(entry) {
  const a = entry.attributes.find(([key]) => key === `assay:${entry.method}.a`);
  return a && +a[1] > 0 ? +a[1] : 1;
}

function drawRecords(context, circles, share) {
  const faint = clamp(12 / Math.sqrt(circles.length / 4 + 1), 0.12, 0.6);
  for (const hidden of [1, 0]) {
    if (hidden && !state.hidden) continue;
    const style = overlayColours().getPropertyValue(hidden ? "--record-hidden" : "--record");
    context.strokeStyle = context.fillStyle = style;
    context.lineWidth = 1;
    for (let i = 0; i < circles.length; i += 4) {
      if (circles[i + 3] !== hidden) continue;
      const x = view.x + view.scale * circles[i] / 8, y = view.y + view.scale * circles[i + 1] / 8;
      const radius = share * view.scale * circles[i + 2] / 8;
      context.globalAlpha = 1;
      context.beginPath();
      context.arc(x, y, clamp(0.35 * view.scale, 0.9, 2.2), 0, 2 * Math.PI);
      context.fill();
      context.globalAlpha = faint;
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.stroke();
    }
  }
  context.globalAlpha = 1;
}

function drawFrame(context, x, y, width, height, colour) {
  const size = view.scale, grow = Math.max(0, (14 - size * width) / 2);
  context.lineWidth = 3;
  context.strokeStyle = "rgba(0, 0, 0, 0.75)";
  const box = [view.x + size * x - grow, view.y + size * y - grow, size * width + 2 * grow, size * height + 2 * grow];
  context.strokeRect(...box);
  context.lineWidth = 1.5;
  context.strokeStyle = colour;
  context.strokeRect(...box);
}

function drawOverlay() {
  const { width, height, tall } = paneSize(), canvas = $("overlay"), stage = $("stage");
  const ratio = devicePixelRatio || 1;
  canvas.width = Math.round(stage.clientWidth * ratio);
  canvas.height = Math.round(stage.clientHeight * ratio);
  const context = canvas.getContext("2d"), sides = state.mode === "sides" ? 2 : 1;
  for (let side = 0; side < sides; side++) {
    context.setTransform(ratio, 0, 0, ratio, tall ? 0 : ratio * side * width, tall ? ratio * side * height : 0);
    context.save();
    context.beginPath();
    context.rect(0, 0, width, height);
    context.clip();
    if (state.records) drawRecords(context, circlesOf(shown()), reachOf(shown()));
    const accent = overlayColours().getPropertyValue("--marker");
    if (state.marked) drawFrame(context, state.marked.x, state.marked.y, state.marked.width, state.marked.height, accent);
    if (state.pixel && view.scale >= 6) drawFrame(context, state.pixel.x, state.pixel.y, 1, 1, "#fff");
    context.restore();
  }
}
