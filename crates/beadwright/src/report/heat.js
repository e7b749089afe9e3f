// The height field of a layer as an image: encode.rs describes the format.

const EMPTY = 0, VOID = 1, FIRST_HEIGHT = 2, FULL_SCALE = 2;
const VOID_COLOUR = INKS.void, VOID_RIM = VOID_COLOUR.map(v => 0.4 * v);
// Height in nominal bead heights, and its colour.
const HEAT = INKS.heights;

function heatAt(height) {
  const i = Math.max(1, HEAT.findIndex(([at]) => at >= height)), [low, a] = HEAT[i - 1], [high, b] = HEAT[i];
  return a.map((v, k) => v + (b[k] - v) * Math.min(Math.max((height - low) / (high - low), 0), 1));
}

// Position of a value within a range, 0 to 1; the middle if the range is a single value.
const partOf = (value, [low, high]) => high > low ? (value - low) / (high - low) : 0.5;

// The colours of the values of a picture that stands for `whole`, where those of the scale are to stand for `range`.
const paletteOf = (whole, range) => Array.from({ length: 256 }, (_, v) => {
  if (v === EMPTY) return [0, 0, 0, 0];
  if (v === VOID) return [...VOID_COLOUR, 255];
  const value = whole[0] + (v - FIRST_HEIGHT) / (255 - FIRST_HEIGHT) * (whole[1] - whole[0]);
  return [...heatAt(FULL_SCALE * Math.min(Math.max(partOf(value, range), 0), 1)), 255];
});

const PALETTE = paletteOf([0, FULL_SCALE], [0, FULL_SCALE]);

// The range that two fields give, in units of `per`; those left as they were keep what they round. None where the ends meet or cross:
// that would leave no colours between them.
function typedRange(fields, before, digits, per = 1) {
  const range = fields.map(({ value }, i) =>
    value === (before[i] / per).toFixed(digits) ? before[i] : value === "" ? NaN : per * Number(value));
  return range[0] < range[1] ? range : undefined;
}

// The image has its lowest row first, as the part's y runs.
async function readMap(text, palette = PALETTE) {
  if (!text) return null;
  const body = await inflate(bytesOf(text)), numbers = new DataView(body.buffer);
  const [x, y, pixel, columns, rows] = [0, 1, 2, 3, 4].map(i => numbers.getFloat64(8 * i, true));
  const values = body.subarray(40), image = new ImageData(columns, rows);
  for (let i = 0; i < values.length; i++) image.data.set(palette[values[i]], 4 * i);
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: columns, height: rows });
  canvas.getContext("2d").putImageData(image, 0, 0);
  return { canvas, x, y, width: columns * pixel, height: rows * pixel, rim: voidRim(values, columns, x, y, pixel) };
}

// The edges between void pixels and others.
function voidRim(values, columns, x, y, pixel) {
  const path = new Path2D(), edge = (ax, ay, bx, by) => {
    path.moveTo(x + ax * pixel, y + ay * pixel);
    path.lineTo(x + bx * pixel, y + by * pixel);
  };
  for (let i = 0; i < values.length; i++) {
    const c = i % columns, r = (i - c) / columns, here = values[i] === VOID;
    if (c && here !== (values[i - 1] === VOID)) edge(c, r, c, r + 1);
    if (r && here !== (values[i - columns] === VOID)) edge(c, r, c + 1, r);
  }
  return path;
}

function drawMap(ctx, map, scale) {
  ctx.imageSmoothingEnabled = false;
  ctx.drawImage(map.canvas, map.x, map.y, map.width, map.height);
  ctx.strokeStyle = `rgb(${VOID_RIM.join(" ")})`;
  ctx.lineWidth = 1.2 / scale;
  ctx.stroke(map.rim);
}

function drawKey(canvas, colourAt) {
  const ctx = canvas.getContext("2d");
  for (let i = 0; i < canvas.width; i++) {
    ctx.fillStyle = `rgb(${colourAt(i / canvas.width).map(Math.round).join(" ")})`;
    ctx.fillRect(i, 0, 1, canvas.height);
  }
}
