// How much of a part is drawn, so that a picture is finished in time.

// How long a picture may take, ms: while something moves, at rest, and with the finest beads.
const MOVING = 15, RESTING = 1200, PRETTY = 300;

// `pieces` of beads, of these `outside` along outlines; `rate` is the time of a triangle, ms.
const newPace = () => ({ pieces: 0, outside: 0, rate: 1e-4, drawing: false, again: false });

// What to draw of the layers shown (a `share` of all): every bead, only those along outlines, or one layer in place
// of `stride`.
function amount({ pieces, outside, rate }, scene, share, moving) {
  const cost = (count, mesh) => count * share * scene.meshes[mesh].faces.length / 3 * rate, most = moving ? MOVING : RESTING;
  if (cost(pieces, 0) < Math.min(most, PRETTY)) return { mesh: 0, stride: 1, outside: false };
  if (cost(pieces, 1) < most) return { mesh: 1, stride: 1, outside: false };
  return { mesh: 2, stride: Math.min(Math.ceil(cost(outside, 2) / most), 48), outside: true };
}

// Measures how long a picture takes, without waiting for it; what was asked for meanwhile is drawn when it is done.
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
