// The controls around the picture.

const $ = id => document.getElementById(id);
const slider = $("layer"), progress = $("progress"), bars = $("bars");
const PROGRESS_STEPS = 1000;

const metres = mm => mm >= 1000 ? `${(mm / 1000).toFixed(2)} m` : `${mm.toFixed(0)} mm`;
const area = mm2 => mm2 >= 1e5 ? `${(mm2 / 100).toFixed(1)} cm²` : `${mm2.toFixed(1)} mm²`;
function clock(seconds) {
  const s = Math.round(seconds), two = v => String(v).padStart(2, "0");
  return s < 3600 ? `${Math.floor(s / 60)} min ${two(s % 60)} s` : `${Math.floor(s / 3600)} h ${two(Math.floor(s / 60) % 60)} min ${two(s % 60)} s`;
}

function tellLayer() {
  const head = heads[shown.index], layer = shown.layer;
  $("layer-now").textContent = `${shown.index + 1} of ${heads.length} · z ${head.z.toFixed(2)} mm`;
  slider.setAttribute("aria-valuetext", $("layer-now").textContent);
  const numbers = [
    ["Passes", `${head.passes}`], ["Deposited length", metres(head.length)], ["Arc time", clock(head.seconds)],
    ["Travel across", metres(head.travel)], ["Layer height", `${head.height.toFixed(2)} mm`],
    ["Covered / slice area", area(head.planned), ` of ${area(head.slice)} (${head.share.toFixed(1)} %)`],
    ...head.judged ? [["Void", `${head.voids.toFixed(2)} %`], ["Overfill", `${head.overfill.toFixed(2)} %`]] : [],
    ...data.warmth.length ? [["Hottest start", `${head.hottest} °C`], ["Wait for cooling", clock(head.wait)]] : [],
    ["Warnings", head.warnings ? `${head.warnings}` : "none"],
  ];
  $("numbers").replaceChildren(...numbers.map(([name, value, more]) => {
    const item = document.createElement("div");
    item.append(element("dt", name), element("dd", value));
    if (more) item.lastChild.append(element("small", more));
    return item;
  }));
  const list = $("layer-warnings"), more = head.warnings - layer.warnings.length;
  list.hidden = !head.warnings;
  list.replaceChildren(...layer.warnings.map(([x, y, text]) => element("li", `${text} near x ${x.toFixed(1)} y ${y.toFixed(1)} mm`)));
  if (more > 0) list.append(element("li", `and ${more} more`));
  $("key-other").hidden = layer.passes.every(pass => pass.kind < 2);
}

function element(name, text) {
  const node = document.createElement(name);
  node.textContent = text;
  return node;
}

function tellProgress() {
  const { layer } = shown, part = progress.value / PROGRESS_STEPS, whole = part >= 1;
  shown.until = whole ? Infinity : part * layer.seconds;
  const begun = layer.passes.filter(pass => whole || pass.start < shown.until).length;
  $("progress-now").textContent = `pass ${begun} of ${layer.passes.length} · ${clock(part * layer.seconds)}`;
}

// Shows a layer as soon as it is read, unless another was wanted meanwhile.
let wanted = -1;
async function show(index) {
  index = Math.min(Math.max(index, 0), heads.length - 1);
  wanted = index;
  slider.value = index;
  const layer = await layerAt(index);
  if (wanted !== index) return;
  Object.assign(shown, { layer, index });
  tellLayer();
  tellProgress();
  drawBars();
  redraw();
  for (const near of [index + 1, index - 1]) if (near >= 0 && near < heads.length) layerAt(near);
}

const MEASURES = { length: metres, seconds: clock, passes: v => `${v} passes`, share: v => `${v.toFixed(1)} %`, voids: v => `${v.toFixed(2)} %`, overfill: v => `${v.toFixed(2)} %`, hottest: v => `${v} °C`, wait: clock };

function drawBars() {
  const ctx = bars.getContext("2d"), width = bars.clientWidth, height = bars.clientHeight, n = heads.length;
  const ratio = bars.width / width || 1, measure = $("measure").value, step = width / n;
  const most = heads.reduce((m, head) => Math.max(m, head[measure]), 0) || 1;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  const bar = (i, colour) => {
    const gap = step > 3 ? Math.min(step * 0.15, 3) : 0, tall = Math.max(1, (height - 4) * heads[i][measure] / most);
    ctx.fillStyle = colour;
    ctx.fillRect(i * step + gap / 2, height - tall, Math.max(step - gap, 1), tall);
    if (heads[i].warnings) {
      ctx.fillStyle = colours.mark;
      ctx.fillRect(i * step + gap / 2, height - tall - 3, Math.max(step - gap, 1), 2);
    }
  };
  for (let i = 0; i < n; i++) bar(i, colours.travel + "88");
  bar(shown.index, colours.accent);
  if (step < 3) ctx.fillRect(shown.index * step - 1, 0, 3, height);
  $("bars-now").textContent = MEASURES[measure](heads[shown.index][measure]);
}

function resize() {
  const stage = $("stage"), width = stage.clientWidth;
  if (width < 50) return;
  const height = Math.round(Math.max(300, Math.min(width * 0.62, window.innerHeight * 0.72)));
  Object.assign(view, { width, height });
  resizeCanvas(picture, width, height);
  resizeCanvas(bars, bars.clientWidth, 54);
  // The thumb stands below its bar: its way is shorter than the track by one thumb.
  const inset = bars.clientWidth / heads.length / 2 - 8;
  slider.style.marginInline = `${inset}px`;
  if (view.fitted) fit();
  drawBars();
  draw();
}

