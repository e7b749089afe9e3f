// The part in 3-D: reading its layers into scene.js bit by bit, what is drawn, pointers and keys.

const solid = $("solid");
// `pieces` of beads, of these `outside` along outlines; `rate` is the time of a triangle, ms, as it was measured last.
const space = { scene: null, camera: newCamera(), matrix: null, pieces: 0, outside: 0, rate: 1e-4, moving: 0, drawing: false, again: false };
// How long a picture may take while something moves, and at rest, ms.
const QUICK = 12, MOVING = 25, RESTING = 1200, PRETTY = 300, BATCH = 16;

const solidShown = () => space.scene && $("stages").dataset.view !== "layer";

// The part, from its lowest to its highest corner, mm.
function solidBox() {
  const room = data.bead.width / 2, { left, right, low, high } = partBox, laid = heads.filter(head => head.points);
  const bottom = laid.reduce((z, head) => Math.min(z, head.z - head.height), Infinity);
  return [[left - room, low - room, bottom], [right + room, high + room, laid.reduce((z, head) => Math.max(z, head.z), bottom)]];
}

function fitSolid() {
  fitCamera(space.camera, solidBox(), solid.width / solid.height);
}

// All layers one after another, with a picture now and then.
async function readSolid() {
  let drawn = performance.now();
  for (let first = 0; first < heads.length; first += BATCH) {
    const count = Math.min(BATCH, heads.length - first);
    const layers = await Promise.all(Array.from({ length: count }, (_, k) => readPlaced(first + k)));
    layers.forEach((layer, k) => addSolid(first + k, layer));
    if (performance.now() - drawn < 150 && first + count < heads.length) continue;
    noteSolid(first + count < heads.length ? `Reading layer ${first + count} of ${heads.length}` : "");
    stirSolid();
    // A timer, not a frame: pages in the background have none.
    await new Promise(done => setTimeout(done));
    drawn = performance.now();
  }
  solid.dataset.ready = space.pieces;
}

function addSolid(index, layer) {
  const { z: top, height } = heads[index], { begins: start, lasts, seconds } = layer, found = strands(layer);
  space.pieces += found.count;
  space.outside += found.outside;
  addLayer(space.scene, index, found, { top, height, start, seconds, pace: seconds > 0 ? lasts / seconds : 0 });
}

function noteSolid(text) {
  const [low, high] = solidBox(), size = low.map((v, i) => (high[i] - v).toFixed(0)).join(" × ");
  $("solid-note").textContent = text || `${size} mm · grid ${gridStep()} mm`;
}

const gridStep = () => {
  const [low, high] = solidBox(), size = Math.max(high[0] - low[0], high[1] - low[1]);
  return [1, 2, 5, 10, 20, 50, 100, 200, 500].find(step => size / step < 14) ?? 1000;
};

// The plate below the part, and the moves without arc of the layer shown.
function solidLines() {
  const [low, high] = solidBox(), step = gridStep(), grid = [], [x0, y0, x1, y1] =
    [low[0], low[1], high[0], high[1]].map((v, i) => (i < 2 ? Math.floor(v / step - 0.5) : Math.ceil(v / step + 0.5)) * step);
  for (let x = x0; x <= x1 + step / 2; x += step) grid.push(x, y0, low[2], x, y1, low[2]);
  for (let y = y0; y <= y1 + step / 2; y += step) grid.push(x0, y, low[2], x1, y, low[2]);
  const lines = [{ points: grid, colour: channels(colours.line) }];
  if (!shown.travels || !shown.layer) return lines;
  const { z, height } = heads[shown.index], passes = shown.layer.passes.filter(pass => pass.xy.length && pass.start <= shown.until), moves = [];
  passes.slice(1).forEach((pass, i) => {
    const from = passes[i].xy;
    moves.push(from.at(-2), from.at(-1), z + 0.3 * height, pass.xy[0], pass.xy[1], z + 0.3 * height);
  });
  return [...lines, { points: moves, colour: channels(colours.text) }];
}

