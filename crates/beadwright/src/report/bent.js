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

// Faces are flat: their normals follow from how places change across the picture.
const FACE_SHADER = `#version 300 es
precision highp float;
in vec3 place;
in float part;
uniform vec3 light;
uniform vec3 ramp[5];
out vec4 pixel;
void main() {
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  float at = clamp(part, 0.0, 1.0) * 4.0;
  int i = min(int(at), 3);
  pixel = vec4(mix(ramp[i], ramp[i + 1], at - float(i)) * (0.45 + 0.6 * max(dot(normal, light), 0.0)), 1.0);
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

function boxAround(at) {
  const box = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  at.forEach((v, i) => { box[0][i % 3] = Math.min(box[0][i % 3], v); box[1][i % 3] = Math.max(box[1][i % 3], v); });
  return box;
}

// The buffers of a body on the graphics card; `attribute` 0 is where its nodes are, 1 how they move.
function loadBody(gl, { at, moved, faces }) {
  const fill = (target, values) => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, values, gl.STATIC_DRAW);
    return buffer;
  };
  fill(gl.ELEMENT_ARRAY_BUFFER, faces);
  const buffers = [at, ...moved].map(values => fill(gl.ARRAY_BUFFER, values));
  return (attribute, buffer) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[buffer]);
    gl.enableVertexAttribArray(attribute);
    gl.vertexAttribPointer(attribute, 3, gl.FLOAT, false, 12, 0);
  };
}

async function showBent(card) {
  const data = JSON.parse(card.querySelector("script").textContent), body = await readBody(data.body);
  const most = body.moved.map(farthest), box = boxAround(body.at), size = Math.hypot(...box[0].map((v, i) => box[1][i] - v));
  const choice = make("select", card);
  choice.setAttribute("aria-label", "Shape");
  data.shapes.forEach((name, value) => make("option", choice, { value, textContent: name, selected: value === data.shapes.length - 1 }));
  const canvas = make("canvas", card, { tabIndex: 0 }), gl = canvas.getContext("webgl2", { alpha: false, preserveDrawingBuffer: true, antialias: true });
  canvas.setAttribute("role", "application");
  canvas.setAttribute("aria-label", "The bent body in 3-D: arrows turn it, with shift they move it, plus and minus zoom, F shows all");
  if (!gl) {
    card.replaceChildren("This browser has no WebGL 2, so there is no 3-D view of the bent body.");
    return;
  }
  const { program, places } = newProgram(gl, BENT_SHADER, FACE_SHADER), bind = loadBody(gl, body), camera = newCamera();
  const key = make("div", card, { className: "key" });
  make("span", key, { textContent: "0 mm" });
  const ramp = make("canvas", key, { width: 160, height: 12 }), high = make("span", key);
  ramp.setAttribute("aria-hidden", "true");
  drawKey(ramp, part => rampAt(part));
  const fitting = TIMES.filter(times => times * Math.max(...most) <= AT_FIRST * size), first = Math.max(fitting.length - 1, 1);
  const state = { times: TIMES[first], waiting: 0 };
  const draw = () => {
    state.waiting = 0;
    const ratio = window.devicePixelRatio || 1, shape = Number(choice.value);
    [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight].map(length => Math.round(length * ratio));
    const aspect = canvas.width / canvas.height;
    if (camera.fitted) fitCamera(camera, box, aspect);
    const { right, back } = axesOf(camera), paper = getComputedStyle(canvas).backgroundColor.match(/\d+/g).slice(0, 3).map(v => v / 255);
    high.textContent = `${most[shape].toFixed(2)} mm`;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(...paper, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program);
    bind(0, 0);
    bind(1, shape + 1);
    gl.uniformMatrix4fv(places.camera, false, matrixOf(camera, aspect, 2 * size + Math.hypot(...camera.target.map((v, i) => v - (box[0][i] + box[1][i]) / 2))));
    gl.uniform3fv(places.light, [0, 1, 2].map(i => 0.78 * back[i] - 0.38 * right[i] + (i > 1 ? 0.4 : 0)));
    gl.uniform3fv(places.ramp, RAMP.flat().map(v => v / 255));
    gl.uniform1f(places.times, state.times);
    gl.uniform1f(places.most, Math.max(most[shape], 1e-9));
    gl.drawElements(gl.TRIANGLES, body.faces.length, gl.UNSIGNED_INT, 0);
    canvas.dataset.ready = body.faces.length / 3;
  };
  const redraw = () => { state.waiting ||= requestAnimationFrame(draw); };
  steerCamera(canvas, camera, redraw);
  choice.onchange = redraw;
  const labels = TIMES.map(times => times ? `moved ${times} ×` : "as it was meant");
  slide(card, labels, first, "Exaggeration of the movement", at => { state.times = TIMES[at]; redraw(); });
  make("p", card, { className: "lead", textContent: "Drag: turn · shift or right button: move · wheel: zoom · double click: show all." });
  window.addEventListener("resize", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  redraw();
}

document.querySelectorAll(".bent").forEach(showBent);
