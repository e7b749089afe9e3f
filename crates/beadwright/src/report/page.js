// The controls around the picture.

const slider = $("layer"), progress = $("progress"), bars = $("bars");
const PROGRESS_STEPS = 1000;

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
    item.title = hintOf(name);
    if (more) item.lastChild.append(element("small", more));
    return item;
  }));
  const list = $("layer-warnings"), more = head.warnings - layer.warnings.length;
  list.hidden = !head.warnings;
  list.replaceChildren(...layer.warnings.map(([x, y, text]) => {
    const item = element("li", `${text} near x ${x.toFixed(1)} y ${y.toFixed(1)} mm`), button = element("button", "Show");
    button.onclick = () => goTo({ layer: shown.index, x, y });
    item.append(button);
    return item;
  }));
  if (more > 0) list.append(element("li", `and ${more} more`));
}

// What the glossary of the page says of a word.
const hintOf = name => document.querySelector(`[data-word="${name.toLowerCase()}"]`)?.textContent ?? "";

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
  const lower = shown.below && index && data.stacked ? await layerAt(index - 1) : null;
  if (wanted !== index) return;
  Object.assign(shown, { layer, index, lower });
  tellLayer();
  tellProgress();
  drawBars();
  drawTimeline();
  stirSolid();
}

const MEASURES = { length: metres, seconds: clock, passes: v => `${v} passes`, share: v => `${v.toFixed(1)} %`, voids: v => `${v.toFixed(2)} %`, overfill: v => `${v.toFixed(2)} %`, hottest: v => `${v} °C`, wait: clock };

function drawBars() {
  const ctx = bars.getContext("2d"), width = bars.clientWidth, height = bars.clientHeight, n = heads.length;
  const ratio = bars.width / width || 1, measure = $("measure").value, step = width / n, limit = data.limits[measure];
  const most = heads.reduce((m, head) => Math.max(m, head[measure]), limit ?? 0) || 1, tallOf = value => (height - 4) * value / most;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  const bar = (i, colour) => {
    const gap = step > 3 ? Math.min(step * 0.15, 3) : 0, tall = Math.max(1, tallOf(heads[i][measure]));
    ctx.fillStyle = colour;
    ctx.fillRect(i * step + gap / 2, height - tall, Math.max(step - gap, 1), tall);
    if (heads[i].warnings) {
      ctx.fillStyle = colours.mark;
      ctx.fillRect(i * step + gap / 2, height - tall - 3, Math.max(step - gap, 1), 2);
    }
  };
  const above = heads.filter(head => head[measure] > limit).length;
  for (let i = 0; i < n; i++) bar(i, (heads[i][measure] > limit ? colours.bad : colours.travel) + "88");
  bar(shown.index, colours.accent);
  if (step < 3) ctx.fillRect(shown.index * step - 1, 0, 3, height);
  const told = MEASURES[measure], bound = limit === undefined ? "" : told(limit);
  if (bound) {
    ctx.strokeStyle = colours.bad;
    ctx.lineWidth = 1.5;
    ctx.setLineDash([6, 4]);
    ctx.strokeRect(-2, height - tallOf(limit), width + 4, height + 4);
    ctx.setLineDash([]);
  }
  $("bars-now").textContent = told(heads[shown.index][measure]) + (bound && ` · limit ${bound}`);
  const words = `${$("measure").selectedOptions[0].textContent} of every layer as a bar`;
  bars.setAttribute("aria-label", words + (bound && `; ${above} of ${n} above the limit of ${bound}`));
}

