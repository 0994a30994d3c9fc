/* data.js - what the page was given, and pictures out of it (src/oracle/report/report_pack.c).
 *
 * A picture is kept as integers: planes of codes, from which colours come through one table. */

const NOT_A_NUMBER = 32767, INFINITE = 32766;

const readJson = (element) => JSON.parse(element.textContent);
const page = readJson(document.querySelector("script.page"));
const reference = readJson(document.querySelector("script.reference"));
const candidates = [...document.querySelectorAll("script.candidate")].map(readJson);
for (const { channels } of candidates) {
  channels.sort((a, b) => "RGB".indexOf(a.channel) - "RGB".indexOf(b.channel));
}
const WIDTH = reference.width, HEIGHT = reference.height, PIXELS = WIDTH * HEIGHT;

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflate(bytes, size) {
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
  const whole = new Uint8Array(size);
  for (let filled = 0;;) {
    const { done, value } = await reader.read();
    if (done) {
      if (filled !== size) throw new Error("a picture is cut short");
      return whole;
    }
    whole.set(value, filled);
    filled += value.length;
  }
}

/* Undoes folding and prediction of one plane; sums wrap at 16 bits as an Int16Array does. */
function unpredict(bytes, low, high) {
  const codes = new Int16Array(PIXELS);
  for (let y = 0, i = 0; y < HEIGHT; y++) {
    for (let x = 0; x < WIDTH; x++, i++) {
      const word = bytes[low + i] | bytes[high + i] << 8;
      const left = x > 0 ? codes[i - 1] : y > 0 ? codes[i - WIDTH] : 0;
      const up = y > 0 ? codes[i - WIDTH] : left;
      const both = x > 0 && y > 0 ? codes[i - WIDTH - 1] : up;
      const least = Math.min(left, up), most = Math.max(left, up);
      const guess = both >= most ? least : both <= least ? most : left + up - both;
      codes[i] = guess + (word >> 1 ^ -(word & 1));
    }
  }
  return codes;
}

async function decode(picture) {
  const script = document.getElementById("picture-" + picture.id);
  const bytes = await inflate(bytesOf(script.textContent), 2 * picture.planes * PIXELS);
  const planes = [];
  for (let p = 0; p < picture.planes; p++) {
    planes.push(unpredict(bytes, p * PIXELS, (picture.planes + p) * PIXELS));
  }
  if (picture.planes === 3) {
    const [green, red, blue] = planes;
    for (let i = 0; i < PIXELS; i++) {
      red[i] += green[i];
      blue[i] += green[i];
    }
    return [red, green, blue];
  }
  return planes;
}

/* Decoded once, when it is first looked at. */
function planesOf(picture) {
  picture.decoded ??= decode(picture);
  return picture.decoded;
}

function valueOf(picture, code) {
  if (code === NOT_A_NUMBER) return NaN;
  const size = Math.abs(code), sign = Math.sign(code);
  return size === INFINITE ? sign * Infinity : sign * picture.floor * (2 ** (size / picture.steps) - 1);
}

/* Half a step: by how much a shown value may be off, relative. */
const roundingOf = (picture) => (2 ** (1 / picture.steps) - 1) / 2;
