// Drawing one layer on a canvas.

const CHUNKS = 240;
const picture = $("picture");
const view = { scale: 1, x: 0, y: 0, width: 0, height: 0, fitted: true };
// `by` is a key of CHOICES; `lower` is the layer below, while it is to be seen; `picked` { layer, pass } and `mark` { layer, x, y } are pointed out.
const shown = { layer: null, index: 0, until: Infinity, by: "kind", width: true, travels: true, ends: true, outline: true, below: false, lower: null, picked: null, mark: null };

// The whole part in the middle; the same for all layers, so that they can be compared.
const partBox = heads.reduce((b, h) => h.points ? {
  left: Math.min(b.left, h.x), right: Math.max(b.right, h.x + h.sizeX),
  low: Math.min(b.low, h.y), high: Math.max(b.high, h.y + h.sizeY),
} : b, { left: Infinity, right: -Infinity, low: Infinity, high: -Infinity });

function fit() {
  const b = partBox, room = data.bead.width, edge = 0.06 * Math.min(view.width, view.height);
  const width = b.right - b.left + room, height = b.high - b.low + room;
  view.scale = Math.min((view.width - 2 * edge) / width, (view.height - 2 * edge) / height);
  view.x = view.width / 2 - view.scale * (b.left + b.right) / 2;
  view.y = view.height / 2 + view.scale * (b.low + b.high) / 2;
  view.fitted = true;
}

function zoom(factor, x, y) {
  const scale = Math.min(Math.max(view.scale * factor, 1e-4), 2e3);
  view.x = x + (view.x - x) * scale / view.scale;
  view.y = y + (view.y - y) * scale / view.scale;
  view.scale = scale;
  view.fitted = false;
}

// The points of a pass between two times, with a point at each of the two.
function between(pass, from, to) {
  const { xy, times } = pass, path = new Path2D(), last = times.length - 1;
  let i = 0;
  for (let high = last; i < high;) {
    const middle = (i + high) >> 1;
    if (times[middle + 1] > from) high = middle; else i = middle + 1;
  }
  const [startX, startY] = pointAt(pass, i, from);
  path.moveTo(startX, startY);
  for (i++; i <= last && times[i] < to; i++) path.lineTo(xy[2 * i], xy[2 * i + 1]);
  const end = i <= last ? pointAt(pass, i - 1, to) : [xy[2 * last], xy[2 * last + 1]];
  path.lineTo(...end);
  return { path, end };
}

function pointAt({ xy, times }, i, time) {
  if (i + 1 >= times.length) return [xy[2 * i], xy[2 * i + 1]];
  const step = times[i + 1] - times[i], part = step > 0 ? Math.min(Math.max((time - times[i]) / step, 0), 1) : 0;
  return [0, 1].map(axis => xy[2 * i + axis] + part * (xy[2 * i + 2 + axis] - xy[2 * i + axis]));
}

function pathOf(points, path = new Path2D()) {
  for (let i = 0; i < points.length; i += 2) i ? path.lineTo(points[i], points[i + 1]) : path.moveTo(points[0], points[1]);
  return path;
}

// The parts of a pass to be drawn, as paths with a colour and a width each.
function strokes(pass, layer, limit = shown.until) {
  const until = Math.min(pass.end, limit), { times, along } = pass, wide = along[0][0];
  if (along.length > 1) {
    const list = [];
    for (let i = 0; i + 1 < times.length && (!i || times[i] < until); i++) {
      const colour = colourOf(pass, i, (times[i] + times[i + 1]) / 2, layer);
      const end = times[i + 1] > until ? pointAt(pass, i, until) : [pass.xy[2 * i + 2], pass.xy[2 * i + 3]];
      list.push({ path: pathOf([pass.xy[2 * i], pass.xy[2 * i + 1], ...end]), colour, wide: after(pass, i)[0] });
    }
    return list;
  }
  if (!CHOICES[shown.by].flows) {
    const path = until >= pass.end ? pass.path ??= pathOf(pass.xy) : between(pass, pass.start, until).path;
    return [{ path, colour: colourOf(pass, 0, pass.start, layer), wide }];
  }
  const step = layer.seconds / CHUNKS || 1, list = [];
  const count = Math.max(1, Math.round((pass.end - pass.start) / step)), chunk = (pass.end - pass.start) / count;
  for (let k = 0; k < count; k++) {
    const from = pass.start + k * chunk, to = Math.min(from + chunk, until);
    if (k && from >= until) break;
    list.push({ path: between(pass, from, to).path, colour: colourOf(pass, 0, (from + to) / 2, layer), wide });
  }
  return list;
}

