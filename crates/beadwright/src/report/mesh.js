// A surface of triangles in 3-D on a card of a page, under a camera of its own.

// Faces are flat: their normals follow from how places change across the picture.
const LIT_FACE = `
vec3 lit(vec3 colour, vec3 place, vec3 light) {
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  return colour * (0.45 + 0.6 * max(dot(normal, light), 0.0));
}`;

function boxAround(at) {
  const box = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  at.forEach((v, i) => { box[0][i % 3] = Math.min(box[0][i % 3], v); box[1][i % 3] = Math.max(box[1][i % 3], v); });
  return box;
}

const diagonal = box => Math.hypot(...box[0].map((v, i) => box[1][i] - v));

// The buffers of a surface on the graphics card: its faces, and lists of values for its nodes, each with the type of its numbers.
function loadMesh(gl, faces, lists) {
  const fill = (target, values) => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, values, gl.STATIC_DRAW);
    return buffer;
  };
  fill(gl.ELEMENT_ARRAY_BUFFER, faces);
  const buffers = lists.map(values => [fill(gl.ARRAY_BUFFER, values), values instanceof Float32Array ? gl.FLOAT : gl.UNSIGNED_BYTE]);
  return (attribute, list) => {
    const [buffer, type] = buffers[list];
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(attribute);
    gl.vertexAttribPointer(attribute, 3, type, type !== gl.FLOAT, 0, 0);
  };
}

// A canvas for surfaces within a box; null where the browser cannot draw them. `draw` gets the places of the program's uniforms.
function meshView(card, what, box, shaders) {
  const canvas = make("canvas", card, { tabIndex: 0 }), gl = canvas.getContext("webgl2", { alpha: false, preserveDrawingBuffer: true, antialias: true });
  canvas.setAttribute("role", "application");
  canvas.setAttribute("aria-label", `${what} in 3-D: arrows turn it, with shift they move it, plus and minus zoom, F shows all`);
  if (!gl) {
    card.replaceChildren("This browser has no WebGL 2, so there is no 3-D view.");
    return null;
  }
  const { program, places } = newProgram(gl, ...shaders), camera = newCamera(), size = diagonal(box), view = { gl, places, canvas, draw: null };
  let waiting = 0;
  const draw = () => {
    waiting = 0;
    const ratio = window.devicePixelRatio || 1;
    [canvas.width, canvas.height] = [canvas.clientWidth, canvas.clientHeight].map(length => Math.round(length * ratio));
    const aspect = canvas.width / canvas.height;
    if (camera.fitted) fitCamera(camera, box, aspect);
    const { right, back } = axesOf(camera), paper = getComputedStyle(canvas).backgroundColor.match(/\d+/g).slice(0, 3).map(v => v / 255);
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(...paper, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(program);
    gl.uniformMatrix4fv(places.camera, false, matrixOf(camera, aspect, 2 * size + Math.hypot(...camera.target.map((v, i) => v - (box[0][i] + box[1][i]) / 2))));
    gl.uniform3fv(places.light, [0, 1, 2].map(i => 0.78 * back[i] - 0.38 * right[i] + (i > 1 ? 0.4 : 0)));
    view.draw();
  };
  view.redraw = () => { waiting ||= requestAnimationFrame(draw); };
  steerCamera(canvas, camera, view.redraw);
  window.addEventListener("resize", view.redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", view.redraw);
  return view;
}

const steering = card => make("p", card, { className: "lead", textContent: "Drag: turn · shift or right button: move · wheel: zoom · double click: show all." });
