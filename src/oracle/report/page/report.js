/* report.js - builds the page, then listens: pointer, keys, sizes. */

function showCandidate() {
  buildVerdict();
  buildChannels();
  buildStages();
  buildParameters();
  $("histograms").replaceChildren(luminanceChart(shown()), relativeChart(shown()), zChart(shown()));
  const circles = circlesOf(shown()), { records } = shown();
  $("records-row").hidden = circles.length === 0;
  $("records-count").textContent = records ? `${count(circles.length / 4)} of ${count(records.count)}` : "";
  const reached = reachOf(shown());
  $("records-about").textContent = reached < 1
    ? `Circles: a R with a = ${format(reached)}, as far as a record reaches.`
    : "Circles: R of a record.";
  setRecords(state.records);
}

/* Those that differ between candidates. */
function costsOfUse() {
  return Object.keys(COSTS).filter((cost) => new Set(pointsBy(cost).map((p) => p.x)).size > 1);
}

function buildConvergence() {
  const costs = costsOfUse();
  $("convergence").hidden = costs.length === 0;
  window.addEventListener("resize", () => {
    if (!matchMedia("print").matches) drawConvergence();
  });
  if (costs.length === 0) return;
  const chosen = costs.includes("seconds") ? "seconds" : costs[0];
  $("costs").append(...costs.map((cost) => make("label", {},
    make("input", {
      type: "radio", name: "cost", value: cost, checked: cost === chosen, onchange: drawConvergence,
    }),
    make("span", {}, COSTS[cost].label))));
  drawConvergence();
}

function drawConvergence() {
  const cost = document.querySelector("input[name=cost]:checked");
  if (cost) $("curves").replaceChildren(convergenceChart(cost.value));
}

function sayHonestly() {
  const entry = shown(), off = Math.max(roundingOf(reference.colour), roundingOf(entry.colour));
  const maps = Math.max(...Object.values(entry.maps).map(roundingOf));
  $("honesty").textContent = [
    "All numbers, histograms and maps were computed from the images at full precision.",
    "Only for showing, the pictures are kept rounded:",
    `colours to ${percent(off, 1)} of their value, maps to ${percent(maps, 1)},`,
    "finer than a screen can show; values under the pointer are the rounded ones.",
    "Pictures are sRGB with one exposure for all of them, clipped at 1;",
    "negative values are black, what is not a number is green.",
    `Written by assay ${page.tool}; this file asks the network for nothing.`,
  ].join(" ");
}

function describePage() {
  $("title").textContent = page.title;
  const names = candidates.length === 1 ? candidates[0].name : `${candidates.length} candidates`;
  const samples = reference.samples ? `${format(reference.samples)} ${reference.samples === 1 ? "sample" : "samples"} a pixel` : null;
  const truth = [reference.method, samples].filter(Boolean).join(", ");
  const how = truth ? ` (${truth})` : "", size = `${WIDTH} × ${HEIGHT} pixels`;
  $("subtitle").textContent = `${names} against ${reference.name}${how} · ${size}`;
}

/* ---- theme ---- */

const THEMES = ["auto", "light", "dark"];
const following = (list, one) => list[(list.indexOf(one) + 1) % list.length];

function nextTheme() {
  const root = document.documentElement;
  const next = following(THEMES, root.dataset.theme ?? "auto");
  root.dataset.theme = next;
  $("theme-name").textContent = next;
  drawOverlay();
}

/* ---- pointer ---- */

function pixelAt(event) {
  const { width, height, tall } = paneSize(), box = $("stage").getBoundingClientRect();
  let x = event.clientX - box.left, y = event.clientY - box.top;
  if (state.mode === "sides") {
    if (tall) y %= height;
    else x %= width;
  }
  const px = Math.floor((x - view.x) / view.scale), py = Math.floor((y - view.y) / view.scale);
  const isInside = px >= 0 && py >= 0 && px < WIDTH && py < HEIGHT;
  return { x, y, pixel: isInside ? { x: px, y: py } : null };
}

function listenToPointer() {
  const stage = $("stage"), divider = $("divider");
  let drag = null;
  const dragDivider = (event) => {
    const box = stage.getBoundingClientRect(), [from, to] = dividerRange();
    moveDivider((event.clientX - box.left - from) / Math.max(to - from, 1));
  };
  stage.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    const onDivider = divider.contains(event.target);
    const byTouch = state.mode === "slider" && view.fitted && event.pointerType !== "mouse";
    drag = { divider: onDivider || byTouch, x: event.clientX, y: event.clientY };
    stage.setPointerCapture(event.pointerId);
    if (onDivider) divider.focus();
    stage.classList.add("dragging");
  });
  stage.addEventListener("pointermove", (event) => {
    if (drag?.divider) dragDivider(event);
    else if (drag) {
      pan(event.clientX - drag.x, event.clientY - drag.y);
      drag = { ...drag, x: event.clientX, y: event.clientY };
    } else if (event.pointerType === "mouse") inspect(pixelAt(event).pixel ?? state.pixel);
  });
  const stop = () => {
    drag = null;
    stage.classList.remove("dragging");
  };
  stage.addEventListener("pointerup", (event) => {
    if (drag && !drag.divider && event.pointerType !== "mouse") inspect(pixelAt(event).pixel ?? state.pixel);
    stop();
  });
  stage.addEventListener("pointercancel", stop);
  stage.addEventListener("dblclick", (event) => {
    const { x, y } = pixelAt(event);
    if (view.fitted) zoomAt(4, x, y);
    else fit();
  });
  stage.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && !event.metaKey && view.fitted && document.activeElement !== stage) return;
    event.preventDefault();
    const { x, y } = pixelAt(event);
    zoomAt(2 ** (-event.deltaY / 240), x, y);
  }, { passive: false });
}

