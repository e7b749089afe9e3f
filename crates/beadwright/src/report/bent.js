// A body that bends, in 3-D: bent.rs describes its data. A slider exaggerates how far it moves.

const BENT_SHADER = `#version 300 es
precision highp float;
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 moved;
uniform mat4 camera;
uniform float times;
uniform float most;
out vec3 place;
out float part;
void main() {
  place = at + times * moved;
  part = length(moved) / most;
  gl_Position = camera * vec4(place, 1.0);
}`;

const FACE_SHADER = `#version 300 es
precision highp float;
in vec3 place;
in float part;
uniform vec3 light;
uniform vec3 ramp[5];
out vec4 pixel;
${LIT_FACE}
void main() {
  float at = clamp(part, 0.0, 1.0) * 4.0;
  int i = min(int(at), 3);
  pixel = vec4(lit(mix(ramp[i], ramp[i + 1], at - float(i)), place, light), 1.0);
}`;

const TIMES = [0, 1, 2, 5, 10, 20, 50, 100, 200, 500];
// At first the farthest place moves by about this part of the body's size.
const AT_FIRST = 0.1;

async function readBody(text) {
  const bytes = await inflate(bytesOf(text)), [nodes, shapes, corners] = new Uint32Array(bytes.buffer, 0, 3);
  const floats = new Float32Array(bytes.buffer, 12, 3 * nodes * (1 + shapes)), list = k => floats.subarray(3 * nodes * k, 3 * nodes * (k + 1));
  const moved = Array.from({ length: shapes }, (_, k) => list(k + 1));
  return { at: list(0), moved, faces: new Uint32Array(bytes.buffer, 12 + floats.byteLength, corners) };
}

const farthest = moved => {
  let most = 0;
  for (let i = 0; i < moved.length; i += 3) most = Math.max(most, Math.hypot(moved[i], moved[i + 1], moved[i + 2]));
  return most;
};

async function showBent(card) {
  const data = JSON.parse(card.querySelector("script").textContent), body = await readBody(data.body);
  const most = body.moved.map(farthest), box = boxAround(body.at);
  const choice = make("select", card);
  choice.setAttribute("aria-label", "Shape");
  data.shapes.forEach((name, value) => make("option", choice, { value, textContent: name, selected: value === data.shapes.length - 1 }));
  const view = meshView(card, "The bent body", box, [BENT_SHADER, FACE_SHADER]);
  if (!view) return;
  const { gl, places, canvas } = view, bind = loadMesh(gl, body.faces, [body.at, ...body.moved]);
  const key = make("div", card, { className: "key" });
  make("span", key, { textContent: "moved by 0 mm" });
  const ramp = make("canvas", key, { width: 160, height: 12 }), high = make("span", key);
  ramp.setAttribute("aria-hidden", "true");
  drawKey(ramp, part => rampAt(part));
  const fitting = TIMES.filter(times => times * Math.max(...most) <= AT_FIRST * diagonal(box)), first = Math.max(fitting.length - 1, 1);
  let exaggeration = TIMES[first];
  view.draw = () => {
    const shape = Number(choice.value);
    high.textContent = `${most[shape].toFixed(2)} mm`;
    bind(0, 0);
    bind(1, shape + 1);
    gl.uniform3fv(places.ramp, RAMP.flat().map(v => v / 255));
    gl.uniform1f(places.times, exaggeration);
    gl.uniform1f(places.most, Math.max(most[shape], 1e-9));
    gl.drawElements(gl.TRIANGLES, body.faces.length, gl.UNSIGNED_INT, 0);
    canvas.dataset.ready = body.faces.length / 3;
  };
  choice.onchange = view.redraw;
  const labels = TIMES.map(times => times ? `moved ${times} ×` : "as it was meant");
  slide(card, labels, first, "Exaggeration of the movement", at => { exaggeration = TIMES[at]; view.redraw(); });
  steering(card);
  view.redraw();
}

document.querySelectorAll(".bent").forEach(showBent);
