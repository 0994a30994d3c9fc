/* tables.js - verdict, candidates, channels, stages, parameters. */

const cell = (content, className = "", tag = "td") =>
  make(tag, className ? { className } : {}, content ?? "–");
const numeric = (content) => cell(content, "number");
const when = (wanted, ...list) => wanted ? list : [];
const KINDS = { pass: ["pass", "✓"], fail: ["fail", "✕"], "cannot tell": ["unsure", "?"] };

/* A row of headings: [text, class]. */
const head = (names) => make("tr", {},
  ...names.map(([name, className = ""]) => make("th", { scope: "col", className }, name)));

function pill(kind) {
  const [className, sign] = KINDS[kind] ?? ["unsure", "?"];
  const icon = make("span", { "aria-hidden": "true" }, sign);
  return make("span", { className: "pill " + className }, icon, " ", String(kind));
}

/* ---- the verdict of the candidate that is shown ---- */

function buildVerdict() {
  const verdict = shown().verdict, section = $("verdict");
  section.hidden = !verdict;
  if (!verdict) return;
  section.className = (KINDS[verdict.verdict] ?? KINDS["cannot tell"])[0];
  const first = verdict.findings[verdict.first];
  section.replaceChildren(...[
    make("h2", { id: "verdict-heading" }, pill(verdict.verdict), " ", shown().name),
    make("p", {}, verdict.summary ?? ""),
    ...[...othersOf(verdict), ...(shown().otherPixels ?? [])].map((text) => make("p", { className: "caveat others" }, text)),
    ...caveatsOf(verdict).map((text) => make("p", { className: "caveat" }, text)),
    first ? linksTo(verdict, first) : null].filter(Boolean));
}

