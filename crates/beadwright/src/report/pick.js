// A pass that is pointed out: which one lies below the pointer, and what there is to say about it.

// The pass of the layer shown at a place, mm, and the time there; null beside all beads.
function pickLayer(x, y) {
  const { layer, index } = shown;
  let best = null, least = Infinity;
  layer?.passes.forEach((pass, number) => {
    if (pass.start > shown.until) return;
    const { xy } = pass;
    for (let i = 0; i + 3 < xy.length; i += 2) {
      if (isJump(pass, i / 2)) continue;
      const [dx, dy, px, py] = [xy[i + 2] - xy[i], xy[i + 3] - xy[i + 1], x - xy[i], y - xy[i + 1]];
      const length = dx * dx + dy * dy, part = length > 0 ? Math.min(Math.max((px * dx + py * dy) / length, 0), 1) : 0;
      const away = Math.hypot(px - part * dx, py - part * dy), reach = Math.max(after(pass, i / 2)[0] / 2, 4 / view.scale);
      if (away > reach || away >= least) continue;
      least = away;
      const [from, to] = [pass.times[i / 2], pass.times[i / 2 + 1]];
      best = { layer: index, pass: number, seconds: from + part * (to - from) };
    }
  });
  return best;
}

// Kind, width, speed, time and temperature of a pass at a time in its layer, s.
function sentenceOf(layer, index, number, seconds) {
  const pass = layer.passes[number], { times } = pass;
  let i = times.findIndex(t => t > seconds) - 1;
  if (i < 0) i = Math.max(times.length - 2, 0);
  const [width, speed] = after(pass, i);
  return [
    `Layer ${index + 1}, pass ${number + 1} of ${layer.passes.length}`, KINDS[pass.kind] ?? "bead", `${width.toFixed(2)} mm wide`, `${speed.toFixed(1)} mm/s`,
    `${metres(lengthOf(pass))} long`, `after ${clock(whenOf(layer, seconds))}`, ...pass.celsius === undefined ? [] : [`begins on ${pass.celsius} °C`],
  ];
}

// Whether a piece is no bead but the jump to the next turn of a helix.
const isJump = (pass, i) => after(pass, i)[0] <= 0.001;

function lengthOf(pass) {
  const { xy } = pass;
  let sum = 0;
  for (let i = 2; i < xy.length; i += 2) if (!isJump(pass, i / 2 - 1)) sum += Math.hypot(xy[i] - xy[i - 2], xy[i + 1] - xy[i - 1]);
  return sum;
}

// Points a pass out in both pictures, with its figures beside the pointer; nothing if there is none.
async function pointOut(found, x, y) {
  const tip = $("tip"), before = shown.picked;
  shown.picked = found;
  if (before?.layer !== found?.layer || before?.pass !== found?.pass) redraw();
  tip.hidden = !found;
  if (!found) return;
  const layer = await layerAt(found.layer);
  if (shown.picked !== found || !layer.passes[found.pass]) return;
  const [first, ...rest] = sentenceOf(layer, found.layer, found.pass, found.seconds);
  tip.replaceChildren(element("b", first), element("span", rest.join(" · ")));
  const { width, height } = tip.getBoundingClientRect();
  tip.style.left = `${Math.max(Math.min(x + 14, innerWidth - width - 8), 8)}px`;
  tip.style.top = `${y + 18 + height < innerHeight ? y + 18 : Math.max(y - height - 12, 8)}px`;
}

// The pass before or after the one pointed out, for the keyboard.
function pointOutNext(by) {
  const { layer, index, picked } = shown, count = layer?.passes.length;
  if (!count) return;
  const now = picked?.layer === index ? picked.pass : by > 0 ? -1 : 0;
  pointOutPass((now + by + count) % count);
}

// A pass of the layer shown, by its number.
function pointOutPass(number) {
  const { layer, index } = shown, { left, top } = $("stages").getBoundingClientRect();
  if (layer.passes[number]) pointOut({ layer: index, pass: number, seconds: layer.passes[number].start }, left, Math.max(top, 0));
}

// The layer of a finding, its place closer and its pass pointed out, as far as they are known.
async function goTo({ layer, x, y, pass }) {
  if (x === undefined) showAll(); else closeUp(layer, x, y);
  $("viewer").scrollIntoView({ block: "start" });
  await show(layer);
  if (pass !== undefined && shown.index === layer) pointOutPass(pass);
}

// All of the part in both pictures, and no place marked.
function showAll() {
  shown.mark = null;
  space.camera.fitted = true;
  fit();
}

// Both pictures close to a place, which is marked.
function closeUp(layer, x, y) {
  shown.mark = { layer, x, y };
  const room = 16 * data.bead.width;
  view.scale = Math.min(view.width, view.height) / room;
  view.x = view.width / 2 - view.scale * x;
  view.y = view.height / 2 + view.scale * y;
  view.fitted = false;
  Object.assign(space.camera, { target: inSpace(layer, x, y, heads[layer].height / 2), distance: 2.5 * room, fitted: false });
}