/* ---- keys ---- */

/* About what the keys zoom: the pixel that is inspected, before that the middle. */
function middle() {
  const { width, height } = paneSize(), { pixel } = state;
  if (!pixel || view.fitted) return [width / 2, height / 2];
  return [view.x + view.scale * (pixel.x + 0.5), view.y + view.scale * (pixel.y + 0.5)];
}

const KEYS = [
  ["1 – 6", "picture at the right: reference, candidate, then the maps"],
  ["← →", "move the divider (Shift: a little)"],
  ["v", "next view: slider, side by side, single"],
  ["Space", "show the other picture, in the single view"],
  ["+ − 0", "larger, smaller, fit; also Ctrl and the wheel, or a double click"],
  ["[ ]", "exposure, half a stop down or up"],
  [", .", "full scale of a map, smaller or larger"],
  ["n p", "next, previous candidate"],
  ["r", "records"],
  ["t", "theme: auto, light, dark"],
  ["← ↑ ↓ →", "on the picture (Tab goes there): from pixel to pixel"],
  ["?", "this list"],
];

const MODES = ["slider", "sides", "single"];
const ACTIONS = {
  v: () => chooseMode(following(MODES, state.mode)),
  " ": () => {
    if (state.mode !== "single") chooseMode("single");
    else {
      state.swapped = !state.swapped;
      place();
    }
  },
  "+": () => zoomAt(Math.SQRT2, ...middle()),
  "=": () => zoomAt(Math.SQRT2, ...middle()),
  "-": () => zoomAt(Math.SQRT1_2, ...middle()),
  0: fit,
  "[": () => setExposure(state.exposure - 0.5),
  "]": () => setExposure(state.exposure + 0.5),
  ",": () => setScale(+$("scale").value - 0.5),
  ".": () => setScale(+$("scale").value + 0.5),
  n: () => chooseCandidate(state.candidate + 1),
  p: () => chooseCandidate(state.candidate - 1),
  r: () => setRecords(!state.records),
  t: nextTheme,
  "?": () => $("help").showModal(),
};

function onDividerKey(event) {
  const at = state.divider, step = event.shiftKey ? 0.01 : 0.05;
  const to = {
    ArrowLeft: at - step, ArrowDown: at - step, PageDown: at - 0.2, Home: 0,
    ArrowRight: at + step, ArrowUp: at + step, PageUp: at + 0.2, End: 1,
  }[event.key];
  if (to === undefined) return false;
  moveDivider(to);
  return true;
}

function onStageKey(event) {
  const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (!by) return false;
  const from = state.pixel ?? { x: WIDTH >> 1, y: HEIGHT >> 1 }, step = event.shiftKey ? 10 : 1;
  const x = from.x + step * by[0], y = from.y + step * by[1];
  inspect({ x: clamp(x, 0, WIDTH - 1), y: clamp(y, 0, HEIGHT - 1) });
  return true;
}

/* A key of the whole page: a picture by its number, or an action. */
function onPageKey({ key, target }) {
  const moves = key.startsWith("Arrow") || ["Home", "End", "PageUp", "PageDown"].includes(key);
  const presses = key === " " && target.matches("button, a, input, [type=checkbox]");
  if (moves || presses) return false;
  const names = PICTURES.filter(available);
  if (key >= "1" && key <= String(names.length)) choosePicture(names[key - 1]);
  else if (key in ACTIONS) ACTIONS[key]();
  else return false;
  return true;
}

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || $("help").open) return;
  const { key, target } = event;
  const sideways = key === "ArrowLeft" || key === "ArrowRight";
  const onDivider = target === $("divider") || (target === document.body && sideways);
  const done = (target === $("stage") && onStageKey(event)) || (onDivider && onDividerKey(event));
  if (done || onPageKey(event)) event.preventDefault();
}

function listen() {
  listenToPointer();
  document.addEventListener("keydown", onKey);
  document.addEventListener("change", (event) => {
    const { name, value } = event.target;
    if (name === "picture") choosePicture(value);
    if (name === "mode") chooseMode(value);
    if (name === "candidate") chooseCandidate(+value);
  });
  $("exposure").addEventListener("input", () => setExposure(+$("exposure").value));
  $("exposure-reset").addEventListener("click", () => setExposure(reference.exposure));
  $("scale").addEventListener("input", () => setScale(+$("scale").value));
  $("records").addEventListener("change", () => setRecords($("records").checked));
  $("records-hidden").addEventListener("change", () => {
    state.hidden = $("records-hidden").checked;
    setRecords(true);
  });
  $("only-different").addEventListener("change", buildParameters);
  $("zoom-in").addEventListener("click", ACTIONS["+"]);
  $("zoom-out").addEventListener("click", ACTIONS["-"]);
  $("zoom-fit").addEventListener("click", fit);
  $("theme").addEventListener("click", nextTheme);
  $("help-button").addEventListener("click", ACTIONS["?"]);
  new ResizeObserver(() => view.fitted ? fit() : place()).observe($("stage"));
}

function listKeys() {
  const show = (key) => key === "–" ? " – " : make("kbd", {}, key);
  $("keys").append(...KEYS.flatMap(([keys, what]) =>
    [make("dt", {}, ...keys.split(" ").map(show)), make("dd", {}, what)]));
}

function start() {
  $("stage").style.setProperty("--shape", `${WIDTH} / ${HEIGHT}`);
  listKeys();
  describePage();
  buildCandidates();
  buildConvergence();
  listen();
  state.exposure = reference.exposure;
  chooseCandidate(0);
  setExposure(state.exposure);
  inspect(null);
  sayHonestly();
  fit();
}

start();