function resize() {
  const both = $("stages").dataset.view === "both", width = Math.max($("stage").clientWidth, $("stage-solid").clientWidth);
  if (width < 50) return;
  const height = Math.round(Math.max(300, Math.min(width * (both ? 0.85 : 0.62), window.innerHeight - 350)));
  Object.assign(view, { width, height });
  for (const canvas of [picture, solid]) resizeCanvas(canvas, width, height);
  resizeCanvas(bars, bars.clientWidth, 54);
  resizeCanvas(timeline, timeline.clientWidth, 54);
  // The thumb sits below its bar: it travels the length of the track less one thumb.
  const inset = bars.clientWidth / heads.length / 2 - 8;
  slider.style.marginInline = `${inset}px`;
  if (view.fitted) fit();
  drawBars();
  drawTimeline();
  draw();
  drawSolid();
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
    pointOut(null);
    picture.setPointerCapture(event.pointerId);
    down.set(event.pointerId, [event.offsetX, event.offsetY]);
    picture.classList.add("dragging");
  };
  picture.onpointermove = event => {
    const x = (event.offsetX - view.x) / view.scale, y = (view.y - event.offsetY) / view.scale;
    $("place").textContent = `x ${x.toFixed(1)}  y ${y.toFixed(1)} mm`;
    if (!down.has(event.pointerId)) return pointOut(pickLayer(x, y), event.clientX, event.clientY);
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
  picture.onpointerleave = () => { $("place").textContent = ""; pointOut(null); };
  picture.addEventListener("wheel", event => {
    event.preventDefault();
    zoom(wheelFactor(event), event.offsetX, event.offsetY);
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
  $("show-below").onchange = event => { shown.below = event.target.checked; show(shown.index); };
  document.querySelectorAll("[name=colour]").forEach(radio => {
    radio.onchange = () => { shown.by = radio.value; showKey(); redraw(); };
  });
  $("range-low").onchange = $("range-high").onchange = setRange;
  $("range-reset").onclick = resetRange;
  document.querySelectorAll("[name=view]").forEach(radio => {
    radio.onchange = () => { $("stages").dataset.view = radio.value; resize(); };
  });
  document.querySelectorAll("[data-layer]").forEach(button => {
    const place = Object.fromEntries(Object.entries(button.dataset).map(([name, value]) => [name, Number(value)]));
    button.onclick = () => goTo(place);
  });
  $("fit").onclick = picture.ondblclick;
  $("solid-fit").onclick = solid.ondblclick;
  $("solid-closer").onclick = () => zoomSolid(1.4);
  $("solid-farther").onclick = () => zoomSolid(1 / 1.4);
  const step = factor => () => { zoom(factor, view.width / 2, view.height / 2); redraw(); };
  $("closer").onclick = step(1.4);
  $("farther").onclick = step(1 / 1.4);
  $("measure").onchange = drawBars;
  const barAt = event => Math.min(Math.floor(event.offsetX / bars.clientWidth * heads.length), heads.length - 1);
  bars.onpointerdown = event => { bars.setPointerCapture(event.pointerId); show(barAt(event)); };
  bars.onpointermove = event => { if (event.buttons) show(barAt(event)); };
  document.addEventListener("keydown", steer);
  window.addEventListener("resize", resize);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { readColours(); resize(); });
}

// Keys for the whole page: layers, and passes one after another.
function steer(event) {
  if (event.defaultPrevented || event.altKey || event.ctrlKey || event.metaKey || event.target.matches("#progress, select, [type=radio], [type=number]")) return;
  const { key } = event, layers = { ArrowLeft: -1, ArrowRight: 1, PageDown: -1, PageUp: 1 }[key], passes = { "[": -1, "]": 1 }[key];
  if (key.startsWith("Page") && event.target !== solid && event.target !== picture) return;
  if (layers) show(wanted + layers * (event.shiftKey ? 10 : 1));
  else if (passes) pointOutNext(passes);
  else if (key === "Escape") pointOut(null);
  else return;
  event.preventDefault();
}

// On a small screen there is room for one picture at a time.
function chooseView() {
  const value = innerWidth < 900 ? "solid" : "both";
  $("stages").dataset.view = value;
  document.querySelector(`[name=view][value=${value}]`).checked = true;
}

// What was not computed cannot be chosen.
function offer(name, there) {
  document.querySelectorAll(`.${name}`).forEach(node => { node.hidden = !there; });
}

async function start() {
  if (!heads.length) return void ($("viewer").hidden = $("clock").hidden = true);
  offer("judged", data.maps.length > 0);
  offer("stacked", data.stacked && heads.length > 1);
  offer("warmed", data.warmth.length > 0);
  if (data.maps.length) drawKey($("heat-ramp"), part => heatAt(FULL_SCALE * part));
  readColours();
  chooseView();
  startTimeline();
  const deep = startSolid();
  connect();
  followPointers();
  resize();
  if (typeof DecompressionStream === "undefined") {
    $("trouble").textContent = "This browser is too old for the pictures: Chrome 103, Firefox 113 or Safari 16.4 would do.";
    $("trouble").hidden = false;
    return;
  }
  if (!deep) withoutSolid("This browser has no WebGL 2, so there is no 3-D view; every layer is shown from above.");
  // The page opens at the place for which the program should not be started.
  const worst = document.querySelector(".refused button")?.dataset;
  if (worst) {
    shown.below = $("show-below").checked = true;
    closeUp(Number(worst.layer), Number(worst.x), Number(worst.y));
  }
  await show(worst ? Number(worst.layer) : heads.findLastIndex(head => head.passes));
  if (deep) readSolid();
}
start();
