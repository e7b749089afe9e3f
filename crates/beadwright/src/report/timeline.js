// The build in time: every layer as wide as it lasts, divided into arc, travels and waits.

const timeline = $("timeline");
const PARTS = [["arc", "arc"], ["rest", "travels, starts and ends"], ["wait", "waits"]];

// Arc, travels and waits of a layer, s.
const partsOf = ([arc, wait, rest]) => ({ arc, wait, rest });
const paintOf = name => name === "arc" ? colours.contour : name === "wait" ? colours.wait : colours.travel;

function drawTimeline() {
  const ctx = timeline.getContext("2d"), width = timeline.clientWidth, height = timeline.clientHeight, ratio = timeline.width / width || 1;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  heads.forEach(({ begins, lasts }, i) => {
    if (!(lasts > 0)) return;
    const parts = partsOf(data.times[i]), x = begins / total * width, wide = lasts / total * width;
    let y = height;
    for (const [name] of PARTS) {
      const tall = parts[name] / lasts * height;
      ctx.fillStyle = paintOf(name);
      ctx.fillRect(x, y -= tall, Math.max(wide - (wide > 4 ? 1 : 0), 0.5), tall);
    }
  });
  const { begins, lasts } = heads[shown.index];
  ctx.strokeStyle = colours.text;
  ctx.lineWidth = 2;
  ctx.strokeRect(begins / total * width + 0.5, 1, Math.max(lasts / total * width - 1, 1.5), height - 2);
}

function startTimeline() {
  const sums = data.times.map(partsOf).reduce((sum, parts) => PARTS.map(([name], i) => sum[i] + parts[name]), [0, 0, 0]);
  const words = PARTS.map(([, word], i) => `${word} ${clock(sums[i])} (${(100 * sums[i] / total).toFixed(1)} %)`);
  const present = [0, 1, 2].filter(i => sums[i] > 0);
  $("times").replaceChildren(...present.map(i => {
    const item = element("span", words[i]), swatch = document.createElement("i");
    swatch.className = `swatch ${PARTS[i][0]}`;
    item.prepend(swatch);
    return item;
  }));
  timeline.setAttribute("aria-label", `Time line of ${clock(total)}: ${present.map(i => words[i]).join(", ")}`);
  const at = event => {
    const time = event.offsetX / timeline.clientWidth * total, index = heads.findIndex(({ begins, lasts }) => begins + lasts > time);
    return index < 0 ? heads.length - 1 : index;
  };
  timeline.onpointerdown = event => { timeline.setPointerCapture(event.pointerId); show(at(event)); };
  timeline.onpointermove = event => {
    const index = at(event), { arc, rest, wait } = partsOf(data.times[index]);
    timeline.title = `Layer ${index + 1}: arc ${clock(arc)}, travels and starts ${clock(rest)}, waits ${clock(wait)}`;
    if (event.buttons) show(index);
  };
}
