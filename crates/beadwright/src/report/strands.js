// The points of a layer as the graphics card takes them: RECORD bytes each, all passes one after another.

// x, y, time in the layer, width, speed, temperature (Float32); kind, 1 where a piece begins (bytes), pass (Uint16).
const RECORD = 28;
// Points are left out as long as a bead moves by no more than this part of its width.
const THINNING = 0.04;

// The points of a pass that are needed: each piece stays within the tolerance of the points that it passes.
function needed(pass) {
  const { xy, along } = pass, count = xy.length / 2, kept = [0];
  let from = 0, low = -Infinity, high = Infinity, way = 0, last = 0;
  const begin = i => { kept.push(i); from = i; low = -Infinity; high = Infinity; last = 0; };
  for (let i = 1; i < count; i++) {
    const reach = THINNING * after(pass, from)[0];
    if (i - 1 > from && along.length > 1 && differs(after(pass, i - 1), after(pass, from))) begin(i - 1);
    let dx = xy[2 * i] - xy[2 * from], dy = xy[2 * i + 1] - xy[2 * from + 1], distance = Math.hypot(dx, dy);
    if (low === -Infinity) way = Math.atan2(dy, dx);
    let turn = turned(Math.atan2(dy, dx) - way);
    if (i - 1 > from && (turn < low || turn > high || distance < last)) {
      begin(i - 1);
      dx = xy[2 * i] - xy[2 * from]; dy = xy[2 * i + 1] - xy[2 * from + 1]; distance = Math.hypot(dx, dy);
      way = Math.atan2(dy, dx);
      turn = 0;
    }
    const open = distance > reach ? Math.asin(reach / distance) : Math.PI;
    low = Math.max(low, turn - open);
    high = Math.min(high, turn + open);
    last = distance;
  }
  if (count > 1) kept.push(count - 1);
  return kept;
}

const turned = angle => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
const differs = (a, b) => Math.abs(a[0] - b[0]) > 0.02 * b[0] || Math.abs(a[1] - b[1]) > 0.05 * b[1];

// Every pass has one more point at each end, so that the shader knows where its neighbours lie: the joint of a closed
// pass is like any other, and an open end repeats itself.
function strands(layer) {
  const lists = layer.passes.map(pass => pass.xy.length > 2 ? needed(pass) : []);
  const count = lists.reduce((sum, list) => sum + (list.length ? list.length + 2 : 0), 0);
  const buffer = new ArrayBuffer(RECORD * count), floats = new Float32Array(buffer), bytes = new Uint8Array(buffer), shorts = new Uint16Array(buffer);
  let at = 0;
  layer.passes.forEach((pass, index) => {
    const list = lists[index], n = list.length;
    const put = (i, begins) => {
      const [width, speed] = pass.along[Math.min(i, pass.along.length - 1)];
      floats.set([pass.xy[2 * i], pass.xy[2 * i + 1], pass.times[i], width, speed, pass.celsius ?? 0], at / 4);
      bytes[at + 24] = Math.min(pass.kind, 2);
      bytes[at + 25] = begins ? 1 : 0;
      shorts[at / 2 + 13] = Math.min(index, 65535);
      at += RECORD;
    };
    if (!n) return;
    put(pass.closed ? list[n - 2] : list[0], false);
    list.forEach((i, k) => put(i, k + 1 < n));
    put(pass.closed ? list[1] : list[n - 1], false);
  });
  return buffer;
}
