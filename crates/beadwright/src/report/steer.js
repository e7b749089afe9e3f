// A camera steered by mouse, touch and keys.

const SIDES = { 7: [0, 1.55], 1: [0, 0], 3: [Math.PI / 2, 0], 0: [-0.6, 0.55] };

// The factor by which a turn of the wheel zooms.
const wheelFactor = ({ deltaY, deltaMode }) => Math.exp(-Math.max(-400, Math.min(400, deltaY * (deltaMode ? 33 : 1))) * 0.0016);

// `changed` is called after every move; `hands` may have begin, hover and press (a click that moved nothing).
function steerCamera(canvas, camera, changed, hands = {}) {
  const down = new Map(), aspect = () => canvas.clientWidth / canvas.clientHeight;
  let moved = 0;
  const at = event => [event.offsetX / canvas.clientWidth * 2 - 1, 1 - event.offsetY / canvas.clientHeight * 2];
  const middle = () => [...down.values()].reduce((m, p) => [m[0] + p[0] / down.size, m[1] + p[1] / down.size], [0, 0]);
  const spread = () => { const [a, b] = [...down.values()]; return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0; };
  canvas.onpointerdown = event => {
    canvas.setPointerCapture(event.pointerId);
    down.set(event.pointerId, [event.offsetX, event.offsetY]);
    moved = 0;
    hands.begin?.();
  };
  canvas.onpointermove = event => {
    if (!down.has(event.pointerId)) return hands.hover?.(event);
    const [fromX, fromY] = middle(), before = spread();
    down.set(event.pointerId, [event.offsetX, event.offsetY]);
    const [toX, toY] = middle(), height = canvas.clientHeight, [x, y] = [toX - fromX, toY - fromY];
    moved += Math.abs(x) + Math.abs(y);
    if (down.size > 1 || event.shiftKey || event.buttons > 1) panCamera(camera, x / height, y / height);
    else turnCamera(camera, -x * 0.008, y * 0.008);
    if (before > 0) zoomCamera(camera, spread() / before, ...at(event), aspect());
    changed();
  };
  canvas.onpointerup = event => {
    down.delete(event.pointerId);
    if (moved <= 4 && event.button === 0) hands.press?.(event);
  };
  canvas.onpointercancel = event => down.delete(event.pointerId);
  canvas.oncontextmenu = event => event.preventDefault();
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    zoomCamera(camera, wheelFactor(event), ...at(event), aspect());
    changed();
  }, { passive: false });
  canvas.ondblclick = () => { camera.fitted = true; changed(); };
  canvas.onkeydown = event => {
    if (!steeredByKey(camera, event, aspect())) return;
    event.preventDefault();
    changed();
  };
}

// Whether a key means anything to the camera.
function steeredByKey(camera, { key, shiftKey, ctrlKey, metaKey, altKey }, aspect) {
  const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
  if (ctrlKey || metaKey || altKey) return false;
  if (way && shiftKey) panCamera(camera, way[0] * 0.08, way[1] * 0.08);
  else if (way) turnCamera(camera, way[0] * 0.15, -way[1] * 0.15);
  else if (key === "+" || key === "=") zoomCamera(camera, 1.25, 0, 0, aspect);
  else if (key === "-") zoomCamera(camera, 0.8, 0, 0, aspect);
  else if (key === "f") camera.fitted = true;
  else if (SIDES[key]) Object.assign(camera, { yaw: SIDES[key][0], pitch: SIDES[key][1], fitted: true });
  else return false;
  return true;
}
