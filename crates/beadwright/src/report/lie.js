// How layers lie in space; lie.rs describes their data. Level layers have none.

// A place of a layer in space, `up` mm above its middle, and the normal there; its length is the layer's thickness
// there divided by the usual one.
function placed(lie, u, v, up) {
  if (lie.flat) {
    const { origin, along, normal, bend } = lie.flat, rise = 1 - bend[0] * u - bend[1] * v;
    return { at: origin.map((o, i) => o + u * along[0][i] + v * along[1][i] + up * rise * normal[i]), normal: normal.map(n => rise * n) };
  }
  if (lie.over) {
    const { axes, middle, body } = lie.over, [height, sx, sy] = heightAt(data.surfaces[body], u, v), w = middle + up + height, long = Math.hypot(sx, sy, 1);
    const turned = (x, y, z) => [0, 1, 2].map(i => axes[0][i] * x + axes[1][i] * y + axes[2][i] * z);
    return { at: turned(u, v, w), normal: turned(-sx / long, -sy / long, 1 / long) };
  }
  const { centre, axis, out, around, radius, side, half } = lie.around, cone = Math.sin(half ?? 0);
  const [angle, reach] = half === undefined ? [u / radius, v] : [Math.atan2(u, v) / cone, Math.hypot(u, v)], cos = Math.cos(angle), sin = Math.sin(angle);
  const outward = out.map((o, i) => o * cos + around[i] * sin);
  if (half === undefined) return { at: centre.map((c, i) => c + axis[i] * reach + outward[i] * (radius + side * up)), normal: outward.map(o => side * o) };
  const line = axis.map((a, i) => a * Math.cos(half) + outward[i] * cone), normal = outward.map((o, i) => o * Math.cos(half) - axis[i] * cone);
  return { at: centre.map((c, i) => c + line[i] * reach + normal[i] * up), normal };
}

// Height and slopes of a surface of cubic splines.
function heightAt({ from, step, columns, control }, x, y) {
  const rows = control.length / columns, near = (v, low, high) => Math.min(Math.max(v, low), high);
  const [px, py] = [near((x - from[0]) / step, 0, columns - 1), near((y - from[1]) / step, 0, rows - 1)], [i0, j0] = [Math.min(Math.floor(px), columns - 2), Math.min(Math.floor(py), rows - 2)];
  const basis = t => [[(1 - t) ** 3 / 6, (4 - 6 * t * t + 3 * t ** 3) / 6, (4 - 6 * (1 - t) ** 2 + 3 * (1 - t) ** 3) / 6, t ** 3 / 6], [-((1 - t) ** 2) / 2, (3 * t * t - 4 * t) / 2, (4 * (1 - t) - 3 * (1 - t) ** 2) / 2, t * t / 2]];
  const [bx, dx] = basis(px - i0), [by, dy] = basis(py - j0), at = (i, j) => control[near(j, 0, rows - 1) * columns + near(i, 0, columns - 1)];
  let height = 0, sx = 0, sy = 0;
  for (let j = 0; j < 4; j++) for (let i = 0; i < 4; i++) {
    const c = at(i0 + i - 1, j0 + j - 1);
    height += c * bx[i] * by[j];
    sx += c * dx[i] * by[j] / step;
    sy += c * bx[i] * dy[j] / step;
  }
  return [height, sx, sy];
}

// Fractions of a straight piece on a layer, 0 to 1, close enough together that the piece follows the layer in space;
// the last is 1.
function divisions(lie, from, to) {
  if (lie?.over) {
    const count = Math.max(Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / data.surfaces[lie.over.body].step), 1);
    return Array.from({ length: count }, (_, k) => (k + 1) / count);
  }
  if (!lie?.around) return [1];
  const [a, b] = [from, to].map(([u, v]) => placed(lie, u, v, 0).normal), { radius, half } = lie.around;
  // The angle between two normals is never more than half a turn.
  const turn = Math.max(Math.acos(Math.min(dot3(a, b), 1)), half === undefined ? Math.abs(to[0] - from[0]) / radius : 0);
  const count = Math.max(Math.ceil(turn / 0.1), 1);
  return Array.from({ length: count }, (_, k) => (k + 1) / count);
}

// The box around layers in space.
function boxOf(heads, lies) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  heads.forEach((head, index) => {
    if (!head.points) return;
    for (let i = 0; i <= 32; i++) for (let j = 0; j <= 8; j++) for (const up of [-head.height / 2, head.height / 2]) {
      const { at } = placed(lies[index], head.x + head.sizeX * i / 32, head.y + head.sizeY * j / 8, up);
      at.forEach((v, axis) => { low[axis] = Math.min(low[axis], v); high[axis] = Math.max(high[axis], v); });
    }
  });
  return [low, high];
}