// Plays a slider until its end; a second press stops it.
function player(button, range, perSecond, changed) {
  let frame = 0;
  const stop = () => { cancelAnimationFrame(frame); frame = 0; button.textContent = "▶"; };
  button.onclick = () => {
    if (frame) return stop();
    const max = Number(range.max);
    let at = Number(range.value) >= max ? 0 : Number(range.value), last = performance.now();
    button.textContent = "❚❚";
    const step = now => {
      at = Math.min(at + (now - last) / 1000 * perSecond(), max);
      last = now;
      const value = Math.floor(at);
      if (value !== Number(range.value)) { range.value = value; changed(); }
      if (at < max) frame = requestAnimationFrame(step); else stop();
    };
    frame = requestAnimationFrame(step);
  };
  range.addEventListener("pointerdown", stop);
}

function followPointers() {
  const down = new Map();
  const middle = () => [...down.values()].reduce((m, p) => [m[0] + p[0] / down.size, m[1] + p[1] / down.size], [0, 0]);
  const spread = () => { const [a, b] = [...down.values()]; return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0; };
  picture.onpointerdown = event => {
    picture.setPointerCapture(event.pointerId);
    down.set(event.pointerId, [event.offsetX, event.offsetY]);
    picture.classList.add("dragging");
  };
  picture.onpointermove = event => {
    const x = (event.offsetX - view.x) / view.scale, y = (view.y - event.offsetY) / view.scale;
    $("place").textContent = `x ${x.toFixed(1)}  y ${y.toFixed(1)} mm`;
    if (!down.has(event.pointerId)) return;
    const [fromX, fromY] = middle(), before = spread();
    down.set(event.pointerId, [event.offsetX, event.offsetY]);
    const [toX, toY] = middle();
    view.x += toX - fromX;
    view.y += toY - fromY;
    view.fitted = false;
    if (before > 0) zoom(spread() / before, toX, toY);
    redraw();
  };
  picture.onpointerup = picture.onpointercancel = event => {
    down.delete(event.pointerId);
    if (!down.size) picture.classList.remove("dragging");
  };
  picture.onpointerleave = () => { $("place").textContent = ""; };
  picture.addEventListener("wheel", event => {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode ? 33 : 1);
    zoom(Math.exp(-Math.max(-400, Math.min(400, pixels)) * 0.0016), event.offsetX, event.offsetY);
    redraw();
  }, { passive: false });
  picture.ondblclick = () => { fit(); redraw(); };
}

function connect() {
  slider.max = heads.length - 1;
  slider.oninput = () => show(Number(slider.value));
  progress.oninput = () => { tellProgress(); redraw(); };
  player($("play-layers"), slider, () => Math.max(5, heads.length / 20), slider.oninput);
  player($("play-progress"), progress, () => PROGRESS_STEPS / 12, progress.oninput);
  for (const name of ["width", "travels", "ends", "outline"]) {
    $(`show-${name}`).onchange = event => { shown[name] = event.target.checked; redraw(); };
  }
  document.querySelectorAll("[name=colour]").forEach(radio => {
    radio.onchange = () => {
      shown.byOrder = radio.value === "order";
      shown.heat = radio.value === "heat";
      shown.warm = radio.value === "warm";
      for (const key of ["kind", "order", "heat", "warm"]) $(`key-${key}`).hidden = radio.value !== key;
      redraw();
    };
  });
  $("fit").onclick = picture.ondblclick;
  const step = factor => () => { zoom(factor, view.width / 2, view.height / 2); redraw(); };
  $("closer").onclick = step(1.4);
  $("farther").onclick = step(1 / 1.4);
  $("measure").onchange = drawBars;
  const barAt = event => Math.min(Math.floor(event.offsetX / bars.clientWidth * heads.length), heads.length - 1);
  bars.onpointerdown = event => { bars.setPointerCapture(event.pointerId); show(barAt(event)); };
  bars.onpointermove = event => { if (event.buttons) show(barAt(event)); };
  document.addEventListener("keydown", event => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!by || event.altKey || event.ctrlKey || event.metaKey || event.target.matches("#progress, select, [type=radio]")) return;
    event.preventDefault();
    show(wanted + by * (event.shiftKey ? 10 : 1));
  });
  window.addEventListener("resize", resize);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); resize(); });
}

function start() {
  if (!heads.length) return void ($("viewer").hidden = true);
  if (data.maps.length) {
    document.querySelectorAll(".judged").forEach(node => { node.hidden = false; });
    drawKey($("heat-ramp"), part => heatAt(FULL_SCALE * part));
  }
  if (data.warmth.length) {
    document.querySelectorAll(".warmed").forEach(node => { node.hidden = false; });
    [$("warm-low").textContent, $("warm-high").textContent] = warmth.map(celsius => `${celsius} °C`);
    drawKey($("warm-ramp"), part => rampAt(part, EMBER));
  }
  readColours();
  connect();
  followPointers();
  resize();
  if (typeof DecompressionStream === "undefined") {
    $("trouble").textContent = "This browser is too old for the picture: Chrome 103, Firefox 113 or Safari 16.4 would do.";
    $("trouble").hidden = false;
    return;
  }
  show((heads.length - 1) >> 1);
}
start();
