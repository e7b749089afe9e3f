// The programs of the graphics card. A bead is spanned from one point to the next, mitred with its neighbours. The points
// are read from a texture, two texels each, three of layers that are not level: drawn as instances they would be slow without a
// graphics card.

const beadShader = inSpace => `#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D points;        // x, y, time in the layer, width; speed, temperature, kind + 4 where a piece begins, pass; z, normal
const int texels = ${inSpace ? 3 : 2};
uniform vec4 profile[7];               // across and up, parts of width and height; facing across and up
uniform int corners;                   // of the profile
uniform mat4 camera;
uniform vec4 layer;                    // top, height, time of its start, time of the build in one of its seconds
uniform vec2 span;                     // time up to which it is laid, all of its time
uniform int field;
uniform vec2 range;
uniform vec3 ramp[5];
uniform vec3 kinds[4];
uniform int picked;
out vec3 colour;
out vec3 normal;
out float up;
flat out uint passOut;
flat out float secondsOut;

vec4 texel(int i) { return texelFetch(points, ivec2(i % ${ACROSS}, i / ${ACROSS}), 0); }

vec3 place(int i) { return ${inSpace ? "vec3(texel(i).xy, texel(i + 2).x)" : "vec3(texel(i).xy, layer.x)"}; }

vec3 facing(int i) { return ${inSpace ? "texel(i + 2).yzw" : "vec3(0.0, 0.0, 1.0)"}; }

vec3 along(vec3 from, vec3 to, vec3 otherwise) {
  vec3 way = to - from;
  float far = length(way);
  return far > 1e-4 ? way / far : otherwise;
}

float value(vec4 here, vec4 more) {
  if (field == 1) return here.z / max(span.y, 1e-6);
  if (field == 2) return here.w;
  if (field == 3) return more.x;
  if (field == 4) return layer.z + here.z * layer.w;
  return more.y;
}

vec3 painted(vec4 here, vec4 more, int kind) {
  if (field == 0) return kinds[kind];
  float part = range.y > range.x ? clamp((value(here, more) - range.x) / (range.y - range.x), 0.0, 1.0) * 4.0 : 2.0;
  int i = min(int(part), 3);
  return mix(ramp[i], ramp[i + 1], part - float(i));
}

void main() {
  int piece = gl_VertexID / (2 * corners), corner = gl_VertexID % corners, first = texels * piece;
  bool end = (gl_VertexID / corners) % 2 == 1;
  int own = first + texels, next = own + texels;
  vec4 here = texel(own), more = texel(own + 1), there = texel(next), shape = profile[corner];
  int tags = int(more.z + 0.5);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (tags < 4 || here.z >= span.x) return;
  bool cut = there.z > span.x;
  float part = cut ? (span.x - here.z) / (there.z - here.z) : 1.0;
  vec3 from = place(own), last = place(next), to = mix(from, last, part);
  vec3 way = along(from, last, vec3(1.0, 0.0, 0.0));
  vec3 other = !end ? along(place(first), from, way) : cut ? way : along(last, place(next + texels), way);
  vec3 sum = way + other;
  vec3 tangent = dot(sum, sum) > 0.05 ? normalize(sum) : way;
  float mitre = 1.0 / max(dot(tangent, way), 0.5);
  vec3 thick = end ? mix(facing(own), facing(next), part) : facing(own), upward = normalize(thick);
  vec3 side = normalize(cross(upward, tangent));
  vec3 at = (end ? to : from) + side * shape.x * here.w * mitre - thick * layer.y * (1.0 - shape.y);
  up = shape.y;
  normal = side * shape.z + upward * shape.w;
  colour = painted(here, more, tags - 4);
  passOut = uint(more.w + 0.5);
  secondsOut = here.z;
  if (picked >= 0 && uint(picked) == passOut) colour = mix(colour, vec3(1.0), 0.65);
  gl_Position = camera * vec4(at, 1.0);
}`;

// Light from behind the eye's left shoulder; grooves between beads are darker, but not where they are finer than pixels.
const LIT_SHADER = `#version 300 es
precision highp float;
in vec3 colour;
in vec3 normal;
in float up;
uniform vec3 light;
uniform float fine;
out vec4 pixel;
void main() {
  vec3 facing = normalize(vec3(normal.xy, normal.z * mix(0.3, 1.0, fine)));
  float bright = 0.4 + 0.66 * max(dot(facing, light), 0.0), groove = mix(0.5, 1.08, smoothstep(-0.1, 0.8, up));
  pixel = vec4(colour * bright * mix(0.92, groove, fine), 1.0);
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

// The triangles of a piece between the corners of a profile at its two ends, all turning left as seen from outside; a
// closed bead has a face below and at its ends too.
function facesOf(n, closed) {
  const faces = [];
  for (let i = 0; i < (closed ? n : n - 1); i++) {
    const next = (i + 1) % n;
    faces.push(i, n + i, next, next, n + i, n + next);
    if (closed && i > 0 && next) faces.push(0, i, next, n, n + next, n + i);
  }
  return faces;
}
