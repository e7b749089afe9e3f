// How much of a part is drawn, so that a picture takes no longer than it may.

// Triangles at a rate that was measured: how long a picture may take while something moves, and at rest, ms.
const MOVING = 15, RESTING = 1200, PRETTY = 300;

// `pieces` of beads, of these `outside` along outlines; `rate` is the time of a triangle, ms.
const newPace = () => ({ pieces: 0, outside: 0, rate: 1e-4, drawing: false, again: false });

// All of the layers shown, as little as has to be, or one layer for several; `share` of the layers is shown.
function amount({ pieces, outside, rate }, scene, share, moving) {
  const cost = (count, mesh) => count * share * scene.meshes[mesh].faces.length / 3 * rate, most = moving ? MOVING : RESTING;
  if (cost(pieces, 0) < Math.min(most, PRETTY)) return { mesh: 0, stride: 1, outside: false };
  if (cost(pieces, 1) < most) return { mesh: 1, stride: 1, outside: false };
  return { mesh: 2, stride: Math.min(Math.ceil(cost(outside, 2) / most), 48), outside: true };
}

// How long a picture takes, without waiting for it; what was asked for meanwhile is drawn when it is done.
function timed(pace, gl, triangles, begun, redraw) {
  const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
  pace.drawing = true;
  const look = () => {
    if (gl.clientWaitSync(fence, gl.SYNC_FLUSH_COMMANDS_BIT, 0) === gl.TIMEOUT_EXPIRED) return setTimeout(look, 3);
    gl.deleteSync(fence);
    pace.drawing = false;
    // Too few triangles give no rate.
    if (triangles > 20000) pace.rate = (performance.now() - begun) / triangles;
    if (pace.again) redraw();
  };
  look();
}