// A bead looks round: on a dark stroke lie ever narrower and lighter ones.
function drawBeads(ctx, passes, layer) {
  const pixel = 1 / view.scale;
  for (const pass of passes) {
    const parts = strokes(pass, layer), wide = Math.max(...pass.along.map(a => a[0]));
    const stroke = (width, colour) => {
      for (const part of parts) {
        ctx.lineWidth = shown.width ? width * part.wide / wide : width;
        ctx.strokeStyle = rgb(colour(part.colour));
        ctx.stroke(part.path);
      }
    };
    if (!shown.width) {
      stroke(1.6 * pixel, c => c);
      continue;
    }
    if (hurried()) {
      stroke(0.86 * wide, c => c);
      continue;
    }
    stroke(wide, c => mix(c, BLACK, 0.34));
    const rings = Math.min(Math.max(Math.round(wide * view.scale / 6), 2), 9);
    for (let k = 0; k < rings; k++) {
      const part = k / (rings - 1), width = (1 - part) * Math.max(wide - 1.6 * pixel, 0.85 * wide) + part * 0.22 * wide;
      stroke(width, c => part < 0.4 ? mix(c, BLACK, 0.12 - 0.3 * part) : mix(c, WHITE, 0.4 * (part - 0.4)));
    }
  }
}

// Strokes of one colour along passes, `part` of each bead's width wide.
function strokeAll(ctx, layer, passes, until, part, colour) {
  ctx.strokeStyle = colour;
  for (const { path, wide } of passes.flatMap(pass => strokes(pass, layer, until))) {
    ctx.lineWidth = part * wide;
    ctx.stroke(path);
  }
}

// The middle of each bead where none lies below: drawn on a canvas of its own, less the beads of the layer below.
const overlay = document.createElement("canvas");
function drawHanging(ctx, passes, layer, lower) {
  Object.assign(overlay, { width: picture.width, height: picture.height });
  const over = overlay.getContext("2d");
  over.setTransform(ctx.getTransform());
  over.lineCap = over.lineJoin = "round";
  strokeAll(over, layer, passes, shown.until, 0.5, rgb(VOID_COLOUR));
  over.globalCompositeOperation = "destination-out";
  strokeAll(over, lower, lower.passes, Infinity, 1, "#000000");
  ctx.save();
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  ctx.drawImage(overlay, 0, 0);
  ctx.restore();
}

function drawTravels(ctx, passes) {
  const pixel = 1 / view.scale, path = new Path2D();
  for (let i = 1; i < passes.length; i++) {
    const a = passes[i - 1].xy, b = passes[i].xy;
    path.moveTo(a[a.length - 2], a[a.length - 1]);
    path.lineTo(b[0], b[1]);
  }
  for (const [width, colour] of [[3, colours.stage], [1.3, colours.text]]) {
    ctx.strokeStyle = colour;
    ctx.lineWidth = width * pixel;
    ctx.setLineDash([6 * pixel, 5 * pixel]);
    ctx.stroke(path);
  }
  ctx.setLineDash([]);
}

function dot(ctx, x, y, radius, colour) {
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.fillStyle = colour;
  ctx.fill();
}

function drawEnds(ctx, passes) {
  const pixel = 1 / view.scale;
  const ends = passes.filter(pass => pass.end <= shown.until);
  const mark = (x, y, radius, colour) => {
    dot(ctx, x, y, (radius + Math.min(1.2, radius / 3)) * pixel, "#ffffff");
    dot(ctx, x, y, radius * pixel, colour);
  };
  // Ends of a fixed size would hide many narrow passes.
  const room = ({ along }) => Math.min(Math.max(0.3 * along[0][0] * view.scale, 1.5), 5);
  for (const pass of ends) mark(pass.xy.at(-2), pass.xy.at(-1), room(pass), colours.end);
  for (const pass of passes) mark(pass.xy[0], pass.xy[1], 0.64 * room(pass), colours.start);
}

function drawTorch(ctx, pass) {
  const pixel = 1 / view.scale, [x, y] = between(pass, pass.start, shown.until).end;
  dot(ctx, x, y, 9 * pixel, "rgb(255 255 255 / 75%)");
  dot(ctx, x, y, 5 * pixel, "#15181d");
}

function drawWarnings(ctx, warnings) {
  const size = 9 / view.scale;
  for (const [x, y, , serious] of warnings) {
    ctx.beginPath();
    ctx.moveTo(x, y + size);
    ctx.lineTo(x + size, y - 0.7 * size);
    ctx.lineTo(x - size, y - 0.7 * size);
    ctx.closePath();
    ctx.fillStyle = serious ? colours.end : colours.stage;
    ctx.strokeStyle = serious ? colours.stage : colours.mark;
    ctx.lineWidth = 2.2 / view.scale;
    ctx.fill();
    ctx.stroke();
  }
}

