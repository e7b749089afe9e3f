// Height fields side by side.

function make(name, parent, properties = {}) {
  const node = Object.assign(document.createElement(name), properties);
  parent.append(node);
  return node;
}

async function paint(canvas, text, palette) {
  const size = canvas.clientWidth, ratio = window.devicePixelRatio || 1, map = await readMap(text, palette);
  canvas.width = canvas.height = Math.round(size * ratio);
  if (!map) return;
  const scale = 0.94 * canvas.width / Math.max(map.width, map.height), ctx = canvas.getContext("2d");
  ctx.setTransform(scale, 0, 0, -scale, canvas.width / 2 - scale * (map.x + map.width / 2), canvas.height / 2 + scale * (map.y + map.height / 2));
  drawMap(ctx, map, scale / ratio);
}

// A slider with a label for each of its places; nothing where there is but one.
function slide(parent, labels, first, name, changed) {
  if (labels.length < 2) return;
  const row = make("div", parent, { className: "slide" });
  const slider = make("input", row, { type: "range", min: 0, max: labels.length - 1, value: first });
  const label = make("span", row);
  const announce = () => slider.setAttribute("aria-valuetext", label.textContent = labels[slider.value]);
  slider.setAttribute("aria-label", name);
  slider.oninput = () => { announce(); changed(Number(slider.value)); };
  announce();
}

// Adds a hint to what is wider than the window.
function hintAtWide(card) {
  const hint = make("p", card, { className: "aside", textContent: "More to the right: scroll sideways →" });
  card.before(hint);
  card.tabIndex = 0;
  const look = () => { hint.hidden = card.scrollWidth <= card.clientWidth + 1; };
  look();
  window.addEventListener("resize", look);
}

function showMaps(card) {
  const data = JSON.parse(card.querySelector("script").textContent);
  // In mm, or in bead heights.
  const whole = data.span ?? [0, FULL_SCALE], digits = 2;
  let range = whole;
  const key = make("div", card, { className: "key" });
  const field = word => {
    const input = make("input", key, { type: "number", step: 10 ** -digits });
    input.setAttribute("aria-label", `${word} value of the colours`);
    return input;
  };
  const low = field("Lowest"), ramp = make("canvas", key, { width: 160, height: 12 }), high = field("Highest"), ends = [low, high];
  ramp.setAttribute("aria-hidden", "true");
  drawKey(ramp, part => heatAt(FULL_SCALE * part));
  key.append(data.span ? "mm" : "× bead height");
  const reset = make("button", key, { textContent: "↺", title: "The whole range" });
  reset.setAttribute("aria-label", "The whole range");
  const write = () => {
    ends.forEach((end, i) => { end.value = range[i].toFixed(digits); });
    reset.hidden = range.every((end, i) => end === whole[i]);
  };
  write();
  if (!data.span) {
    make("i", key);
    key.append("void");
  }
  const grid = make("div", card, { className: "grid" });
  const canvases = data.columns.map(column => {
    const figure = make("figure", grid), canvas = make("canvas", figure);
    make("figcaption", figure, { textContent: column.name });
    canvas.setAttribute("role", "img");
    return canvas;
  });
  let at = data.labels.length >> 1;
  const show = () => canvases.forEach((canvas, k) => {
    const { name, maps } = data.columns[k];
    canvas.setAttribute("aria-label", `Heights of ${name}, ${data.labels[at]}`);
    paint(canvas, maps[at], paletteOf(whole, range));
  });
  const set = to => { range = to; write(); show(); };
  low.onchange = high.onchange = () => set(typedRange(ends, range, digits) ?? range);
  reset.onclick = () => set(whole);
  slide(card, data.labels, at, "Layer of the heights", to => { at = to; show(); });
  show();
  window.addEventListener("resize", show);
}

document.querySelectorAll(".maps").forEach(showMaps);

// The button in a column head sorts the table by it; another press reverses the order. Numbers sort by value, all
// else as text.
function sortBy(table, column) {
  const down = table.dataset.sorted === `${column} up`;
  table.dataset.sorted = `${column} ${down ? "down" : "up"}`;
  [...table.rows[0].cells].forEach(head => head.removeAttribute("aria-sort"));
  table.rows[0].cells[column].setAttribute("aria-sort", down ? "descending" : "ascending");
  const rows = [...table.rows].slice(1), text = row => row.cells[column].textContent.trim();
  const number = row => text(row) === "" ? Infinity : Number(text(row));
  const compare = (a, b) => {
    const difference = number(a) - number(b);
    return Number.isNaN(difference) ? text(a).localeCompare(text(b)) : difference;
  };
  rows.sort((a, b) => down ? compare(b, a) : compare(a, b)).forEach(row => table.tBodies[0].append(row));
}

document.querySelectorAll("table").forEach(table =>
  [...table.rows[0].cells].forEach((head, column) => {
    const button = document.createElement("button");
    button.append(...head.childNodes);
    button.onclick = () => sortBy(table, column);
    head.append(button);
  }));

document.querySelectorAll(".card.wide, .card.drawn").forEach(hintAtWide);