/* What the page calls the image of this path by; several runs go by the first. */
const nameIn = (path) => String(path).replace(/ and \d+ more$/, "").replace(/\/+$/, "")
  .replace(/^.*\//, "").replace(/\.(exr|hdr)$/, "");

/* Whose verdict it is, where it names other files than the page shows. */
function othersOf({ candidate, reference: truth = "its own inputs" }) {
  const isTruth = truth === "its own inputs" || nameIn(truth) === reference.file;
  const isThis = isTruth && nameIn(candidate) === shown().file;
  return isThis ? []
    : [`Here are ${shown().name} and ${reference.name}; the verdict is of ${candidate} against ${truth}.`];
}

/* What the word above does not say. */
function caveatsOf({ settings }) {
  return [
    settings?.shared_seed && `The same seed in both: ${settings.shared_seed}.`,
    settings?.["not judged"] && `Not judged: ${settings["not judged"]}.`,
    settings?.missing && `Missing, of the reference's arrays: ${settings.missing}.`,
  ].filter(Boolean);
}

/* To the first finding that fails, in its table and in the picture. */
function linksTo(verdict, first) {
  const what = verdict.verdict === "fail" ? "First failure" : "First doubt";
  const link = make("a", { href: `#finding-${verdict.first}` }, `${what}: ${first.stage}, ${first.array}`);
  return make("p", { className: "links" }, link, placeButton(first.place));
}

/* The place of a finding, as a button where it is in the image. */
function placeButton(spot) {
  if (!spot) return null;
  if (spot.x === undefined) return `row ${spot.row}, column ${spot.column}`;
  const isTile = spot.width > 1 || spot.height > 1, corner = `(${spot.x}, ${spot.y})`;
  return make("button", {
    type: "button", className: "link", title: "Show this place in the picture",
    onclick: () => showPlace(spot),
  }, isTile ? `tile ${corner} ${spot.width} × ${spot.height}` : corner);
}

const STAGE_COLUMNS = [
  ["Verdict"], ["Stage"], ["Array"], ["Test"], ["Values", "number"], ["Worst at"],
  ["Candidate", "number"], ["Reference", "number"], ["Of what passes", "number"], ["p", "number"],
  ["Bounds, typical", "number"],
];

/* Six digits; where there are more to tell, they are shown under the pointer. */
const exact = (value, hex) => hex ? make("span", { title: hex }, format(value, 6)) : format(value, 6);

/* How many were judged, of how many. */
const judged = (f) => f.unjudged > 0 ? `${count(f.values)} of ${count(f.values + f.unjudged)}` : count(f.values);

/* How wide bounds are, in parts of what they bound; of one in ten under the pointer. */
const width = (f) => Number.isFinite(f.width)
  ? make("span", { title: `one in ten: ${format(f.width_90, 2)}` }, format(f.width, 2)) : "–";

/* A finding's row, and one for what it means; the stage is named where it begins. */
function findingRows(f, i, { findings, first }) {
  const begins = i === 0 || findings[i - 1].stage !== f.stage;
  const row = make("tr", { id: `finding-${i}`, tabIndex: -1 },
    cell(pill(f.verdict)),
    cell(begins ? f.stage : "", "stage", "th"),
    cell(f.channel ? `${f.array}, ${f.channel}` : f.array, "code"),
    cell(f.test),
    numeric(judged(f)),
    cell(placeButton(f.place)),
    numeric(exact(f.candidate, f.candidate_hex)),
    numeric(exact(f.reference, f.reference_hex)),
    numeric(f.in_bounds === null ? "–" : `${format(f.in_bounds, 3)} ×`),
    numeric(format(f.p, 2)),
    numeric(width(f)));
  if (i === first) row.dataset.first = "";
  if (!f.meaning || f.verdict === "pass") return [row];
  const text = make("td", { colSpan: STAGE_COLUMNS.length - 1 }, f.meaning);
  return [row, make("tr", { className: "meaning" }, make("td"), text)];
}

function buildStages() {
  const verdict = shown().verdict, table = $("findings");
  $("stages").hidden = !verdict;
  if (!verdict) return;
  table.tHead.replaceChildren(head(STAGE_COLUMNS));
  table.tBodies[0].replaceChildren(...verdict.findings.flatMap((f, i) => findingRows(f, i, verdict)));
}

/* ---- candidates ---- */

/* By how much the whole image is off: offsets over means, both added up over the channels. */
function offsetOf({ channels }) {
  return sum(channels.map((c) => c.bias)) / sum(channels.map((c) => Math.abs(c.meanReference)));
}

function buildCandidates() {
  const several = candidates.length > 1, table = $("candidates");
  $("overview").hidden = !several;
  $("candidate-tabs").hidden = !several || candidates.length > 5;
  if (!several) return;
  const hasCost = candidates.some((c) => c.cost);
  const hasFlip = candidates.some((c) => c.flip);
  const hasVerdict = candidates.some((c) => c.verdict);
  const worst = Math.max(...candidates.map(errorOf)) || 1;

  table.tHead.replaceChildren(head([
    ["Candidate"], ["Method"], ["Samples", "number"],
    ...when(hasCost, ["Seconds", "number"], ["Records", "number"]),
    ["Relative RMSE", "number"], ["", "bar-head"], ["Mean offset", "number"], ["z rms", "number"],
    ...when(hasFlip, ["FLIP", "number"]),
    ...when(hasVerdict, ["Verdict"]),
  ]));
  table.tBodies[0].replaceChildren(...candidates.map((c, index) => {
    const onclick = () => chooseCandidate(index);
    const width = (100 * errorOf(c) / worst).toFixed(1);
    const row = make("tr", {},
      cell(make("button", { type: "button", className: "link", onclick }, c.name), "", "th"),
      cell(c.method),
      numeric(c.samples ? format(c.samples, 4) : "–"),
      ...when(hasCost,
        numeric(format(c.cost?.seconds, 3)),
        numeric(c.cost?.records ? count(c.cost.records) : "–")),
      numeric(percent(errorOf(c))),
      cell(make("span", { className: "meter", style: `width: ${width}%` }), "bar-cell"),
      numeric(percent(offsetOf(c), 2)),
      numeric(isNoiseKnown(c) ? format(overall(c, "zRms"), 3) : "–"),
      ...when(hasFlip, numeric(format(c.flip?.mean, 3))),
      ...when(hasVerdict, cell(c.verdict ? pill(c.verdict.verdict) : "–")));
    row.dataset.index = index;
    return row;
  }));
  $("candidate-tabs").append(...candidates.map((c, index) => make("label", {},
    make("input", { type: "radio", name: "candidate", value: index, checked: index === 0 }),
    make("span", {}, c.name))));
}

/* ---- channels ---- */

const CHANNEL_COLUMNS = [
  ["Channel"], ["Mean of reference", "number"], ["Mean of candidate", "number"],
  ["Mean offset", "number"], ["RMSE", "number"], ["Relative RMSE", "number"], ["z rms", "number"],
  ["Largest difference", "number"], ["at"], ["Differing", "number"], ["Not finite", "number"],
];

function channelRow(c) {
  return make("tr", {},
    cell(make("span", { className: "channel channel-" + c.channel }, c.channel), "", "th"),
    numeric(format(c.meanReference)),
    numeric(format(c.meanCandidate)),
    numeric(format(c.bias, 3)),
    numeric(format(c.rmse, 3)),
    numeric(percent(c.relativeRmse)),
    numeric(format(c.zRms, 3)),
    numeric(format(c.maxAbs, 3)),
    cell(placeButton({ x: c.maxX, y: c.maxY, width: 1, height: 1 })),
    numeric(percent(c.differing / PIXELS, 3)),
    numeric(count(c.notFinite)));
}

function buildChannels() {
  const rows = shown().channels.map(channelRow);
  $("channel-table").replaceChildren(
    make("thead", {}, head(CHANNEL_COLUMNS)),
    make("tbody", {}, ...rows));
}

/* ---- parameters ---- */

const COST_ROWS = [
  ["render, s", (cost) => format(cost.seconds, 4)],
  ["threads", (cost) => format(cost.threads)],
  ["rays", (cost) => count(cost.rays)],
  ["records", (cost) => cost.records ? count(cost.records) : null],
  ["peak memory, MB", (cost) => format(cost.memory / 1e6, 3)],
];
const GROUPS = ["Image", "Parameters of the method", "Scene", "Camera", "Cost"];

/* Parameters of all methods under the same name; what they are about, by the first part of the name. */
function rowOf(entry, key) {
  const name = key.replace(/^assay:/, ""), own = entry.method ? entry.method + "." : null;
  if (own && name.startsWith(own)) return ["Parameters of the method", name.slice(own.length)];
  const [, group, rest] = name.match(/^(scene|camera)\.?(.*)$/) ?? [null, "", name];
  return [group === "scene" ? "Scene" : group === "camera" ? "Camera" : "Image", rest || "name"];
}

function parameterRows(all) {
  const groups = new Map(GROUPS.map((name) => [name, new Map()]));
  const put = (group, name, index, value) => {
    const rows = groups.get(group);
    if (!rows.has(name)) rows.set(name, all.map(() => null));
    rows.get(name)[index] = value;
  };
  all.forEach((entry, index) => {
    for (const [key, value] of entry.attributes) put(...rowOf(entry, key), index, value);
    if (entry.samples) put("Image", "samples a pixel", index, format(entry.samples));
    for (const [name, of] of entry.cost ? COST_ROWS : []) {
      const value = of(entry.cost);
      if (value) put("Cost", name, index, value);
    }
  });
  return groups;
}

/* A parameter of all images; the first is the reference, which the others may differ from. */
function parameterRow(name, values) {
  const differs = (value) => value !== null && value !== values[0];
  return make("tr", {}, cell(name, "code", "th"),
    ...values.map((value) => cell(value, differs(value) ? "code different" : "code")));
}

function buildParameters() {
  const all = [reference, ...(candidates.length > 5 ? [shown()] : candidates)];
  const wide = all.length + 1, onlyDifferent = $("only-different").checked, table = $("attributes");
  const names = all.slice(1).map((c) => [c.name]);
  table.tHead.replaceChildren(head([["", ""], ["Reference: " + reference.name], ...names]));
  const body = [];
  for (const [group, rows] of parameterRows(all)) {
    const wanted = [...rows].filter(([, values]) => !onlyDifferent || values.some((v) => v !== values[0]));
    if (wanted.length === 0) continue;
    wanted.sort(([a], [b]) => a < b ? -1 : 1);
    body.push(make("tr", { className: "group" }, make("th", { colSpan: wide, scope: "rowgroup" }, group)),
      ...wanted.map(([name, values]) => parameterRow(name, values)));
  }
  if (body.length === 0) body.push(make("tr", {}, make("td", { colSpan: wide }, "Nothing differs.")));
  table.tBodies[0].replaceChildren(...body);
}