// The pass below the pointer.
function drawPicked(ctx, pass) {
  pass.path ??= pathOf(pass.xy);
  const wide = Math.max(0.4 * pass.along[0][0], 3 / view.scale);
  for (const [width, colour] of [[wide + 2.4 / view.scale, colours.stage], [wide, colours.chosen]]) {
    ctx.lineWidth = width;
    ctx.strokeStyle = colour;
    ctx.stroke(pass.path);
  }
}

// The place that a warning is about.
function drawMark(ctx, { x, y }) {
  for (const [width, colour] of [[6, colours.stage], [2.6, colours.mark]]) {
    ctx.beginPath();
    ctx.arc(x, y, 16 / view.scale, 0, 2 * Math.PI);
    ctx.lineWidth = width / view.scale;
    ctx.strokeStyle = colour;
    ctx.stroke();
  }
}

function drawScaleBar(ctx) {
  const most = 140 / view.scale, power = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].find(f => f * power <= most) * power, x = 16, y = view.height - 16, end = x + length * view.scale;
  const text = `${Number(length.toPrecision(1))} mm`;
  for (const [width, colour] of [[4, colours.stage], [1.6, colours.text]]) {
    ctx.beginPath();
    for (const at of [x, end]) { ctx.moveTo(at, y - 5); ctx.lineTo(at, y + 5); }
    ctx.moveTo(x, y);
    ctx.lineTo(end, y);
    ctx.strokeStyle = colour;
    ctx.lineWidth = width;
    ctx.stroke();
  }
  ctx.font = "600 13px system-ui, sans-serif";
  ctx.textAlign = "center";
  ctx.lineWidth = 4;
  ctx.strokeStyle = colours.stage;
  ctx.strokeText(text, (x + end) / 2, y - 9);
  ctx.fillStyle = colours.text;
  ctx.fillText(text, (x + end) / 2, y - 9);
}

// The height field of a layer is read when it is to be seen.
async function fetchMap(layer) {
  if (layer.map !== undefined) return;
  layer.map = null;
  layer.map = await readMap(data.maps[layer.index]);
  redraw();
}

function draw() {
  sharpen(picture);
  const ctx = picture.getContext("2d"), ratio = picture.width / view.width || 1, layer = shown.layer;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.fillStyle = colours.stage;
  ctx.fillRect(0, 0, view.width, view.height);
  if (!layer) return;
  ctx.setTransform(ratio * view.scale, 0, 0, -ratio * view.scale, ratio * view.x, ratio * view.y);
  ctx.lineCap = ctx.lineJoin = "round";
  layer.outline ??= layer.islands.flat().reduce((path, ring) => pathOf(ring, path), new Path2D());
  ctx.fillStyle = colours.slice;
  ctx.fill(layer.outline, "evenodd");
  const passes = layer.passes.filter(pass => pass.xy.length && (pass.start < shown.until || pass.end <= shown.until));
  const lower = shown.below && shown.lower?.index === layer.index - 1 && shown.lower;
  if (lower) strokeAll(ctx, lower, lower.passes, Infinity, 1, colours.travel);
  if (shown.by === "heat") fetchMap(layer);
  const heat = shown.by === "heat" && layer.map;
  if (heat) drawMap(ctx, layer.map, view.scale);
  else drawBeads(ctx, passes, layer);
  if (lower) drawHanging(ctx, passes, layer, lower);
  if (shown.outline) {
    ctx.strokeStyle = colours.outline;
    ctx.lineWidth = 1.4 / view.scale;
    ctx.stroke(layer.outline);
  }
  if (shown.travels && !heat) drawTravels(ctx, passes);
  if (shown.ends && !heat) drawEnds(ctx, passes);
  drawWarnings(ctx, layer.warnings);
  const picked = shown.picked?.layer === shown.index && layer.passes[shown.picked.pass];
  if (picked) drawPicked(ctx, picked);
  if (shown.mark?.layer === shown.index) drawMark(ctx, shown.mark);
  const last = passes.at(-1);
  if (last && shown.until < layer.seconds) drawTorch(ctx, last);
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawScaleBar(ctx);
}

let waiting = 0;
function redraw() {
  waiting ||= requestAnimationFrame(() => { waiting = 0; draw(); drawSolid(); });
}

function resizeCanvas(canvas, width, height) {
  const ratio = window.devicePixelRatio || 1;
  canvas.style.height = `${height}px`;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
}

