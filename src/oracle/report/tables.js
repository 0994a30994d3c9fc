/* tables.js - verdict, candidates, channels, stages, parameters. */

const cell = (content, className = "", tag = "td") => make(tag, className ? { className } : {}, content ?? "–");
const head = (names) => make("tr", {}, ...names.map(([name, className = ""]) => make("th", { scope: "col", className }, name)));
const KINDS = { pass: ["pass", "✓"], fail: ["fail", "✕"], "cannot tell": ["unsure", "?"] };

function pill(kind) {
  const [className, sign] = KINDS[kind] ?? ["unsure", "?"];
  return make("span", { className: "pill " + className }, make("span", { "aria-hidden": "true" }, sign), " ", String(kind));
}

/* ---- the verdict of the candidate that is shown ---- */

function buildVerdict() {
  const verdict = shown().verdict, section = $("verdict");
  section.hidden = !verdict;
  if (!verdict) return;
  const first = verdict.findings[verdict.first], kind = (KINDS[verdict.verdict] ?? KINDS["cannot tell"])[0];
  section.className = kind;
  section.replaceChildren(...[
    make("h2", { id: "verdict-heading" }, pill(verdict.verdict), " ", shown().name),
    make("p", {}, verdict.summary ?? ""),
    first ? make("p", { className: "links" }, make("a", { href: `#finding-${verdict.first}` },
      `${verdict.verdict === "fail" ? "First failure" : "First doubt"}: ${first.stage}, ${first.array}`), placeButton(first)) : null].filter(Boolean));
}

/* A finding's place, as a button where it is in the image. */
function placeButton(finding) {
  const spot = finding.place;
  if (!spot) return null;
  if (spot.x === undefined) return `row ${spot.row}, column ${spot.column}`;
  const text = spot.width > 1 || spot.height > 1 ? `tile (${spot.x}, ${spot.y}) ${spot.width} × ${spot.height}` : `(${spot.x}, ${spot.y})`;
  return make("button", { type: "button", className: "link", title: "Show this place in the picture", onclick: () => showPlace(spot) }, text);
}

const exact = (value, hex) => hex ? make("span", { title: hex }, format(value, 6)) : format(value, 6);

function buildStages() {
  const verdict = shown().verdict;
  $("stages").hidden = !verdict;
  if (!verdict) return;
  $("findings").tHead.replaceChildren(head([["Verdict"], ["Stage"], ["Array"], ["Test"], ["Values", "number"], ["Worst at"], ["Candidate", "number"],
    ["Reference", "number"], ["Of what passes", "number"], ["p", "number"]]));
  let stage = null;
  $("findings").tBodies[0].replaceChildren(...verdict.findings.flatMap((f, i) => {
    const row = make("tr", { id: `finding-${i}`, tabIndex: -1 }, cell(pill(f.verdict)), cell(f.stage === stage ? "" : f.stage, "stage", "th"),
      cell(f.channel ? `${f.array}, ${f.channel}` : f.array, "code"), cell(f.test), cell(count(f.values), "number"), cell(placeButton(f)),
      cell(exact(f.candidate, f.candidate_hex), "number"), cell(exact(f.reference, f.reference_hex), "number"),
      cell(f.in_bounds === null ? "–" : `${format(f.in_bounds, 3)} ×`, "number"), cell(format(f.p, 2), "number"));
    if (i === verdict.first) row.dataset.first = "";
    stage = f.stage;
    const meaning = f.meaning && f.verdict !== "pass" ? make("tr", { className: "meaning" }, make("td"), make("td", { colSpan: 9 }, f.meaning)) : null;
    return meaning ? [row, meaning] : [row];
  }));
}

/* ---- candidates ---- */

function buildCandidates() {
  const several = candidates.length > 1;
  $("overview").hidden = !several;
  $("candidate-tabs").hidden = !several || candidates.length > 5;
  if (!several) return;
  const withVerdict = candidates.some((c) => c.verdict), withFlip = candidates.some((c) => c.flip), withCost = candidates.some((c) => c.cost);
  const worst = Math.max(...candidates.map(errorOf)) || 1;
  $("candidates").tHead.replaceChildren(head([["Candidate"], ["Method"], ["Samples", "number"], ...(withCost ? [["Seconds", "number"], ["Records", "number"]] : []),
    ["Relative RMSE", "number"], ["", "bar-head"], ["Mean offset", "number"], ["z rms", "number"], ...(withFlip ? [["FLIP", "number"]] : []),
    ...(withVerdict ? [["Verdict"]] : [])]));
  $("candidates").tBodies[0].replaceChildren(...candidates.map((c, index) => {
    const offset = c.channels.reduce((sum, d) => sum + d.bias, 0) / c.channels.reduce((sum, d) => sum + Math.abs(d.meanReference), 0);
    const row = make("tr", {},
      cell(make("button", { type: "button", className: "link", onclick: () => chooseCandidate(index) }, c.name), "", "th"),
      cell(c.method), cell(c.samples ? format(c.samples, 4) : "–", "number"),
      ...(withCost ? [cell(format(c.cost?.seconds, 3), "number"), cell(c.cost?.records ? count(c.cost.records) : "–", "number")] : []),
      cell(percent(errorOf(c)), "number"), cell(make("span", { className: "meter", style: `width: ${(100 * errorOf(c) / worst).toFixed(1)}%` }), "bar-cell"),
      cell(percent(offset, 2), "number"), cell(c.channels.some((d) => d.zRms === null) ? "–" : format(overall(c, "zRms"), 3), "number"),
      ...(withFlip ? [cell(format(c.flip?.mean, 3), "number")] : []), ...(withVerdict ? [cell(c.verdict ? pill(c.verdict.verdict) : "–")] : []));
    row.dataset.index = index;
    return row;
  }));
  $("candidate-tabs").append(...candidates.map((c, index) => make("label", {},
    make("input", { type: "radio", name: "candidate", value: index, checked: index === 0 }), make("span", {}, c.name))));
}

