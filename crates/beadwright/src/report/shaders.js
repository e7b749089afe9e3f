// The programs of the graphics card. A bead is spanned from one point to the next, mitred with its neighbours.

const BEAD_SHADER = `#version 300 es
precision highp float;
layout(location = 0) in vec3 corner;   // across and up, parts of width and height; 0 at the first point, 1 at the second
layout(location = 1) in vec2 facing;   // across and up
layout(location = 2) in vec2 before;
layout(location = 3) in vec3 here;     // x, y, time in the layer
layout(location = 4) in vec3 there;
layout(location = 5) in vec2 beyond;
layout(location = 6) in vec3 values;   // width, speed, temperature
layout(location = 7) in uvec2 tags;    // kind, whether a piece begins
layout(location = 8) in uint pass;
uniform mat4 camera;
uniform vec4 layer;                    // top, height, time of its start, time of the build in one of its seconds
uniform vec2 span;                     // time up to which it is laid, all of its time
uniform int field;
uniform vec2 range;
uniform vec3 ramp[5];
uniform vec3 kinds[3];
uniform int picked;
out vec3 colour;
out vec3 normal;
out float up;
flat out uint passOut;
flat out float secondsOut;

vec2 along(vec2 from, vec2 to, vec2 otherwise) {
  vec2 way = to - from;
  float far = length(way);
  return far > 1e-4 ? way / far : otherwise;
}

float value() {
  if (field == 1) return here.z / max(span.y, 1e-6);
  if (field == 2) return values.x;
  if (field == 3) return values.y;
  if (field == 4) return layer.z + here.z * layer.w;
  return values.z;
}

vec3 painted() {
  if (field == 0) return kinds[tags.x];
  float part = range.y > range.x ? clamp((value() - range.x) / (range.y - range.x), 0.0, 1.0) * 4.0 : 2.0;
  int i = min(int(part), 3);
  return mix(ramp[i], ramp[i + 1], part - float(i));
}

void main() {
  passOut = pass;
  secondsOut = here.z;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (tags.y == 0u || here.z >= span.x) return;
  bool cut = there.z > span.x;
  vec2 to = cut ? mix(here.xy, there.xy, (span.x - here.z) / (there.z - here.z)) : there.xy;
  vec2 way = along(here.xy, there.xy, vec2(1.0, 0.0));
  vec2 other = corner.z < 0.5 ? along(before, here.xy, way) : cut ? way : along(there.xy, beyond, way);
  vec2 sum = way + other;
  vec2 tangent = dot(sum, sum) > 0.05 ? normalize(sum) : way;
  float mitre = 1.0 / max(dot(tangent, way), 0.5);
  vec2 side = vec2(-tangent.y, tangent.x);
  vec2 at = (corner.z < 0.5 ? here.xy : to) + side * corner.x * values.x * mitre;
  up = corner.y;
  normal = vec3(side * facing.x, facing.y);
  colour = painted();
  if (picked >= 0 && uint(picked) == pass) colour = mix(colour, vec3(1.0), 0.65);
  gl_Position = camera * vec4(at, layer.x - layer.y * (1.0 - corner.y), 1.0);
}`;

// Light from behind the eye's left shoulder; grooves between beads are darker.
const LIT_SHADER = `#version 300 es
precision highp float;
in vec3 colour;
in vec3 normal;
in float up;
uniform vec3 light;
out vec4 pixel;
void main() {
  float bright = 0.4 + 0.66 * max(dot(normalize(normal), light), 0.0);
  pixel = vec4(colour * bright * mix(0.5, 1.08, smoothstep(-0.1, 0.8, up)), 1.0);
}`;

// For the pixel below the pointer: layer + 1, pass, bits of the time in the layer.
const PICK_SHADER = `#version 300 es
precision highp float;
precision highp int;
flat in uint passOut;
flat in float secondsOut;
uniform int number;
out uvec4 found;
void main() { found = uvec4(uint(number + 1), passOut, floatBitsToUint(secondsOut), 1u); }`;

const LINE_SHADER = `#version 300 es
layout(location = 0) in vec3 at;
uniform mat4 camera;
void main() { gl_Position = camera * vec4(at, 1.0); }`;

const PLAIN_SHADER = `#version 300 es
precision highp float;
uniform vec4 paint;
out vec4 pixel;
void main() { pixel = paint; }`;

// Across, up; facing across, up.
const ROUND = [[-0.42, 0, -0.9, -0.4], [-0.5, 0.42, -1, 0.1], [-0.34, 0.84, -0.6, 0.8], [0, 1, 0, 1], [0.34, 0.84, 0.6, 0.8], [0.5, 0.42, 1, 0.1], [0.42, 0, 0.9, -0.4]];
const PLAIN = [[-0.5, 0, -1, 0], [-0.4, 0.9, -0.6, 0.8], [0.4, 0.9, 0.6, 0.8], [0.5, 0, 1, 0]];

// The corners of a profile at both ends, and the triangles between them and of the faces that close them, all of them
// turning left as seen from outside.
function meshOf(profile) {
  const n = profile.length, corners = [0, 1].flatMap(end => profile.flatMap(([across, up, fx, fy]) => [across, up, end, fx, fy])), faces = [];
  for (let i = 0; i < n; i++) {
    const next = (i + 1) % n;
    faces.push(i, n + i, next, next, n + i, n + next);
    if (i > 0 && next) faces.push(0, i, next, n, n + next, n + i);
  }
  return { corners: new Float32Array(corners), faces: new Uint16Array(faces) };
}
