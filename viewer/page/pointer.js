// Mouse and keys.
import { triple } from "./elements.js";
import { showStatus } from "./status.js";

function pixelAt(viewer, event) {
  const box = viewer.canvas.getBoundingClientRect(), place = viewer.place(), picture = viewer.picture(viewer.shown);
  if (!picture) return null;
  const [width, height] = picture.coarse && viewer.scene.size ? viewer.scene.size : [picture.width, picture.height];
  const x = Math.floor((event.clientX - box.left - place.x) / place.width * width);
  const y = Math.floor((event.clientY - box.top - place.y) / place.height * height);
  return x >= 0 && y >= 0 && x < width && y < height ? [x, y] : null;
}

export function listen(viewer, root) {
  let start = null, last = null;
  viewer.stage.addEventListener("pointerdown", (event) => {
    start = last = [event.clientX, event.clientY];
    viewer.stage.setPointerCapture(event.pointerId);
    viewer.stage.focus({ preventScroll: true });
  });
  viewer.stage.addEventListener("pointermove", (event) => {
    if (!start) return hoverAt(viewer, event);
    const dx = event.clientX - last[0], dy = event.clientY - last[1];
    last = [event.clientX, event.clientY];
    if (Math.hypot(last[0] - start[0], last[1] - start[1]) > 3) viewer.dragging = true;
    if (viewer.dragging) drag(viewer, dx, dy, event);
  });
  viewer.stage.addEventListener("pointerup", (event) => {
    const pixel = !viewer.dragging && pixelAt(viewer, event);
    if (pixel) viewer.askPixel(...pixel);
    if (viewer.dragging && viewer.camera && viewer.tool === "camera") move(viewer, false);
    start = null, viewer.dragging = false;
  });
  viewer.stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    wheel(viewer, event);
  }, { passive: false });
  root.addEventListener("keydown", (event) => {
    if (/INPUT|SELECT|TEXTAREA/.test(event.target.tagName)) return;
    if (event.key === "f" || event.key === "F") viewer.flip();
    const chosen = viewer.scene && viewer.scene.pictures[Number(event.key) - 1];
    if (chosen) viewer.choose(chosen.name);
  });
}

function hoverAt(viewer, event) {
  const pixel = pixelAt(viewer, event), picture = viewer.picture(viewer.shown);
  const inside = pixel && !picture.coarse;
  viewer.hover = inside ? `${pixel[0]}, ${pixel[1]}: ${triple(picture.sum(viewer.weights(picture), ...pixel))}` : null;
  showStatus(viewer);
}

function drag(viewer, dx, dy, event) {
  if (viewer.tool === "picture" || !viewer.camera) {
    viewer.zoom.x += dx, viewer.zoom.y += dy;
    return viewer.draw();
  }
  const size = viewer.stage.clientHeight;
  if (event.shiftKey || event.buttons & 4) viewer.camera.pan(dx / size, dy / size);
  else viewer.camera.orbit(4 * dx / size, 4 * dy / size);
  move(viewer, true);
}

function wheel(viewer, event) {
  const factor = 1.0015 ** event.deltaY;
  if (viewer.tool === "camera" && viewer.camera && !event.ctrlKey) {
    viewer.camera.dolly(factor);
    move(viewer, true);
    clearTimeout(viewer.wheelTimer);
    viewer.wheelTimer = setTimeout(() => move(viewer, false), 200);
    return;
  }
  const place = viewer.place(), box = viewer.canvas.getBoundingClientRect();
  const x = event.clientX - box.left - place.x - place.width / 2, y = event.clientY - box.top - place.y - place.height / 2;
  const scale = Math.min(400, Math.max(0.1, viewer.zoom.scale / factor)), ratio = scale / viewer.zoom.scale;
  viewer.zoom = { scale, x: viewer.zoom.x + x * (1 - ratio), y: viewer.zoom.y + y * (1 - ratio) };
  viewer.draw();
}

/** While the camera moves the next message waits for the picture of the one before. */
function move(viewer, moving) {
  viewer.light = viewer.points = null;
  viewer.wanted = { type: "camera", view: viewer.camera.view, moving };
  if (!moving || !viewer.moveSent || performance.now() - viewer.moveSent > 250) sendMove(viewer);
  if (!moving) viewer.askPoints();
}

function sendMove(viewer) {
  if (!viewer.wanted) return;
  viewer.moveSent = performance.now();
  viewer.send(viewer.wanted);
  viewer.wanted = null;
}

export function moveIfWaiting(viewer) {
  viewer.moveSent = 0;
  sendMove(viewer);
}
