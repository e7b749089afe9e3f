// The height field of a layer as an image: encode.rs describes the format.

const EMPTY = 0, VOID = 1, FIRST_HEIGHT = 2, FULL_SCALE = 2;
const VOID_COLOUR = INKS.void, VOID_RIM = VOID_COLOUR.map(v => 0.4 * v);
// Height in nominal bead heights, and its colour.
const HEAT = INKS.heights;

function heatAt(height) {
  const i = Math.max(1, HEAT.findIndex(([at]) => at >= height)), [low, a] = HEAT[i - 1], [high, b] = HEAT[i];
  return a.map((v, k) => v + (b[k] - v) * Math.min(Math.max((height - low) / (high - low), 0), 1));
}

const PALETTE = Array.from({ length: 256 }, (_, v) =>
  v === EMPTY ? [0, 0, 0, 0] : v === VOID ? [...VOID_COLOUR, 255] : [...heatAt((v - FIRST_HEIGHT) / (255 - FIRST_HEIGHT) * FULL_SCALE), 255]);

// The image has its lowest row first, as the part's y runs.
async function readMap(text) {
  if (!text) return null;
  const body = await inflate(bytesOf(text)), numbers = new DataView(body.buffer);
  const [x, y, pixel, columns, rows] = [0, 1, 2, 3, 4].map(i => numbers.getFloat64(8 * i, true));
  const values = body.subarray(40), image = new ImageData(columns, rows);
  for (let i = 0; i < values.length; i++) image.data.set(PALETTE[values[i]], 4 * i);
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
