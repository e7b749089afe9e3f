// A camera that turns about a point, z upwards; lengths in mm, angles in rad. Matrices are in columns, as WebGL has them.

const FIELD = Math.tan(0.28); // half the height of the picture at distance 1
const dot3 = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const newCamera = () => ({ target: [0, 0, 0], distance: 1, yaw: -0.6, pitch: 0.55, fitted: true });

// Unit vectors to the right, up and towards the eye, as the camera sees them.
function axesOf({ yaw, pitch }) {
  const [c, s, cp, sp] = [Math.cos(yaw), Math.sin(yaw), Math.cos(pitch), Math.sin(pitch)];
  return { right: [c, s, 0], up: [-s * sp, c * sp, cp], back: [s * cp, -c * cp, sp] };
}

// Brings all corners of a box ([low, high]) into view.
function fitCamera(camera, box, aspect) {
  const { right, up, back } = axesOf(camera), middle = [0, 1, 2].map(i => (box[0][i] + box[1][i]) / 2);
  const needed = Array.from({ length: 8 }, (_, corner) => {
    const way = middle.map((v, i) => box[corner >> i & 1][i] - v);
    return dot3(way, back) + Math.max(Math.abs(dot3(way, right)) / aspect, Math.abs(dot3(way, up))) / FIELD;
  });
  Object.assign(camera, { target: middle, distance: 1.06 * Math.max(...needed, 1e-3), fitted: true });
}

function turnCamera(camera, yaw, pitch) {
  camera.yaw += yaw;
  camera.pitch = Math.min(Math.max(camera.pitch + pitch, -1.55), 1.55);
}

// Moves the part by fractions of the picture's height.
function panCamera(camera, x, y) {
  const { right, up } = axesOf(camera), size = 2 * FIELD * camera.distance;
  camera.target = camera.target.map((v, i) => v - size * (x * right[i] - y * up[i]));
  camera.fitted = false;
}

// Zooms by a factor; what lies at (x, y) of the picture, -1 to 1, stays there.
function zoomCamera(camera, factor, x, y, aspect) {
  const distance = Math.min(Math.max(camera.distance / factor, 0.5), 1e6), { right, up } = axesOf(camera);
  const moved = FIELD * (camera.distance - distance);
  camera.target = camera.target.map((v, i) => v + moved * (x * aspect * right[i] + y * up[i]));
  camera.distance = distance;
  camera.fitted = false;
}

// The matrix from places in the part to the picture; what lies within `reach` of the target is not clipped.
function matrixOf(camera, aspect, reach) {
  const { right, up, back } = axesOf(camera), { target, distance } = camera;
  const near = Math.max(distance - reach, distance / 200), far = distance + reach;
  const rows = [right.map(v => v / (FIELD * aspect)), up.map(v => v / FIELD), back.map(v => -v)];
  const [x, y, depth] = rows.map(row => [...row, -dot3(row, target)]);
  depth[3] += distance;
  const z = depth.map(v => v * (far + near) / (far - near));
  z[3] -= 2 * far * near / (far - near);
  return new Float32Array([0, 1, 2, 3].flatMap(i => [x[i], y[i], z[i], depth[i]]));
}

// Where a place lies in a picture of this size, px; null behind the eye.
function projected(m, [x, y, z], width, height) {
  const [px, py, , w] = [0, 1, 2, 3].map(i => m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i]);
  return w > 0 ? [(px / w + 1) / 2 * width, (1 - py / w) / 2 * height] : null;
}
