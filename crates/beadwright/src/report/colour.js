// What beads can be coloured by: the value of a piece, the range over the whole part, and its words.

const WHITE = [255, 255, 255], BLACK = [0, 0, 0];
const KINDS = INKS.kinds.map(([name]) => name);
let colours = {};

function readColours() {
  const style = getComputedStyle(document.documentElement);
  const names = ["stage", "slice", "outline", "travel", "contour", "start", "end", "mark", "text", "soft", "accent", "line", "wait", "chosen", "bad"];
  colours = Object.fromEntries(names.map(name => [name, style.getPropertyValue("--" + name).trim()]));
  // In the order of their numbers (encode.rs).
  colours.kinds = INKS.kinds.map(([, colour]) => colour);
}

const channels = hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16));
const rgb = c => `rgb(${c.map(Math.round).join(" ")})`;

const metres = mm => mm >= 1000 ? `${(mm / 1000).toFixed(2)} m` : `${mm.toFixed(0)} mm`;
const area = mm2 => mm2 >= 1e5 ? `${(mm2 / 100).toFixed(1)} cm²` : `${mm2.toFixed(1)} mm²`;
function clock(seconds) {
  const s = Math.round(seconds), two = v => String(v).padStart(2, "0");
  return s < 3600 ? `${Math.floor(s / 60)} min ${two(s % 60)} s` : `${Math.floor(s / 3600)} h ${two(Math.floor(s / 60) % 60)} min ${two(s % 60)} s`;
}

// The coldest and the hottest start of all passes, °C.
const warmth = data.warmth.flatMap(({ starts }) => starts).reduce(([low, high], t) => [Math.min(low, t), Math.max(high, t)], [Infinity, -Infinity]);

// `field` is the number of the value in the shader of scene.js; `flows` says that it changes within a piece.
const CHOICES = {
  kind: { field: 0 },
  order: { field: 1, flows: true, ramp: RAMP, range: [0, 1], of: (pass, i, t, layer) => t / (layer.seconds || 1), text: part => part ? "last" : "first" },
  width: { field: 2, ramp: RAMP, range: data.ranges.width, of: (pass, i) => after(pass, i)[0], text: mm => `${mm.toFixed(2)} mm` },
  speed: { field: 3, ramp: RAMP, range: data.ranges.speed, of: (pass, i) => after(pass, i)[1], text: v => `${v.toFixed(1)} mm/s` },
  time: { field: 4, flows: true, ramp: RAMP, range: [0, total], of: (pass, i, t, layer) => whenOf(layer, t), text: clock },
  warm: { field: 5, ramp: EMBER, range: warmth, of: pass => pass.celsius, text: celsius => `${celsius} °C` },
  heat: { field: 0 },
};

// Position of a value within a range, 0 to 1; the middle if the range is a single value.
const partOf = (value, [low, high]) => high > low ? (value - low) / (high - low) : 0.5;

// The colour of the piece after a point; `t` is its time in the layer, s.
function colourOf(pass, i, t, layer) {
  const choice = CHOICES[shown.by], value = choice.of?.(pass, i, t, layer);
  return value === undefined ? colours.kinds[pass.kind] : rampAt(partOf(value, choice.range), choice.ramp);
}

function showKey() {
  const { ramp, range, text } = CHOICES[shown.by];
  $("key-kind").hidden = Boolean(ramp) || shown.by === "heat";
  $("key-heat").hidden = shown.by !== "heat";
  $("key-ramp").hidden = !ramp;
  if (!ramp) return;
  [$("ramp-low").textContent, $("ramp-high").textContent] = range.map(text);
  drawKey($("ramp"), part => rampAt(part, ramp));
}
