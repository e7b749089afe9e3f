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

// `field` is the number of the value in the shader of scene.js; `flows` says that it changes within a piece. The ends of the colours are
// words, or numbers with a unit of `per`, which can be changed; `whole` is then the range before.
const CHOICES = {
  kind: { field: 0 },
  order: { field: 1, flows: true, ramp: RAMP, range: [0, 1], of: (pass, i, t, layer) => t / (layer.seconds || 1), words: ["first", "last"] },
  width: { field: 2, ramp: RAMP, range: data.ranges.width, of: (pass, i) => after(pass, i)[0], unit: "mm", digits: 2 },
  speed: { field: 3, ramp: RAMP, range: data.ranges.speed, of: (pass, i) => after(pass, i)[1], unit: "mm/s", digits: 1 },
  time: { field: 4, flows: true, ramp: RAMP, range: [0, total], of: (pass, i, t, layer) => whenOf(layer, t), unit: "min", digits: 1, per: 60 },
  warm: { field: 5, ramp: EMBER, range: warmth, of: pass => pass.celsius, unit: "°C", digits: 0 },
  heat: { field: 0 },
};

// The colour of the piece after a point; `t` is its time in the layer, s.
function colourOf(pass, i, t, layer) {
  const choice = CHOICES[shown.by], value = choice.of?.(pass, i, t, layer);
  return value === undefined ? colours.kinds[pass.kind] : rampAt(partOf(value, choice.range), choice.ramp);
}

function showKey() {
  const { ramp, range, words, unit, digits, per = 1, whole } = CHOICES[shown.by];
  $("key-kind").hidden = Boolean(ramp) || shown.by === "heat";
  $("key-heat").hidden = shown.by !== "heat";
  $("key-ramp").hidden = !ramp;
  if (!ramp) return;
  const texts = range.map(value => (value / per).toFixed(digits)), same = !words && range[0] === range[1] && !whole;
  [$("ramp-low").textContent, $("ramp-high").textContent] = words ?? (same ? ["", `${texts[0]} ${unit}`] : ["", unit]);
  for (const [i, field] of [$("range-low"), $("range-high")].entries()) {
    field.hidden = Boolean(words) || same;
    Object.assign(field, { value: texts[i], step: 10 ** -digits });
  }
  $("ramp").hidden = same;
  $("range-reset").hidden = !whole;
  drawKey($("ramp"), part => rampAt(part, ramp));
}

// Gives the colours the range of their fields.
function setRange() {
  const choice = CHOICES[shown.by], range = typedRange([$("range-low"), $("range-high")], choice.range, choice.digits, choice.per);
  if (range) {
    choice.whole ??= choice.range;
    choice.range = range;
  }
  showKey();
  redraw();
}

function resetRange() {
  const choice = CHOICES[shown.by];
  choice.range = choice.whole;
  delete choice.whole;
  showKey();
  redraw();
}
