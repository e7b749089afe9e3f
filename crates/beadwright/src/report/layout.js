// The layers of the page: the JSON that it contains, when each layer is welded, and the layers read last.

const KEPT = 48;
const $ = id => document.getElementById(id);
const data = JSON.parse($("data").textContent);
const heads = data.layers.map(readHead);
// Arc, wait and the rest of every layer, s: when it begins, how long it lasts, and the time of the whole build.
const total = data.times.reduce((begins, parts, i) => {
  const lasts = parts.reduce((sum, part) => sum + part, 0);
  Object.assign(heads[i], { begins, lasts });
  return begins + lasts;
}, 0);
data.warmth.forEach(({ starts, wait }, i) => Object.assign(heads[i], { hottest: Math.max(0, ...starts), wait }));

// A layer with its temperatures and its place in time.
async function readPlaced(index) {
  const layer = await readLayer(data.layers[index], heads[index]);
  layer.passes.forEach((pass, i) => { pass.celsius = data.warmth[index]?.starts[i]; });
  const { begins, lasts } = heads[index];
  return { ...layer, index, begins, lasts };
}

// Build time at a time with the arc on in a layer, s; the layer's waits and travels are spread over it.
const whenOf = (layer, t) => layer.begins + (layer.seconds > 0 ? t / layer.seconds : 0) * layer.lasts;

const kept = new Map();

// The promise of a layer; the most recent ones are kept.
function layerAt(index) {
  const layer = kept.get(index) ?? readPlaced(index);
  kept.delete(index);
  kept.set(index, layer);
  if (kept.size > KEPT) kept.delete(kept.keys().next().value);
  return layer;
}
