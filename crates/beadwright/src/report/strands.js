// The points of a layer as the graphics card takes them: eight numbers each (shaders.js names them), twelve of layers that are
// not level, in a texture of four numbers a texel, ACROSS texels in a row; all passes one after another.

const RECORD = 8, RECORD_IN_SPACE = 12, ACROSS = 512;
// Points are left out as long as a bead moves by no more than this fraction of its width.
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
  return count > 1 ? [...kept, count - 1] : [];
}

const turned = angle => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
const differs = (a, b) => Math.abs(a[0] - b[0]) > 0.02 * b[0] || Math.abs(a[1] - b[1]) > 0.05 * b[1];

// Whether a pass lies along the outline of its layer, by some of its points: such passes hide the others.
function outer({ xy, along }, rings) {
  const reach = 0.75 * along[0][0], step = 2 * Math.max(Math.floor(xy.length / 2 / 8), 1);
  for (let i = 0; i < xy.length; i += step) {
    if (rings.some(ring => near(ring, xy[i], xy[i + 1], reach))) return true;
  }
  return false;
}

function near(ring, x, y, reach) {
  for (let i = 0; i + 3 < ring.length; i += 2) {
    const [ax, ay, dx, dy] = [ring[i], ring[i + 1], ring[i + 2] - ring[i], ring[i + 3] - ring[i + 1]], length = dx * dx + dy * dy;
    const part = length > 0 ? Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / length, 0), 1) : 0;
    if (Math.abs(x - ax - part * dx) < reach && Math.hypot(x - ax - part * dx, y - ay - part * dy) < reach) return true;
  }
  return false;
}

// The points of a pass that are drawn, as [index, x, y, time]: pieces around an axis are divided.
function spreadOf({ pass, list }, lie) {
  const point = i => [i, pass.xy[2 * i], pass.xy[2 * i + 1], pass.times[i]], points = [point(list[0])];
  for (let k = 1; k < list.length; k++) {
    const from = point(list[k - 1]), to = point(list[k]), part = (t, axis) => from[axis] + t * (to[axis] - from[axis]);
    for (const t of divisions(lie, from.slice(1, 3), to.slice(1, 3))) points.push(t < 1 ? [from[0], part(t, 1), part(t, 2), part(t, 3)] : to);
  }
  return points;
}

// The passes with the points that they need, those along the outline first. Every pass has one more point at each end,
// so that the shader knows where its neighbours lie: the joint of a closed pass is like any other, an open end repeats itself.
// `lie` says how a layer lies in space that is not level.
function strands(layer, lie) {
  const rings = layer.islands.flat(), all = layer.passes.map((pass, index) => ({ pass, index, list: needed(pass) })).filter(({ list }) => list.length > 1).map(strand => ({ ...strand, points: spreadOf(strand, lie) }));
  const outside = all.filter(({ pass }) => outer(pass, rings)), inside = all.filter(strand => !outside.includes(strand));
  const records = list => list.reduce((sum, strand) => sum + strand.points.length + 2, 0), count = records(all);
  // Whole rows.
  const record = lie ? RECORD_IN_SPACE : RECORD, numbers = new Float32Array(Math.ceil(count * record / (4 * ACROSS)) * 4 * ACROSS);
  let at = 0;
  for (const { pass, index, points } of [...outside, ...inside]) {
    const n = points.length, put = ([i, x, y, time], begins) => {
      const [width, speed] = pass.along[Math.min(i, pass.along.length - 1)], tags = pass.kind + (begins ? 4 : 0), more = [speed, pass.celsius ?? 0, tags, index];
      if (lie) {
        const top = placed(lie, x, y, lie.top), [px, py, pz] = top.at;
        numbers.set([px, py, time, width, ...more, pz, ...top.normal], at);
      } else numbers.set([x, y, time, width, ...more], at);
      at += record;
    };
    put(pass.closed ? points[n - 2] : points[0], false);
    points.forEach((point, k) => put(point, k + 1 < n));
    put(pass.closed ? points[1] : points[n - 1], false);
  }
  return { numbers, count, outside: records(outside) };
}
