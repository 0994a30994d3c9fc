/* report_selftest.js - put behind the scripts of a report's page by tests/cli/test_report.sh: works
 * the controls as a person would and says on the console what does not follow. */
(async () => {
  const wrong = [];
  const check = (good, what) => { if (!good) wrong.push(what); };
  const $ = (id) => document.getElementById(id);
  const all = (selector) => [...document.querySelectorAll(selector)];
  const wait = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
  const press = (key, target = document.body, more = {}) =>
    target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...more }));

  /* Until nothing is painted any more; two frames more for what only moves. */
  async function settled() {
    for (let quiet = 0, last = ""; quiet < 3;) {
      await wait(15);
      const { painted, thumbnails } = document.body.dataset;
      const now = `${painted} ${thumbnails} ${$("pixel").textContent}`;
      quiet = now === last ? quiet + 1 : 0;
      last = now;
    }
  }
  const reader = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  function pixels(canvas) {
    reader.canvas.width = canvas.width;
    reader.canvas.height = canvas.height;
    reader.drawImage(canvas, 0, 0);
    return reader.getImageData(0, 0, canvas.width, canvas.height).data;
  }
  const sum = (canvas) => pixels(canvas).reduce((total, value) => total + value, 0);
  const mix = (hash, value) => Math.imul(hash ^ value, 16777619) >>> 0;
  const print = (canvas) => pixels(canvas).reduce(mix, 2166136261);
  const isName = (text) => typeof text === "string" && text.trim() !== "";
  const number = (text) => parseFloat(text.replace("−", "-").replace("e−", "e-"));

  async function started() {
    const { dataset } = document.body;
    for (let i = 0; i < 400 && !(dataset.painted && dataset.thumbnails); i++) await wait(25);
    check(dataset.painted, "the pictures are painted");
  }

  function texts() {
    const title = $("title").textContent;
    check(isName(title) && document.title === `${title} - assay report`, "the title is the title");
    check(!/\b1 samples/.test($("subtitle").textContent), "one sample is no samples");
    const intruders = "h1 *, #subtitle *, .thumb-name > :not(kbd), td script, td img, th img";
    check(all(intruders).length === 0, "no text became an element");
    const isMissing = (node) => node.nodeType === 3 && /\b(null|undefined|NaN|\[object)/.test(node.data);
    const writesMissing = (element) => [...element.childNodes].some(isMissing);
    check(!all("main *, header *").some(writesMissing), "nothing that is missing is written out");
    check(globalThis.hacked === undefined, "no text was run");
    const ids = all("[id]").map((element) => element.id);
    check(new Set(ids).size === ids.length, "every id is there once");
    const root = document.documentElement;
    check(root.scrollWidth <= root.clientWidth, "the page is no wider than its window");
    check(performance.getEntriesByType("resource").length === 0, "nothing was asked for");
  }

  function names() {
    for (const element of all("button, input, select, [role=slider]")) {
      const labels = [...(element.labels ?? [])].map((label) => label.textContent).join("");
      const name = element.getAttribute("aria-label") || element.textContent || labels;
      check(isName(name), `${element.tagName} #${element.id} has a name`);
    }
    for (const svg of all("#histograms svg, #curves svg")) {
      check(isName(svg.getAttribute("aria-label")), "a chart has a name");
    }
    for (const id of ["stage", "divider"]) check($(id).tabIndex === 0, `${id} can be reached by keyboard`);
    const isInOrder = (element) => element.tabIndex <= 0;
    check(all("[tabindex]").every(isInOrder), "the order of Tab is that of the page");
  }

  async function divider() {
    const stage = $("stage"), handle = $("divider");
    const now = () => +handle.getAttribute("aria-valuenow");
    const clip = () => getComputedStyle($("pane-right")).clipPath;
    const left = () => handle.getBoundingClientRect().left;
    const before = now(), clipped = clip(), stood = left();
    press("ArrowRight", handle);
    check(now() > before, "the arrow moves the divider");
    check(clip() !== clipped, "the picture is cut at the divider");
    check(left() > stood, "the handle goes with it");
    press("Home", handle);
    check(now() === 0, "Home takes it to the left");
    press("End", handle);
    check(now() === 100, "End takes it to the right");
    const box = stage.getBoundingClientRect();
    const point = (target, type, x) => target.dispatchEvent(new PointerEvent(type, {
      clientX: box.left + x * box.width, clientY: box.top + 50,
      button: 0, pointerId: 1, pointerType: "mouse", bubbles: true,
    }));
    stage.setPointerCapture = () => {};
    point(handle, "pointerdown", 0.9);
    point(stage, "pointermove", 0.5);
    point(stage, "pointerup", 0.5);
    check(Math.abs(now() - 50) < 3, "the pointer drags it");
  }

  async function pictures() {
    const right = $("canvas-right"), seen = new Set(), radios = all("input[name=picture]");
    for (const radio of radios) {
      radio.click();
      await settled();
      seen.add(print(right));
      const isColour = ["reference", "candidate"].includes(radio.value);
      check($("legend").hidden === isColour, `${radio.value}: a map has a scale`);
    }
    check(seen.size === radios.length, "every picture looks different");
    press("2");
    await settled();
    check(all("input[name=picture]")[1].checked, "the key 2 shows the candidate");
    const plain = print(right);
    press("4");
    await settled();
    const map = print(right);
    check(map !== plain, "the key 4 shows a map");
    press(".");
    await settled();
    check(print(right) !== map, "the scale changes the map");
    press(",");
    press("2");
    await settled();
    check(print(right) === plain, "and back");
  }

  async function exposure() {
    const left = $("canvas-left"), small = all("#pictures canvas")[0];
    const before = print(left), light = sum(left), thumb = print(small);
    press("[");
    press("[");
    await settled();
    check(sum(left) < light, "less exposure is darker");
    check(print(small) !== thumb, "in the small pictures, too");
    $("exposure-reset").click();
    await settled();
    check(print(left) === before, "and back");
  }

  async function views() {
    const mode = () => $("stage").dataset.mode, seen = [mode()];
    for (let i = 0; i < 2; i++) {
      press("v");
      seen.push(mode());
    }
    check(seen.join() === "slider,sides,single", "v goes through the views");
    const hidden = () => getComputedStyle($("pane-right")).visibility === "hidden";
    const first = hidden();
    press(" ");
    check(hidden() !== first, "Space shows the other picture");
    press("v");
    const before = $("canvas-left").style.transform;
    press("+");
    check($("canvas-left").style.transform !== before, "+ zooms");
    press("0");
    check($("canvas-left").style.transform === before, "0 fits again");
  }

  /* What the page decodes against what was computed of the images themselves. */
  async function values() {
    for (const row of all("#channel-table tbody tr")) {
      const name = row.cells[0].textContent.trim(), channel = "RGB".indexOf(name);
      const most = number(row.cells[7].textContent), place = row.cells[8];
      if (!(most > 0)) continue;
      place.querySelector("button").click();
      await settled();
      check($("pixel").textContent === `Pixel ${place.textContent}`, "the place is inspected");
      const colours = [...$("values").tBodies[0].rows].slice(0, 2);
      const [a, b] = colours.map((colour) => number(colour.cells[channel + 1].textContent));
      const off = 0.004 * (Math.abs(a) + Math.abs(b)) + 0.006 * most;
      check(Math.abs(Math.abs(b - a) - most) <= off, `${name}: ${a} and ${b} differ by ${most}`);
    }
    $("stage").focus();
    const before = $("pixel").textContent;
    press("ArrowUp", $("stage"));
    press("ArrowLeft", $("stage"));
    await settled();
    check($("pixel").textContent !== before, "arrows go from pixel to pixel");
    press("0");
    all("input[name=mode]")[0].click();
  }

  function charts() {
    for (const svg of all("#histograms figure:not(:has(.nothing)) svg")) {
      check(svg.querySelectorAll("rect, path").length > 1, "a histogram is drawn");
    }
    check(all("#histograms figure").length === 3, "three histograms");
    if ($("convergence").hidden) return;
    const before = $("curves").innerHTML;
    check(all("#curves circle").length >= 2, "errors are drawn against cost");
    const others = all("input[name=cost]:not(:checked)");
    if (others.length === 0) return;
    others[0].click();
    check($("curves").innerHTML !== before, "against another cost they are elsewhere");
  }

  async function theme() {
    const paper = () => getComputedStyle(document.body).backgroundColor;
    press("t");
    const light = paper();
    press("t");
    check(light !== paper(), "light and dark differ");
    press("t");
  }

  async function records() {
    if ($("records-row").hidden) return;
    const before = print($("overlay"));
    press("r");
    check($("records").checked && print($("overlay")) !== before, "r draws the records");
    press("r");
    check(print($("overlay")) === before, "r takes them away");
  }

  async function candidates() {
    const rows = all("#candidates tbody tr");
    if (rows.length < 2) return;
    const before = $("caption-right").textContent, histogram = $("histograms").innerHTML;
    press("n");
    await settled();
    check($("caption-right").textContent !== before, "n shows the next candidate");
    check($("histograms").innerHTML !== histogram, "with its histograms");
    check(rows[1].hasAttribute("data-shown"), "and marks its row");
    press("p");
    await settled();
    check($("caption-right").textContent === before, "p goes back");
  }

  function verdict() {
    if ($("verdict").hidden) return;
    const link = document.querySelector("#verdict a");
    const isFirst = (id) => document.querySelector(id)?.hasAttribute("data-first");
    check(!link || isFirst(link.getAttribute("href")), "the link goes to the first failure");
    const verdictOf = JSON.parse(document.querySelector("script.candidate").textContent).verdict;
    const said = all("#verdict .caveat").map((line) => line.textContent).join(" ");
    const { missing, "not judged": unjudged, shared_seed: seed } = verdictOf.settings;
    check(!missing || said.includes(`reference's arrays: ${missing}.`), "what is missing is said");
    check(!unjudged || said.includes(`Not judged: ${unjudged}.`), "what was not judged is said");
    check(!seed || said.includes(`The same seed in both: ${seed}.`), "a shared seed is said");
    check(said.includes("the verdict is of ") === (verdictOf.candidate === "c"),
      "whose verdict it is is said where it is another's");
    const { otherPixels = [] } = JSON.parse(document.querySelector("script.candidate").textContent);
    check((otherPixels.length > 0) === (verdictOf.candidate === "c"), "other pixels are noticed");
    check(otherPixels.every((text) => said.includes(text)), "and said");
    check(all("#findings tbody tr[id]").length > 0, "the stages are listed");
    const heads = all("#findings thead th").length;
    check(all("#findings tbody tr[id]").every((row) => row.cells.length === heads), "rows are whole");
    const first = $("finding-0").textContent;
    check(first.includes("9 of 12"), "how much was judged");
    check(first.includes("0.25"), "and how wide the bounds are");
  }

  function help() {
    press("?");
    check($("help").open, "? opens the list of keys");
    $("help").close();
  }

  function parameters() {
    const rows = () => all("#attributes tbody tr").length, few = rows();
    $("only-different").click();
    check(rows() > few, "all parameters are more than those that differ");
    $("only-different").click();
  }

  const name = decodeURIComponent(location.pathname).replace(/.*\//, "");
  const steps = [texts, names, charts, divider, pictures, exposure, views, values, theme, records, candidates,
    verdict, help, parameters];
  try {
    await started();
    await settled();
    for (const step of steps) await step();
  } catch (error) {
    wrong.push(String(error));
  }
  const outcome = wrong.length ? "fails: " + [...new Set(wrong)].join("; ") : "passes";
  console.log(`SELFTEST ${name} ${outcome}`);
})();
