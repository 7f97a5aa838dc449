// The overlay of the image: values of pixels, lights, legends.

export function drawOverlay(viewer) {
  const c = viewer.overlay.getContext("2d"), place = viewer.place(), picture = viewer.picture(viewer.shown);
  c.clearRect(0, 0, viewer.overlay.width, viewer.overlay.height);
  if (!picture) return;
  const size = place.width / picture.width;
  if (size >= 44) drawValues(viewer, c, place, size, picture);
  if (viewer.display.split !== null && viewer.other) {
    const x = place.x + viewer.display.split * place.width;
    c.strokeStyle = "#fff";
    c.strokeRect(x, place.y, 0.5, place.height);
  }
  const at = ([x, y]) => [place.x + x / viewer.scene.size[0] * place.width, place.y + y / viewer.scene.size[1] * place.height];
  if (viewer.points) drawPoints(viewer, c, at);
  if (viewer.light) drawLight(viewer, c, at);
  if (viewer.display.mode === 1) drawLegend(viewer, c, "viridis", (t) => (2 ** (10 * t - 8 - viewer.display.exposure)).toPrecision(2), "radiance");
  if (viewer.display.mode === 2 && viewer.other)
    drawLegend(viewer, c, "signed", (t) => ((2 * t - 1) * 2 ** -viewer.display.exposure).toPrecision(2), `${viewer.shown} − ${viewer.other}`);
}

function drawValues(viewer, c, place, size, picture) {
  const weights = viewer.weights(picture), from = (o, n) => Math.max(0, Math.floor(-o / size) - n);
  c.font = `${Math.min(12, size / 5)}px monospace`;
  c.textAlign = "center";
  for (let y = from(place.y, 0); y < picture.height && place.y + y * size < viewer.overlay.height; ++y)
    for (let x = from(place.x, 0); x < picture.width && place.x + x * size < viewer.overlay.width; ++x) {
      const rgb = picture.sum(weights, x, y);
      const bright = Math.max(...rgb) * 2 ** viewer.display.exposure > 0.4;
      rgb.forEach((v, i) => {
        c.fillStyle = bright ? ["#600", "#040", "#006"][i] : ["#f99", "#9f9", "#aaf"][i];
        c.fillText(v.toPrecision(3), place.x + (x + 0.5) * size, place.y + (y + 0.3 + 0.25 * i) * size);
      });
    }
}

/** The points that light the pixel as dots whose area is their light, and the vertices of its eye path. */
function drawLight(viewer, c, at) {
  const { light, x, y } = viewer.light;
  const brightest = Math.max(1e-30, ...light.sources.map((s) => Math.max(...s.light)));
  for (const source of light.sources) {
    if (!source.film) continue;
    c.beginPath();
    c.arc(...at(source.film), 2 + 9 * Math.sqrt(Math.max(...source.light) / brightest), 0, 7);
    c.fillStyle = "#ffd23a99", c.strokeStyle = "#000";
    c.fill(), c.stroke();
  }
  c.beginPath();
  for (const vertex of light.path) if (vertex.film) c.lineTo(...at(vertex.film));
  c.strokeStyle = "#4df", c.lineWidth = 2;
  c.stroke(), c.lineWidth = 1;
  for (const vertex of light.path) if (vertex.film) c.strokeRect(at(vertex.film)[0] - 4, at(vertex.film)[1] - 4, 8, 8);
  const [px, py] = at([x + 0.5, y + 0.5]);
  c.strokeStyle = "#f0f";
  c.strokeRect(px - 6, py - 6, 12, 12);
}

/** All points of pass 0 that the camera sees: brighter for more power. */
function drawPoints(viewer, c, at) {
  for (const [x, y, ...power] of viewer.points.points) {
    const [r, g, b] = power.map((p) => Math.round(60 + 195 * Math.sqrt(p)));
    const [px, py] = at([x, y]);
    c.fillStyle = `rgb(${r},${g},${b})`, c.strokeStyle = "#000";
    c.beginPath(), c.arc(px, py, 2.5, 0, 7), c.fill(), c.stroke();
  }
}

function drawLegend(viewer, c, kind, text, title) {
  const height = 180, x = viewer.overlay.width - 70, y = 30;
  for (let i = 0; i < height; ++i) {
    const t = 1 - i / height, s = 2 * t - 1;
    const mix = (end) => `rgb(${[0, 1, 2].map((k) => Math.round(255 + Math.abs(s) * (end[k] - 255))).join()})`;
    const stops = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]], j = Math.min(3, Math.floor(4 * t));
    c.fillStyle = kind === "signed" ? mix(s > 0 ? [191, 5, 13] : [8, 51, 191])
      : `rgb(${stops[j].map((v, k) => Math.round(v + (4 * t - j) * (stops[j + 1][k] - v))).join()})`;
    c.fillRect(x, y + i, 16, 1);
  }
  c.font = "11px sans-serif", c.textAlign = "left", c.fillStyle = "#fff";
  c.shadowColor = "#000", c.shadowBlur = 3;
  for (let k = 0; k <= 4; ++k) c.fillText(text(1 - k / 4), x + 20, y + 4 + k * height / 4);
  c.textAlign = "right";
  c.fillText(title, x + 60, y - 12);
  c.shadowBlur = 0;
}
