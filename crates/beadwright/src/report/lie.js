// How layers lie in space: lie.rs tells what is known of each. Level layers have none.

// A place of a layer, `up` mm above its middle, and the normal there, as long as the layer is thick of its usual thickness.
function placed(lie, u, v, up) {
  if (lie.flat) {
    const { origin, along, normal, bend } = lie.flat, rise = 1 - bend[0] * u - bend[1] * v;
    return { at: origin.map((o, i) => o + u * along[0][i] + v * along[1][i] + up * rise * normal[i]), normal: normal.map(n => rise * n) };
  }
  const { centre, axis, out, around, radius, side, half } = lie.around, cone = Math.sin(half ?? 0);
  const [angle, reach] = half === undefined ? [u / radius, v] : [Math.atan2(u, v) / cone, Math.hypot(u, v)], cos = Math.cos(angle), sin = Math.sin(angle);
  const outward = out.map((o, i) => o * cos + around[i] * sin);
  if (half === undefined) return { at: centre.map((c, i) => c + axis[i] * reach + outward[i] * (radius + side * up)), normal: outward.map(o => side * o) };
  const line = axis.map((a, i) => a * Math.cos(half) + outward[i] * cone), normal = outward.map((o, i) => o * Math.cos(half) - axis[i] * cone);
  return { at: centre.map((c, i) => c + line[i] * reach + normal[i] * up), normal };
}

// Parts of a straight piece on a layer, 0 to 1, close enough together in space; the end of the piece is one of them.
function divisions(lie, from, to) {
  if (!lie?.around) return [1];
  const [a, b] = [from, to].map(([u, v]) => placed(lie, u, v, 0).normal), { radius, half } = lie.around;
  // More than half a turn is longer than normals tell.
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
