// Reading layers: encode.rs describes the format. A layer is inflated when it is shown.

const HEAD = 18, HEAD_CHARACTERS = 192;

function readHead(text) {
  const [z, height, slice, planned, length, seconds, travel, passes, warnings, x, y, sizeX, sizeY, resolution, points, judged, empty, full] =
    new Float64Array(bytesOf(text.slice(0, HEAD_CHARACTERS)).buffer, 0, HEAD);
  const share = slice > 0 ? 100 * planned / slice : 0;
  const voids = judged > 0 ? 100 * empty / judged : 0, overfill = judged > 0 ? 100 * full / judged : 0;
  return { judged, voids, overfill, z, height, slice, planned, share, length, seconds, travel, passes, warnings, x, y, sizeX, sizeY, resolution, points };
}

// The points of all paths as [x0, y0, x1, y1, …], mm.
function readPoints(body, offset, head) {
  const n = head.points, xy = new Float64Array(2 * n);
  const difference = i => (body[offset + i] | body[offset + n + i] << 8) << 16 >> 16;
  for (let axis = 0, at = 0; axis < 2; axis++, at = 0, offset += 2 * n) {
    const origin = axis ? head.y : head.x;
    for (let i = 0; i < n; i++) {
      at += difference(i);
      xy[2 * i + axis] = origin + at * head.resolution;
    }
  }
  return xy;
}

async function readLayer(text, head) {
  const body = await inflate(bytesOf(text.slice(HEAD_CHARACTERS)));
  const numbers = new DataView(body.buffer);
  const end = 4 + 4 * numbers.getUint32(0, true);
  const xy = readPoints(body, end, head);
  let place = 4, point = 0;
  const next = () => numbers.getUint32((place += 4) - 4, true);
  const path = (count, closed) => {
    const points = xy.subarray(2 * point, 2 * (point += count));
    return closed && count > 0 ? Float64Array.of(...points, points[0], points[1]) : points;
  };
  const list = read => Array.from({ length: next() }, read);
  const islands = list(() => list(next)).map(rings => rings.map(count => path(count, true)));
  const passes = list(() => {
    const flags = next(), count = next(), closed = (flags & 256) > 0;
    const along = Array.from({ length: flags & 512 ? count : 1 }, () => [next() / 1e3, next() / 1e3]);
    return { kind: flags & 255, along, count, closed };
  }).map(({ kind, along, count, closed }) => ({ kind, along, xy: path(count, closed) }));
  let seconds = 0;
  for (const pass of passes) seconds = timePass(pass, seconds);
  const warnings = JSON.parse(new TextDecoder().decode(body.subarray(end + 4 * head.points)));
  return { islands, passes, seconds, warnings };
}

// Width and speed from a point to the next.
const after = ({ along }, i) => along[along.length > 1 ? i : 0];

// When the torch is at each point, from the start of the layer with the arc on, s.
function timePass(pass, start) {
  const { xy } = pass, times = new Float64Array(xy.length / 2);
  for (let i = 0, t = start; i < times.length; i++) {
    if (i) t += Math.hypot(xy[2 * i] - xy[2 * i - 2], xy[2 * i + 1] - xy[2 * i - 1]) / after(pass, i - 1)[1];
    times[i] = t;
  }
  pass.times = times;
  pass.start = start;
  return pass.end = times.length ? times[times.length - 1] : start;
}
