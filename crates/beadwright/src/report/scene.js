// Beads in space: buffers of layers, drawn by the programs of shaders.js. Knows nothing of the page.

// `inSpace`: layers are not level.
function newScene(canvas, inSpace = false) {
  // Where the CPU draws, smooth edges cost more than they are worth.
  const gl = canvas.getContext("webgl2", { alpha: false, preserveDrawingBuffer: true, antialias: !drawnByProcessor() });
  if (!gl) return null;
  const scene = {
    gl, layers: [], most: 0, meshes: [[ROUND, true], [PLAIN, true], [PLAIN, false]].map(([profile, closed]) => newMesh(gl, profile, closed)),
    lit: newProgram(gl, beadShader(inSpace), LIT_SHADER), pick: newProgram(gl, beadShader(inSpace), PICK_SHADER),
    line: newProgram(gl, LINE_SHADER, PLAIN_SHADER), lines: gl.createBuffer(), target: newTarget(gl),
  };
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);
  return scene;
}

function drawnByProcessor() {
  const gl = document.createElement("canvas").getContext("webgl2"), names = gl?.getExtension("WEBGL_debug_renderer_info");
  const renderer = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(renderer);
}

function newProgram(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) || "the 3-D view cannot be linked");
  const places = {}, count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
  for (let i = 0; i < count; i++) {
    const { name } = gl.getActiveUniform(program, i);
    places[name.replace("[0]", "")] = gl.getUniformLocation(program, name);
  }
  return { program, places };
}

// A profile, and the triangles of as many pieces as the largest layer needs.
function newMesh(gl, profile, closed) {
  return { profile: new Float32Array(profile.flat()), corners: profile.length, faces: facesOf(profile.length, closed), indices: gl.createBuffer(), pieces: 0 };
}

function reserve(gl, mesh, pieces) {
  if (pieces <= mesh.pieces) return;
  const { faces, corners } = mesh, count = 2 * pieces, list = new Uint32Array(count * faces.length);
  for (let k = 0; k < count; k++) for (let i = 0; i < faces.length; i++) list[k * faces.length + i] = faces[i] + 2 * corners * k;
  mesh.pieces = count;
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.indices);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, list, gl.STATIC_DRAW);
}

// One pixel of whole numbers.
function newTarget(gl) {
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  for (const [format, place] of [[gl.RGBA32UI, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]]) {
    const buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, format, 1, 1);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
  }
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return frame;
}

// `about` is what the shader has to know of a layer: top, height, start, pace of time, seconds.
function addLayer(scene, index, { numbers, count, outside }, about) {
  if (count < 4) return;
  const { gl } = scene, texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, ACROSS, numbers.length / 4 / ACROSS, 0, gl.RGBA, gl.FLOAT, numbers);
  for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
  scene.most = Math.max(scene.most, count);
  scene.layers[index] = { ...about, texture, count: count - 3, outside: Math.max(outside - 3, 0) };
}

function clearLayers(scene) {
  scene.layers.forEach(({ texture }) => scene.gl.deleteTexture(texture));
  scene.layers = [];
}

// The layers to draw up to the highest one shown: in groups of `stride`, of each only the top one, as high as the
// group.
function grouped(layers, highest, stride) {
  const list = [];
  for (let first = 0; first <= highest; first += stride) {
    let layer = null, index = -1, bottom = Infinity;
    for (let i = first; i < Math.min(first + stride, highest + 1); i++) {
      if (!layers[i]) continue;
      [layer, index] = [layers[i], i];
      bottom = Math.min(bottom, layer.top - layer.height);
    }
    if (layer) list.push({ layer, index, height: layer.top - bottom });
  }
  return list;
}

// `look`: matrix, light, fine (whether layers are pixels high, 0 to 1), highest, until, field, range, ramp, kinds, picked { layer, pass }, and how much of it: mesh (0
// round, 1 plain, 2 plain and open), stride, whether only passes along the outline are drawn below the highest layer.
function drawBeads3(scene, { program, places }, look) {
  const { gl } = scene, mesh = scene.meshes[look.mesh];
  gl.useProgram(program);
  reserve(gl, mesh, scene.most);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.indices);
  gl.uniform4fv(places.profile, mesh.profile);
  gl.uniform1i(places.corners, mesh.corners);
  gl.uniformMatrix4fv(places.camera, false, look.matrix);
  if (places.light) {
    gl.uniform3fv(places.light, look.light);
    gl.uniform1f(places.fine, look.fine);
    gl.uniform1i(places.field, look.field);
    gl.uniform2fv(places.range, look.range);
    gl.uniform3fv(places.ramp, look.ramp);
    gl.uniform3fv(places.kinds, look.kinds);
  }
  let triangles = 0;
  for (const { layer, index, height } of grouped(scene.layers, look.highest, look.stride)) {
    const count = mesh.faces.length * (look.outside && index !== look.highest ? layer.outside : layer.count);
    gl.uniform4f(places.layer, layer.top, height, layer.start, layer.pace);
    gl.uniform2f(places.span, index === look.highest ? Math.min(look.until, 1e30) : 1e30, layer.seconds);
    gl.uniform1i(places.picked, look.picked?.layer === index ? look.picked.pass : -1);
    if (places.number) gl.uniform1i(places.number, index);
    gl.bindTexture(gl.TEXTURE_2D, layer.texture);
    gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
    triangles += count / 3;
  }
  return triangles;
}

// Lines as [x, y, z, x, y, z, …] with a colour each.
function drawLines3(scene, matrix, lines) {
  const { gl } = scene, { program, places } = scene.line;
  gl.useProgram(program);
  gl.uniformMatrix4fv(places.camera, false, matrix);
  gl.bindBuffer(gl.ARRAY_BUFFER, scene.lines);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12, 0);
  for (const { points, colour } of lines) {
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points), gl.STREAM_DRAW);
    gl.uniform4fv(places.paint, [...colour.map(v => v / 255), 1]);
    gl.drawArrays(gl.LINES, 0, points.length / 3);
  }
  gl.disableVertexAttribArray(0);
}

// The number of triangles drawn.
function drawScene(scene, look) {
  const { gl } = scene;
  gl.viewport(0, 0, gl.canvas.width, gl.canvas.height);
  gl.clearColor(...look.paper.map(v => v / 255), 1);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  drawLines3(scene, look.matrix, look.lines);
  return drawBeads3(scene, scene.lit, look);
}

// What lies at a place of the picture, -1 to 1: { layer, pass, seconds }, or null.
function pickScene(scene, look, x, y) {
  const { gl } = scene, m = look.matrix, { width, height } = gl.canvas, narrow = new Float32Array(m);
  for (let i = 0; i < 16; i += 4) {
    narrow[i] = (m[i] - x * m[i + 3]) * width;
    narrow[i + 1] = (m[i + 1] - y * m[i + 3]) * height;
  }
  gl.bindFramebuffer(gl.FRAMEBUFFER, scene.target);
  gl.viewport(0, 0, 1, 1);
  gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
  gl.clear(gl.DEPTH_BUFFER_BIT);
  drawBeads3(scene, scene.pick, { ...look, matrix: narrow });
  const found = new Uint32Array(4);
  gl.readPixels(0, 0, 1, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, found);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return found[0] ? { layer: found[0] - 1, pass: found[1], seconds: new Float32Array(found.buffer, 8, 1)[0] } : null;
}