/* ---- channels ---- */

function buildChannels() {
  const pixels = PIXELS;
  $("channel-table").replaceChildren(make("thead", {}, head([["Channel"], ["Mean of reference", "number"], ["Mean of candidate", "number"], ["Mean offset", "number"],
    ["RMSE", "number"], ["Relative RMSE", "number"], ["z rms", "number"], ["Largest difference", "number"], ["at"], ["Differing", "number"], ["Not finite", "number"]])),
  make("tbody", {}, ...shown().channels.map((c) => make("tr", {}, cell(make("span", { className: "channel channel-" + c.channel }, c.channel), "", "th"),
    cell(format(c.meanReference), "number"), cell(format(c.meanCandidate), "number"), cell(format(c.bias, 3), "number"), cell(format(c.rmse, 3), "number"),
    cell(percent(c.relativeRmse), "number"), cell(format(c.zRms, 3), "number"), cell(format(c.maxAbs, 3), "number"),
    cell(placeButton({ place: { x: c.maxX, y: c.maxY, width: 1, height: 1 } })), cell(percent(c.differing / pixels, 3), "number"),
    cell(count(c.notFinite), "number")))));
}

/* ---- parameters ---- */

const COST_ROWS = [["render, s", (c) => c && format(c.seconds, 4)], ["threads", (c) => c && format(c.threads)], ["rays", (c) => c && count(c.rays)],
  ["records", (c) => c?.records ? count(c.records) : null], ["peak memory, MB", (c) => c && format(c.memory / 1e6, 3)]];

/* Parameters of all methods under the same name; what they are about, by the first part of the name. */
function rowOf(entry, key) {
  const name = key.replace(/^assay:/, ""), own = entry.method ? entry.method + "." : null;
  if (own && name.startsWith(own)) return ["Parameters of the method", name.slice(own.length)];
  const [, group, rest] = name.match(/^(scene|camera)\.?(.*)$/) ?? [null, "", name];
  return [group === "scene" ? "Scene" : group === "camera" ? "Camera" : "Image", rest || "name"];
}

function parameterRows(all) {
  const groups = new Map(["Image", "Parameters of the method", "Scene", "Camera", "Cost"].map((name) => [name, new Map()]));
  const put = (group, name, index, value) => {
    const rows = groups.get(group);
    if (!rows.has(name)) rows.set(name, all.map(() => null));
    rows.get(name)[index] = value;
  };
  all.forEach((entry, index) => {
    for (const [key, value] of entry.attributes) put(...rowOf(entry, key), index, value);
    if (entry.samples) put("Image", "samples a pixel", index, format(entry.samples));
    for (const [name, of] of COST_ROWS) {
      const value = of(entry.cost);
      if (value) put("Cost", name, index, value);
    }
  });
  return groups;
}

function buildParameters() {
  const all = [reference, ...(candidates.length > 5 ? [shown()] : candidates)], only = $("only-different").checked;
  $("attributes").tHead.replaceChildren(head([["", ""], ["Reference: " + reference.name], ...all.slice(1).map((c) => [c.name])]));
  const parts = [];
  for (const [group, rows] of parameterRows(all)) {
    const wanted = [...rows].filter(([, values]) => !only || values.some((v) => v !== values[0])).sort(([a], [b]) => a < b ? -1 : 1);
    if (wanted.length === 0) continue;
    parts.push(make("tr", { className: "group" }, make("th", { colSpan: all.length + 1, scope: "rowgroup" }, group)),
      ...wanted.map(([name, values]) => make("tr", {}, cell(name, "code", "th"),
        ...values.map((v) => cell(v, v !== null && v !== values[0] ? "code different" : "code")))));
  }
  $("attributes").tBodies[0].replaceChildren(...(parts.length ? parts : [make("tr", {}, make("td", { colSpan: all.length + 1 }, "Nothing differs."))]));
}