// How much of the part is drawn, so that a picture takes no longer than it may: all, as little as has to be, or one
// layer for several.
function amount(moving) {
  const { scene, pieces, outside, rate } = space, share = (shown.index + 1) / heads.length;
  const cost = (count, mesh) => count * share * scene.meshes[mesh].faces.length / 3 * rate, most = moving ? MOVING : RESTING;
  if (cost(pieces, 0) < Math.min(most, PRETTY)) return { mesh: 0, stride: 1, outside: false };
  if (cost(pieces, 1) < most) return { mesh: 1, stride: 1, outside: false };
  return { mesh: 2, stride: Math.min(Math.ceil(cost(outside, 2) / most), 24), outside: true };
}

// What scene.js has to know.
function lookNow(much) {
  const { camera } = space, [low, high] = solidBox(), { right, back } = axesOf(camera), choice = CHOICES[shown.by];
  const reach = 1.5 * Math.hypot(...low.map((v, i) => high[i] - v)) + Math.hypot(...camera.target.map((v, i) => v - (low[i] + high[i]) / 2));
  const light = [0, 1, 2].map(i => 0.78 * back[i] - 0.38 * right[i] + (i > 1 ? 0.4 : 0));
  const pixels = (high[2] - low[2]) / heads.length * much.stride * solid.height / (2 * FIELD * camera.distance);
  space.matrix = matrixOf(camera, solid.width / solid.height, reach);
  return {
    ...much, matrix: space.matrix, light, fine: Math.min(Math.max((pixels - 1.5) / 4, 0), 1), lines: solidLines(), paper: channels(colours.stage), highest: shown.index, until: shown.until, picked: shown.picked,
    field: choice.field, range: choice.range ?? [0, 1], ramp: (choice.ramp ?? RAMP).flat().map(v => v / 255), kinds: colours.kinds.flat().map(v => v / 255),
  };
}

function drawSolid() {
  if (!solidShown() || !colours.kinds || !solid.width) return;
  space.again = space.drawing;
  if (space.drawing) return;
  if (space.camera.fitted) fitSolid();
  const look = lookNow(amount(space.moving > 0)), drawn = drawScene(space.scene, look);
  timeSolid(space.scene.gl, drawn, performance.now());
  placeMark();
}

// How long the picture takes, without waiting for it; the next one comes when it is done.
function timeSolid(gl, triangles, begun) {
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  space.drawing = true;
  const look = () => {
    if (gl.clientWaitSync(fence, gl.SYNC_FLUSH_COMMANDS_BIT, 0) === gl.TIMEOUT_EXPIRED) return setTimeout(look, 3);
    gl.deleteSync(fence);
    space.drawing = false;
    // Few triangles tell nothing of their rate.
    if (triangles > 20000) space.rate = (performance.now() - begun) / triangles;
    if (space.again) redraw();
  };
  look();
}

// Draws while something moves, coarsely if need be, and once more when it rests.
function stirSolid() {
  clearTimeout(space.moving);
  space.moving = setTimeout(() => { space.moving = 0; redraw(); }, 250);
  redraw();
}

function placeMark() {
  const { mark } = shown, at = mark && projected(space.matrix, [mark.x, mark.y, heads[mark.layer].z], solid.clientWidth, solid.clientHeight);
  $("solid-mark").hidden = !at;
  if (at) $("solid-mark").style.transform = `translate(${at[0]}px, ${at[1]}px)`;
}

// What lies below a place of the canvas, px.
function pickSolid(x, y) {
  const { clientWidth: width, clientHeight: height } = solid;
  return pickScene(space.scene, lookNow({ mesh: 1, stride: 1, outside: false }), 2 * x / width - 1, 1 - 2 * y / height);
}

