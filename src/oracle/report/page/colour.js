/* colour.js - from codes to colours: one table a picture, made anew when exposure or scale change. */

const NOT_FINITE = [0, 230, 118];
const parse = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const HEAT = page.heat.map(parse), MAGMA = page.magma.map(parse);
const COLD = [[0, 0, 0], [12, 36, 92], [22, 88, 190], [70, 150, 245], [158, 205, 255], [235, 246, 255]];
const WARM = [[0, 0, 0], [92, 26, 10], [190, 58, 14], [245, 124, 40], [255, 196, 128], [255, 245, 230]];

function along(scale, t) {
  const last = scale.length - 1, at = Math.min(Math.max(t, 0), 1) * last;
  const i = Math.min(Math.floor(at), last - 1), next = scale[i + 1];
  return scale[i].map((low, c) => Math.round(low + (next[c] - low) * (at - i)));
}

/* A byte of sRGB. */
function encode(linear) {
  if (linear <= 0) return 0;
  if (linear >= 1) return 255;
  return Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
}

/* The kinds of picture: name, what a number means, where its scale begins. */
const MAPS = {
  difference: {
    label: "Difference", signed: true, unit: "", scale: null,
    about: "Candidate minus reference, the mean of R, G and B. "
      + "Black: equal. Orange: too bright. Blue: too dark.",
  },
  relative: {
    label: "Relative error", signed: false, percent: true, scale: 0.25,
    about: "|difference| / (|reference| + 1 % of its mean), the mean of R, G and B: "
      + "what assay diff --heat-map draws.",
  },
  z: {
    label: "z-score", signed: true, unit: "σ", scale: 4,
    about: "Difference in standard errors, of the channel where it is largest. "
      + "Noise alone stays within 3 nearly everywhere.",
  },
  flip: {
    label: "FLIP", signed: false, unit: "", scale: 1, colours: MAGMA,
    about: "HDR-FLIP: how different the images look when they alternate before the eyes, 0 to 1, "
      + "the worst over a range of exposures; the control above does not change it.",
  },
};

function colourOf(map, t) {
  if (Number.isNaN(t)) return NOT_FINITE;
  return map.signed ? along(t < 0 ? COLD : WARM, Math.abs(t)) : along(map.colours ?? HEAT, t);
}

/* A pixel as a canvas keeps it. */
const pack = (r, g, b) => (255 << 24 | b << 16 | g << 8 | r) >>> 0;
const STRANGE = pack(...NOT_FINITE);

/* Largest code of a picture: its tables go no farther. */
function reach(picture, planes) {
  let most = 0;
  for (const plane of planes) {
    for (let i = 0; i < plane.length; i++) {
      const size = Math.abs(plane[i]);
      if (size > most && size < INFINITE) most = size;
    }
  }
  picture.most = most;
  return most;
}

/* Colour pictures: light only, so negative values are black. */
function paintColour(picture, planes, exposure, out) {
  const most = picture.most ?? reach(picture, planes), gain = 2 ** exposure;
  const table = new Uint8Array(most + 1);
  for (let code = 0; code <= most; code++) table[code] = encode(gain * valueOf(picture, code));
  const light = (code) => code < 0 ? 0 : code <= most ? table[code] : 255;
  const [red, green, blue] = planes;
  for (let i = 0; i < PIXELS; i++) {
    const r = red[i], g = green[i], b = blue[i];
    const isStrange = r === NOT_A_NUMBER || g === NOT_A_NUMBER || b === NOT_A_NUMBER;
    out[i] = isStrange ? STRANGE : pack(light(r), light(g), light(b));
  }
}

function paintMap(picture, planes, map, full, out) {
  const most = picture.most ?? reach(picture, planes), table = new Uint32Array(2 * most + 1);
  for (let code = -most; code <= most; code++) {
    table[code + most] = pack(...colourOf(map, valueOf(picture, code) / full));
  }
  const under = pack(...colourOf(map, -1)), over = pack(...colourOf(map, 1));
  const pixelOf = (code) => {
    if (code === NOT_A_NUMBER) return STRANGE;
    if (Math.abs(code) > most) return code < 0 ? under : over;
    return table[code + most];
  };
  const plane = planes[0];
  for (let i = 0; i < PIXELS; i++) out[i] = pixelOf(plane[i]);
}
