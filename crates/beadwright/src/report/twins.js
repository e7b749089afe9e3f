// Beads of any two strategies in 3-D, side by side: one camera, one slider.

// By their numbers (encode.rs).
const TWIN_KINDS = INKS.kinds;

// The layers of a column with where they begin, and the box around all of them.
function readColumn({ name, layers }) {
  const heads = layers.map(readHead), laid = heads.filter(head => head.points);
  const least = value => laid.reduce((low, head) => Math.min(low, value(head)), Infinity);
  const low = [least(h => h.x), least(h => h.y), least(h => h.z - h.height)];
  const high = [-least(h => -h.x - h.sizeX), -least(h => -h.y - h.sizeY), -least(h => -h.z)];
  return { name, layers, heads, low, high };
}

// One of the two pictures: a choice of the column, a canvas, and what is drawn on it.
function newTwin(grid, columns, chosen, number) {
  const figure = make("figure", grid), choice = make("select", figure);
  choice.setAttribute("aria-label", `Strategy of picture ${number}`);
  for (const [i, { name }] of columns.entries()) make("option", choice, { value: i, textContent: name, selected: i === chosen });
  const canvas = make("canvas", figure, { tabIndex: 0 });
  canvas.setAttribute("aria-label", `Picture ${number} in 3-D: arrows turn both pictures, with shift they move them, plus and minus zoom, F shows all`);
  canvas.setAttribute("role", "application");
  return { canvas, choice, columns, scene: newScene(canvas), pace: newPace(), kinds: new Set(), asked: 0 };
}

// The key to the colours of the kinds in the two pictures; returns a function that brings it up to date.
function newKey(card, twins) {
  const key = make("div", card, { className: "key" });
  const items = TWIN_KINDS.map(([word, colour]) => {
    const item = make("span", key, { hidden: true });
    make("i", item).style.background = `rgb(${colour.join(" ")})`;
    item.append(word);
    return item;
  });
  return () => items.forEach((item, kind) => { item.hidden = !twins.some(({ kinds }) => kinds.has(kind)); });
}

// Reads all layers of the column chosen; a later choice stops it.
async function fillTwin(twin, redraw) {
  const asked = ++twin.asked, { layers, heads } = twin.columns[twin.choice.value];
  Object.assign(twin.pace, { pieces: 0, outside: 0 });
  twin.kinds.clear();
  clearLayers(twin.scene);
  for (const [i, text] of layers.entries()) {
    const layer = await readLayer(text, heads[i]);
    if (asked !== twin.asked) return;
    for (const { kind } of layer.passes) twin.kinds.add(kind);
    const found = strands(layer), { z: top, height } = heads[i];
    twin.pace.pieces += found.count;
    twin.pace.outside += found.outside;
    addLayer(twin.scene, i, found, { top, height, start: 0, pace: 1, seconds: layer.seconds });
    if (i % 24 === 23) redraw();
  }
  redraw();
  twin.canvas.dataset.ready = twin.pace.pieces;
}

function drawTwin(twin, { camera, box, at, count, moving, redraw }) {
  const { canvas, scene, pace } = twin, ratio = window.devicePixelRatio || 1;
  pace.again = pace.drawing;
  if (pace.drawing) return;
  [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight].map(size => Math.round(size * ratio));
  const aspect = canvas.width / canvas.height;
  if (camera.fitted) fitCamera(camera, box, aspect);
  const { right, back } = axesOf(camera), reach = 1.5 * Math.hypot(...box[0].map((v, i) => box[1][i] - v)) + Math.hypot(...camera.target.map((v, i) => v - (box[0][i] + box[1][i]) / 2));
  const much = amount(pace, scene, (at + 1) / count, moving), begun = performance.now();
  const pixels = (box[1][2] - box[0][2]) / count * much.stride * canvas.height / (2 * FIELD * camera.distance);
  const triangles = drawScene(scene, {
    ...much, matrix: matrixOf(camera, aspect, reach), light: [0, 1, 2].map(i => 0.78 * back[i] - 0.38 * right[i] + (i > 1 ? 0.4 : 0)),
    fine: Math.min(Math.max((pixels - 1.5) / 4, 0), 1), lines: [], paper: getComputedStyle(canvas).backgroundColor.match(/\d+/g).slice(0, 3).map(Number), highest: at, until: Infinity, picked: null,
    field: 0, range: [0, 1], ramp: new Float32Array(15), kinds: TWIN_KINDS.flatMap(([, colour]) => colour.map(v => v / 255)),
  });
  timed(pace, scene.gl, triangles, begun, redraw);
}

function showTwins(card) {
  const data = JSON.parse(card.querySelector("script").textContent), columns = data.columns.map(readColumn), count = data.labels.length;
  const grid = make("div", card, { className: "twins" }), chosen = [0, Math.min(1, columns.length - 1)].slice(0, columns.length);
  const twins = chosen.map((column, i) => newTwin(grid, columns, column, i + 1));
  if (!count || twins.some(({ scene }) => !scene)) {
    card.replaceChildren("This browser has no WebGL 2, so there is no 3-D view of the beads; their height fields follow.");
    return;
  }
  const box = [0, 1, 2].reduce(([low, high], i) => [[...low, Math.min(...columns.map(c => c.low[i]))], [...high, Math.max(...columns.map(c => c.high[i]))]], [[], []]);
  const tellKinds = newKey(card, twins), state = { camera: newCamera(), box, at: count - 1, count, moving: 0, redraw: () => redraw() };
  let waiting = 0;
  const redraw = () => { waiting ||= requestAnimationFrame(() => { waiting = 0; tellKinds(); twins.forEach(twin => drawTwin(twin, state)); }); };
  const stir = () => {
    clearTimeout(state.moving);
    state.moving = setTimeout(() => { state.moving = 0; redraw(); }, 250);
    redraw();
  };
  for (const twin of twins) {
    steerCamera(twin.canvas, state.camera, stir);
    twin.choice.onchange = () => fillTwin(twin, redraw);
    fillTwin(twin, redraw);
  }
  slide(card, data.labels, state.at, "Layer of the pictures in 3-D", at => { state.at = at; stir(); });
  make("p", card, { className: "lead", textContent: "Both turn together. Drag: turn · shift or right button: move · wheel: zoom · double click: show all." });
  window.addEventListener("resize", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

document.querySelectorAll(".beads").forEach(showTwins);
