// Plots of the panel.

export function drawHistogram(viewer) {
  const picture = viewer.picture(viewer.shown), c = viewer.histogram.getContext("2d"), { width, height } = viewer.histogram;
  c.clearRect(0, 0, width, height);
  if (!picture || !viewer.histogram.closest("details").open) return;
  const weights = viewer.weights(picture), bins = [0, 1, 2].map(() => new Float64Array(64));
  const step = Math.max(1, Math.floor(picture.width * picture.height / 30000));
  for (let p = 0; p < picture.width * picture.height; p += step)
    picture.sum(weights, p % picture.width, Math.floor(p / picture.width)).forEach((v, k) => {
      const stops = Math.log2(v) + viewer.display.exposure;  // 0 is white
      if (stops > -12 && stops < 4) ++bins[k][Math.floor((stops + 12) * 4)];
    });
  const most = Math.max(1, ...bins.map((b) => Math.max(...b)));
  c.globalCompositeOperation = "lighter";
  bins.forEach((b, k) => {
    c.fillStyle = ["#a33", "#3a3", "#44c"][k];
    b.forEach((n, i) => c.fillRect(i * width / 64, height * (1 - n / most), width / 64, height * n / most));
  });
  c.globalCompositeOperation = "source-over";
  c.fillStyle = "#fff";
  c.fillRect(width * 12 / 16, 0, 1, height);
}

/** Error against time, both logarithmic. */
export function drawCurves(viewer) {
  const c = viewer.curve.getContext("2d"), { width, height } = viewer.curve;
  c.clearRect(0, 0, width, height);
  const points = Object.values(viewer.curves).flatMap((curve) => curve.points).filter(([s, e]) => s > 0 && e > 0);
  if (points.length === 0) return;
  const range = (values) => [Math.log10(Math.min(...values)) - 0.05, Math.log10(Math.max(...values)) + 0.05];
  const [s0, s1] = range(points.map((p) => p[0])), [e0, e1] = range(points.map((p) => p[1]));
  const at = ([s, e]) => [30 + (width - 34) * (Math.log10(s) - s0) / (s1 - s0), (height - 16) * (1 - (Math.log10(e) - e0) / (e1 - e0)) + 2];
  Object.entries(viewer.curves).forEach(([name, curve], k) => {
    c.strokeStyle = c.fillStyle = ["#5af", "#fa5"][k % 2];
    c.beginPath();
    for (const p of curve.points) c.lineTo(...at(p));
    c.stroke();
    for (const p of curve.points) c.fillRect(at(p)[0] - 1.5, at(p)[1] - 1.5, 3, 3);
    c.fillText(name, width - 16 - 14 * (1 - k), 12);
  });
  c.fillStyle = "#aaa", c.font = "10px sans-serif";
  c.fillText(`${(100 * 10 ** e1).toPrecision(2)}%`, 0, 10);
  c.fillText(`${(100 * 10 ** e0).toPrecision(2)}%`, 0, height - 18);
  c.fillText(`${(10 ** s0).toPrecision(2)} s`, 30, height - 3);
  c.fillText(`${(10 ** s1).toPrecision(2)} s`, width - 40, height - 3);
}
