// A surface in several colours, in 3-D: coloured.rs describes its data.

const COLOURED_SHADER = `#version 300 es
precision highp float;
layout(location = 0) in vec3 at;
layout(location = 1) in vec3 colour;
uniform mat4 camera;
out vec3 place;
out vec3 tint;
void main() {
  place = at;
  tint = colour;
  gl_Position = camera * vec4(at, 1.0);
}`;

const TINT_SHADER = `#version 300 es
precision highp float;
in vec3 place;
in vec3 tint;
uniform vec3 light;
out vec4 pixel;
${LIT_FACE}
void main() { pixel = vec4(lit(tint, place, light), 1.0); }`;

async function showColoured(card) {
  const data = JSON.parse(card.querySelector("script").textContent), bytes = await inflate(bytesOf(data.surface));
  const [nodes, corners] = new Uint32Array(bytes.buffer, 0, 2), after = 8 + 12 * nodes;
  const at = new Float32Array(bytes.buffer, 8, 3 * nodes), faces = new Uint32Array(bytes.buffer, after, corners);
  const colours = new Uint8Array(bytes.buffer, after + 4 * corners, 3 * nodes);
  const view = meshView(card, data.name, boxAround(at), [COLOURED_SHADER, TINT_SHADER]);
  if (!view) return;
  const { gl, canvas } = view, bind = loadMesh(gl, faces, [at, colours]), key = make("div", card, { className: "key" });
  for (const [name, colour] of data.key) {
    const entry = make("span", key, { className: "entry" });
    make("span", entry, { className: "swatch" }).style.background = colour;
    make("span", entry, { textContent: name });
  }
  view.draw = () => {
    bind(0, 0);
    bind(1, 1);
    gl.drawElements(gl.TRIANGLES, corners, gl.UNSIGNED_INT, 0);
    canvas.dataset.ready = corners / 3;
  };
  steering(card);
  view.redraw();
}

document.querySelectorAll(".coloured").forEach(showColoured);