function zoomSolid(factor, x = 0, y = 0) {
  zoomCamera(space.camera, factor, x, y, solid.width / solid.height);
  stirSolid();
}

function followSolid() {
  const down = new Map();
  let moved = 0, resting = 0;
  const at = event => [event.offsetX / solid.clientWidth * 2 - 1, 1 - event.offsetY / solid.clientHeight * 2];
  const middle = () => [...down.values()].reduce((m, p) => [m[0] + p[0] / down.size, m[1] + p[1] / down.size], [0, 0]);
  const spread = () => { const [a, b] = [...down.values()]; return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0; };
  const hover = event => {
    clearTimeout(resting);
    const { offsetX, offsetY, clientX, clientY } = event;
    if (space.pieces * space.rate < QUICK) resting = setTimeout(() => pointOut(pickSolid(offsetX, offsetY), clientX, clientY), 50);
  };
  solid.onpointerdown = event => {
    solid.setPointerCapture(event.pointerId);
    down.set(event.pointerId, [event.offsetX, event.offsetY]);
    moved = 0;
    pointOut(null);
  };
  solid.onpointermove = event => {
    if (!down.has(event.pointerId)) return hover(event);
    const [fromX, fromY] = middle(), before = spread();
    down.set(event.pointerId, [event.offsetX, event.offsetY]);
    const [toX, toY] = middle(), height = solid.clientHeight, [x, y] = [toX - fromX, toY - fromY];
    moved += Math.abs(x) + Math.abs(y);
    if (down.size > 1 || event.shiftKey || event.buttons > 1) panCamera(space.camera, x / height, y / height);
    else turnCamera(space.camera, -x * 0.008, y * 0.008);
    if (before > 0) zoomSolid(spread() / before, ...at(event));
    stirSolid();
  };
  solid.onpointerup = event => {
    down.delete(event.pointerId);
    if (moved > 4 || event.button > 0) return;
    const found = pickSolid(event.offsetX, event.offsetY);
    pointOut(found, event.clientX, event.clientY);
    if (found && found.layer !== shown.index) show(found.layer);
  };
  solid.onpointercancel = event => down.delete(event.pointerId);
  solid.onpointerleave = () => { clearTimeout(resting); pointOut(null); };
  solid.oncontextmenu = event => event.preventDefault();
  solid.addEventListener("wheel", event => {
    event.preventDefault();
    zoomSolid(wheelFactor(event), ...at(event));
  }, { passive: false });
  solid.ondblclick = () => { space.camera.fitted = true; stirSolid(); };
  solid.onkeydown = steerSolid;
}

const SIDES = { 7: [0, 1.55], 1: [0, 0], 3: [Math.PI / 2, 0], 0: [-0.6, 0.55] };

function steerSolid(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const { key, shiftKey } = event, way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
  if (way && shiftKey) panCamera(space.camera, way[0] * 0.08, way[1] * 0.08);
  else if (way) turnCamera(space.camera, way[0] * 0.15, -way[1] * 0.15);
  else if (key === "+" || key === "=") zoomSolid(1.25);
  else if (key === "-") zoomSolid(0.8);
  else if (key === "f") space.camera.fitted = true;
  else if (SIDES[key]) Object.assign(space.camera, { yaw: SIDES[key][0], pitch: SIDES[key][1], fitted: true });
  else return;
  event.preventDefault();
  stirSolid();
}

// False where the browser has no WebGL 2.
function startSolid() {
  space.scene = newScene(solid);
  if (!space.scene) return false;
  solid.addEventListener("webglcontextlost", () => { space.scene = null; withoutSolid("The graphics card gave up on the 3-D view. Load the page again to see it."); });
  noteSolid("");
  followSolid();
  return true;
}

function withoutSolid(text) {
  $("no-solid").textContent = text;
  $("no-solid").hidden = false;
  $("views").hidden = true;
  $("stages").dataset.view = "layer";
  resize();
}
