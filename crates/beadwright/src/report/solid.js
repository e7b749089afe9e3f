// The part in 3-D: reading its layers into scene.js bit by bit, what is drawn, pointers and keys.

const solid = $("solid");
// How long a picture may take is in pace.js.
const space = { ...newPace(), scene: null, camera: newCamera(), matrix: null, moving: 0, hurried: false };
const QUICK = 12, BATCH = 16, COARSE = 0.5;

const solidShown = () => space.scene && $("stages").dataset.view !== "layer";

// How a layer lies in space; nothing where all are level.
const lieOf = index => data.lies[index];

// A place on a layer in space, `up` mm above its middle.
const inSpace = (index, x, y, up) => lieOf(index) ? placed(lieOf(index), x, y, up).at : [x, y, heads[index].z - heads[index].height / 2 + up];

const boxInSpace = data.lies.length ? boxOf(heads, data.lies) : null;

// The part, from its lowest to its highest corner, mm.
function solidBox() {
  if (boxInSpace) return boxInSpace;
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
    // A timer, since pages in the background get no frames.
    await new Promise(done => setTimeout(done));
    drawn = performance.now();
  }
  solid.dataset.ready = space.pieces;
}

function addSolid(index, layer) {
  const { z: top, height } = heads[index], { begins: start, lasts, seconds } = layer, found = strands(layer, lieOf(index));
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
  const { height } = heads[shown.index], passes = shown.layer.passes.filter(pass => pass.xy.length && pass.start <= shown.until), moves = [];
  passes.slice(1).forEach((pass, i) => {
    const from = [passes[i].xy.at(-2), passes[i].xy.at(-1)], to = [pass.xy[0], pass.xy[1]];
    const place = t => inSpace(shown.index, from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]), 0.8 * height);
    let before = 0;
    for (const t of divisions(lieOf(shown.index), from, to)) { moves.push(...place(before), ...place(t)); before = t; }
  });
  return [...lines, { points: moves, colour: channels(colours.text) }];
}

// What scene.js has to know.
function lookNow(much) {
  const { camera } = space, [low, high] = solidBox(), { right, back } = axesOf(camera), choice = CHOICES[shown.by];
  const reach = 1.5 * Math.hypot(...low.map((v, i) => high[i] - v)) + Math.hypot(...camera.target.map((v, i) => v - (low[i] + high[i]) / 2));
  const light = [0, 1, 2].map(i => 0.78 * back[i] - 0.38 * right[i] + (i > 1 ? 0.4 : 0));
  const pixels = (boxInSpace ? heads[shown.index].height : (high[2] - low[2]) / heads.length) * much.stride * solid.height / (2 * FIELD * camera.distance);
  space.matrix = matrixOf(camera, solid.width / solid.height, reach);
  return {
    ...much, matrix: space.matrix, light, fine: Math.min(Math.max((pixels - 1.5) / 4, 0), 1), lines: solidLines(), paper: channels(colours.stage), highest: shown.index, until: shown.until, picked: shown.picked,
    field: choice.field, range: choice.range ?? [0, 1], ramp: (choice.ramp ?? RAMP).flat().map(v => v / 255), kinds: colours.kinds.flat().map(v => v / 255),
  };
}

// Fewer pixels while something moves, where the CPU draws both pictures: most of its time goes into them.
function sharpen(canvas) {
  const ratio = (window.devicePixelRatio || 1) * (hurried() && solidShown() ? COARSE : 1);
  const [width, height] = [view.width, view.height].map(size => Math.round(size * ratio));
  if (width && (canvas.width !== width || canvas.height !== height)) Object.assign(canvas, { width, height });
}

function drawSolid() {
  if (!solidShown() || !colours.kinds || !solid.width) return;
  space.again = space.drawing;
  if (space.drawing) return;
  sharpen(solid);
  if (space.camera.fitted) fitSolid();
  const much = amount(space, space.scene, (shown.index + 1) / heads.length, space.moving > 0), begun = performance.now();
  timed(space, space.scene.gl, drawScene(space.scene, lookNow(much)), begun, redraw);
  placeMark();
}

// Draws while something moves, coarsely if need be, and once more when it rests.
function stirSolid() {
  if (!space.moving) space.hurried = space.rate > 1e-4;
  clearTimeout(space.moving);
  space.moving = setTimeout(() => {
    space.moving = 0;
    redraw();
    for (const near of [shown.index + 1, shown.index - 1]) if (heads[near]) layerAt(near);
  }, 250);
  redraw();
}

// Whether something moves where the CPU draws: then the layer is drawn plainly, too.
const hurried = () => space.moving && space.hurried;

function placeMark() {
  const { mark } = shown, at = mark && projected(space.matrix, inSpace(mark.layer, mark.x, mark.y, heads[mark.layer].height / 2), solid.clientWidth, solid.clientHeight);
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
  let resting = 0;
  steerCamera(solid, space.camera, stirSolid, {
    begin: () => pointOut(null),
    hover({ offsetX, offsetY, clientX, clientY }) {
      clearTimeout(resting);
      if (space.pieces * space.rate < QUICK) resting = setTimeout(() => pointOut(pickSolid(offsetX, offsetY), clientX, clientY), 50);
    },
    press(event) {
      const found = pickSolid(event.offsetX, event.offsetY);
      pointOut(found, event.clientX, event.clientY);
      if (found && found.layer !== shown.index) show(found.layer);
    },
  });
  solid.onpointerleave = () => { clearTimeout(resting); pointOut(null); };
}

// False where the browser has no WebGL 2.
function startSolid() {
  space.scene = newScene(solid, data.lies.length > 0);
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
