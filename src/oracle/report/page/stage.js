/* stage.js - the pictures themselves: two canvases, one view of both, a divider between them.
 *
 * All coordinates are CSS pixels of a pane; `view` takes image pixels there. */

const $ = (id) => document.getElementById(id);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const sum = (list) => list.reduce((total, x) => total + x, 0);

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

/* A picture by its name: "reference", "candidate" or that of a map. */
function pictureOf(name) {
  if (name === "reference") return reference.colour;
  return name === "candidate" ? shown().colour : shown().maps[name];
}

/* Paints the picture of that name into an array of pixels. */
async function paint(name, out) {
  const picture = pictureOf(name), planes = await planesOf(picture);
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
function dividerRange() {
  const { width } = paneSize();
  return [clamp(view.x, 0, width), clamp(view.x + view.scale * WIDTH, 0, width)];
}

function placePanes() {
  const { width, height, tall } = paneSize();
  const left = $("pane-left"), right = $("pane-right");
  for (const pane of [left, right]) {
    pane.style.width = width + "px";
    pane.style.height = height + "px";
  }
  const sides = state.mode === "sides", alone = state.mode === "single";
  const x = sides && !tall ? width : 0, y = sides && tall ? height : 0;
  right.style.translate = `${x}px ${y}px`;
  right.style.visibility = alone && state.swapped ? "hidden" : "visible";
  left.style.visibility = alone && !state.swapped ? "hidden" : "visible";
  for (const { canvas } of panes) {
    canvas.style.transform = `translate(${view.x}px, ${view.y}px) scale(${view.scale})`;
    canvas.style.imageRendering = view.scale * devicePixelRatio >= 1.5 ? "pixelated" : "auto";
  }
}

function placeDivider() {
  const [from, to] = dividerRange(), at = from + state.divider * (to - from);
  const on = state.mode === "slider", handle = $("divider");
  $("pane-right").style.clipPath = on ? `inset(0 0 0 ${at}px)` : "none";
  handle.style.transform = `translateX(${at}px)`;
  handle.hidden = !on;
  const percentage = Math.round(100 * state.divider);
  handle.setAttribute("aria-valuenow", percentage);
  handle.setAttribute("aria-valuetext", `${percentage} % of the width shows the reference`);
}

function place() {
  $("stage").dataset.mode = state.mode;
  placePanes();
  placeDivider();
  drawOverlay();
  const { scale } = view;
  $("zoom").textContent = scale >= 1 ? `${+scale.toFixed(2)}×` : `${Math.round(100 * scale)} %`;
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

function circle(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
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
      circle(context, x, y, clamp(0.35 * view.scale, 0.9, 2.2));
      context.fill();
      context.globalAlpha = faint;
      circle(context, x, y, radius);
      context.stroke();
    }
  }
  context.globalAlpha = 1;
}

/* A frame about pixels, where they are small a little larger than they. */
function drawFrame(context, spot, colour) {
  const width = view.scale * spot.width, height = view.scale * spot.height;
  const grow = Math.max(0, (14 - width) / 2);
  const x = view.x + view.scale * spot.x - grow, y = view.y + view.scale * spot.y - grow;
  const box = [x, y, width + 2 * grow, height + 2 * grow];
  context.lineWidth = 3;
  context.strokeStyle = "rgba(0, 0, 0, 0.75)";
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
    const x = tall ? 0 : side * width, y = tall ? side * height : 0;
    context.setTransform(ratio, 0, 0, ratio, ratio * x, ratio * y);
    context.save();
    context.beginPath();
    context.rect(0, 0, width, height);
    context.clip();
    if (state.records) drawRecords(context, circlesOf(shown()), reachOf(shown()));
    if (state.marked) drawFrame(context, state.marked, overlayColours().getPropertyValue("--marker"));
    if (state.pixel && view.scale >= 6) drawFrame(context, { ...state.pixel, width: 1, height: 1 }, "#fff");
    context.restore();
  }
}
