// The viewer: what it shows, its panel, and its messages. `transport` has send(message) and calls receive(data) with
// text, or with an ArrayBuffer.
import { ImageCanvas, Picture } from "./image.js";

const BEAUTY = "beauty";

/** An element with properties, and children: nodes or texts. */
function make(tag, properties = {}, ...children) {
  const { className = "", dataset = {}, style = "", ...rest } = properties;
  const node = Object.assign(document.createElement(tag), rest);
  if (className) node.className = className;
  if (style) node.style.cssText = style;
  Object.assign(node.dataset, dataset);
  node.append(...children);
  return node;
}
const row = (...children) => make("div", { className: "row" }, ...children);
const percent = (x) => `${(100 * x).toPrecision(2)} %`;
const short = (x) => (x === null || x === undefined ? "unknown"
  : x !== 0 && Math.abs(x) < 1e-3 ? x.toExponential(2) : x.toPrecision(4));
const triple = (v) => v.map(short).join(" ");

const add = (a, b, k = 1) => a.map((x, i) => x + k * b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a.reduce((s, x, i) => s + x * b[i], 0);
const unit = (a) => a.map((x) => x / Math.hypot(...a));
/** `v` turned about the unit `axis`. */
const turned = (v, axis, angle) => add(add(v.map((x) => x * Math.cos(angle)), cross(axis, v), Math.sin(angle)), axis,
                                       dot(axis, v) * (1 - Math.cos(angle)));

/** A camera as origin, target and up. */
class Camera {
  constructor({ origin, target, up }) { Object.assign(this, { origin, target, up }); }
  get view() { return [...this.origin, ...this.target, ...this.up]; }
  get towards() { return add(this.target, this.origin, -1); }
  get right() { return unit(cross(this.towards, this.up)); }
  orbit(dx, dy) {
    const back = add(this.origin, this.target, -1), up = unit(this.up);
    const level = turned(back, up, -dx);
    const tilted = turned(level, unit(cross(up, level)), -dy);
    if (Math.abs(dot(unit(tilted), up)) < 0.995) this.origin = add(this.target, tilted);
    else this.origin = add(this.target, level);
  }
  pan(dx, dy) {
    const distance = Math.hypot(...this.towards), right = this.right, up = unit(cross(right, this.towards));
    const shift = add(right.map((x) => -x * dx * distance), up, dy * distance);
    this.origin = add(this.origin, shift), this.target = add(this.target, shift);
  }
  dolly(factor) { this.origin = add(this.target, this.towards, -factor); }
}

class Viewer {
  constructor(root, transport) {
    this.transport = transport;
    this.pictures = new Map();    // name -> Picture
    this.scene = null;            // the server's message about it
    this.shown = null;            // name of the picture
    this.other = null;            // name of the second one: difference, split
    this.off = new Set();         // layers that are not in the sum
    this.alone = null;            // the only layer shown
    this.gains = new Map();       // layer -> x1 to x64
    this.display = { mode: 0, exposure: 0, split: null };
    this.zoom = { scale: 1, x: 0, y: 0 };  // of the picture, against fitting into the stage
    this.tool = "camera";
    this.state = {};              // of each render: progress
    this.curves = {};             // of each render: error against time
    this.light = null;            // answer about a pixel
    this.statistics = { frames: 0, coarse: 0, times: [] };
    this.build(root);
    transport.receive = (data) => this.receive(data);
    transport.closed = () => this.problem("The program has ended, or has dropped this page.");
    transport.send({ type: "hello" });
  }

  // ---- Messages
  receive(data) {
    if (typeof data === "string") return this.take(JSON.parse(data));
    const length = new DataView(data).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    if (header.type === "frame") this.takeFrame(header, new Uint16Array(data, 4 + length));
    if (header.type === "file") this.download(header.name, new Blob([new Uint8Array(data, 4 + length)]));
  }
  take(message) {
    if (message.type === "scene") this.takeScene(message);
    else if (message.type === "progress") this.state[message.picture] = { ...message }, this.showStatus();
    else if (message.type === "problem" || message.type === "refused") this.problem(message.text);
    else if (message.type === "pixel") this.takePixel(message);
    else if (message.type === "reproduce") this.takeReproduce(message);
  }
  takeScene(message) {
    const before = this.scene;
    this.scene = message;
    document.title = `mote view ${message.file || ""}`;
    const names = message.pictures.map((p) => p.name);
    for (const name of [...this.pictures.keys()].filter((n) => !names.includes(n)))
      this.pictures.delete(name), this.image.remove(name);
    if (!names.includes(this.shown)) this.shown = names[0] || null;
    if (!names.includes(this.other) || this.other === this.shown)
      this.other = names.find((n) => n !== this.shown) || null;
    if (message.camera && !before) this.camera = new Camera(message.camera);
    if (!message.camera) this.tool = "picture";
    this.buildKnobs();
    this.update();
  }
  takeFrame(header, halves) {
    const picture = new Picture(header, halves), first = !this.pictures.has(header.picture);
    this.transport.send({ type: "got", picture: header.picture });
    this.pictures.set(header.picture, picture);
    this.image.upload(header.picture, picture);
    this.problem("");
    if (first && header.picture === this.shown) this.adaptExposure();
    ++this.statistics.frames;
    if (header.coarse) ++this.statistics.coarse;
    this.statistics.times.push([performance.now(), header.change, header.coarse]);
    this.lastChange = header.change;
    if (header.error !== undefined && header.error !== null) {
      const curve = this.curves[header.picture] ||= { change: -1, points: [] };
      if (curve.change !== header.change) curve.change = header.change, curve.points = [];
      curve.points.push([header.seconds, header.error]);
    }
    this.moveIfWaiting();
    this.update();
  }
  send(message) { this.transport.send(message); }
  problem(text) { this.problemLine.textContent = text; }
  download(name, blob) {
    this.saved = { name, size: blob.size, blob };
    const url = URL.createObjectURL(blob);
    make("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  }

  // ---- What is shown
  picture(name) { return this.pictures.get(name) || null; }
  /** The weight of each layer of a picture in what is shown. */
  weights(picture) {
    const layers = picture.layers, of = (l) => this.gains.get(l.name) || 1;
    if (this.alone) return layers.map((l) => (l.name === this.alone ? of(l) : 0));
    const inSum = layers.filter((l) => l.of_sum);
    if (inSum.length === 0 || (this.off.size === 0 && inSum.every((l) => of(l) === 1)))
      return layers.map((l) => (l.name === BEAUTY ? of(l) : 0));
    return layers.map((l) => (l.of_sum && !this.off.has(l.name) ? of(l) : 0));
  }
  chosen(name) {
    const picture = this.picture(name);
    return picture && { name, picture, weights: this.weights(picture) };
  }
  /** Of the shown picture on the canvas, in its pixels. Coarse ones take the place of whole ones. */
  place() {
    const picture = this.picture(this.shown), { width, height } = this.canvas;
    if (!picture) return { x: 0, y: 0, width: 1, height: 1 };
    const [w, h] = this.scene && this.scene.size ? this.scene.size : [picture.width, picture.height];
    const aspect = picture.coarse ? w / h : picture.width / picture.height;
    const fit = Math.min(width, height * aspect) * this.zoom.scale;
    return { x: (width - fit) / 2 + this.zoom.x, y: (height - fit / aspect) / 2 + this.zoom.y, width: fit, height: fit / aspect };
  }
  adaptExposure() {
    const picture = this.picture(this.shown), weights = this.weights(picture), values = [];
    const step = Math.max(1, Math.floor(picture.width * picture.height / 20000));
    for (let p = 0; p < picture.width * picture.height; p += step) {
      const rgb = picture.sum(weights, p % picture.width, Math.floor(p / picture.width));
      values.push(Math.max(...rgb));
    }
    values.sort((a, b) => a - b);
    const bright = values[Math.floor(0.95 * values.length)];
    this.setExposure(bright > 0 ? Math.round(-4 * Math.log2(bright)) / 4 : 0);
  }
  setExposure(stops) {
    this.display.exposure = stops;
    this.exposureInput.value = stops;
    this.exposureText.textContent = `${stops >= 0 ? "+" : ""}${stops.toFixed(2)} stops`;
    this.draw();
  }
  draw() {
    const second = this.display.mode === 2 || this.display.split !== null ? this.chosen(this.other) : null;
    this.image.draw(this.chosen(this.shown), second, this.place(), this.display);
    this.drawOverlay();
  }
  update() {
    this.buildLayers();
    this.buildPictures();
    this.showStatus();
    this.draw();
    this.drawHistogram();
    this.drawCurves();
  }
  showStatus() {
    const picture = this.picture(this.shown);
    if (!picture) return void (this.statusLine.textContent = "waiting for the first picture");
    const state = this.state[this.shown], parts = [this.shown];
    const known = state && state.change === picture.change && !picture.finished ? state : null;
    if (picture.coarse) parts.push(`coarse, ${picture.width} x ${picture.height}`);
    else if (picture.change !== undefined && picture.passes) {
      parts.push(`pass ${known ? known.passes : picture.passes}${known && known.passes_wanted ? ` of ${known.passes_wanted}` : ""}`);
      if (known) parts.push(`${known.seconds.toFixed(1)} s`);
      if (known && known.seconds_left !== null) parts.push(`${known.seconds_left.toFixed(0)} s left`);
      const noise = known ? known.noise : picture.noise;
      parts.push(noise === null ? "noise unknown" : `noise ${percent(noise)}`);
      parts.push(picture.stated ? `error ${percent(picture.stated[0])} to ${percent(picture.stated[1])}` : "error unknown");
    }
    if (picture.error !== undefined && picture.error !== null)
      parts.push(`error ${percent(picture.error)}, bias ${percent(picture.bias)} against the reference`);
    if (picture.finished && this.scene && this.scene.file) parts.push("finished");
    if (this.hover) parts.push(this.hover);
    this.statusLine.textContent = parts.join("  ·  ");
  }

  // ---- The overlay: values of pixels, dots of lights, legends
  drawOverlay() {
    const c = this.overlay.getContext("2d"), place = this.place(), picture = this.picture(this.shown);
    c.clearRect(0, 0, this.overlay.width, this.overlay.height);
    if (!picture) return;
    const size = place.width / picture.width;
    if (size >= 44) this.drawValues(c, place, size, picture);
    if (this.display.split !== null && this.other) {
      const x = place.x + this.display.split * place.width;
      c.strokeStyle = "#fff";
      c.strokeRect(x, place.y, 0.5, place.height);
    }
    if (this.light) this.drawLight(c, place);
    if (this.display.mode === 1) this.drawLegend(c, "viridis", (t) => (2 ** (10 * t - 8 - this.display.exposure)).toPrecision(2), "radiance");
    if (this.display.mode === 2 && this.other)
      this.drawLegend(c, "signed", (t) => ((2 * t - 1) * 2 ** -this.display.exposure).toPrecision(2), `${this.shown} − ${this.other}`);
  }
  drawValues(c, place, size, picture) {
    const weights = this.weights(picture), from = (o, n) => Math.max(0, Math.floor(-o / size) - n);
    c.font = `${Math.min(12, size / 5)}px monospace`;
    c.textAlign = "center";
    for (let y = from(place.y, 0); y < picture.height && place.y + y * size < this.overlay.height; ++y)
      for (let x = from(place.x, 0); x < picture.width && place.x + x * size < this.overlay.width; ++x) {
        const rgb = picture.sum(weights, x, y);
        const bright = Math.max(...rgb) * 2 ** this.display.exposure > 0.4;
        rgb.forEach((v, i) => {
          c.fillStyle = bright ? ["#600", "#040", "#006"][i] : ["#f99", "#9f9", "#aaf"][i];
          c.fillText(v.toPrecision(3), place.x + (x + 0.5) * size, place.y + (y + 0.3 + 0.25 * i) * size);
        });
      }
  }
  /** VPLs as dots whose area is their contribution, and the vertices of the eye path. */
  drawLight(c, place) {
    const at = ([x, y]) => [place.x + x / this.scene.size[0] * place.width, place.y + y / this.scene.size[1] * place.height];
    const light = this.light.light;
    const brightest = Math.max(1e-30, ...light.vpls.map((v) => Math.max(...v.all)));
    for (const vpl of light.vpls) {
      if (!vpl.film) continue;
      c.beginPath();
      c.arc(...at(vpl.film), 2 + 9 * Math.sqrt(Math.max(...vpl.all) / brightest), 0, 7);
      c.fillStyle = "#ffd23a99", c.strokeStyle = "#000";
      c.fill(), c.stroke();
    }
    c.beginPath();
    for (const vertex of light.path) if (vertex.film) c.lineTo(...at(vertex.film));
    c.strokeStyle = "#4df", c.lineWidth = 2;
    c.stroke(), c.lineWidth = 1;
    for (const vertex of light.path) if (vertex.film) c.strokeRect(at(vertex.film)[0] - 4, at(vertex.film)[1] - 4, 8, 8);
    const [x, y] = at([this.light.x + 0.5, this.light.y + 0.5]);
    c.strokeStyle = "#f0f";
    c.strokeRect(x - 6, y - 6, 12, 12);
  }
  drawLegend(c, kind, text, title) {
    const height = 180, x = this.overlay.width - 70, y = 30;
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

  // ---- Plots of the panel
  drawHistogram() {
    const picture = this.picture(this.shown), c = this.histogram.getContext("2d"), { width, height } = this.histogram;
    c.clearRect(0, 0, width, height);
    if (!picture || !this.histogram.closest("details").open) return;
    const weights = this.weights(picture), bins = [0, 1, 2].map(() => new Float64Array(64));
    const step = Math.max(1, Math.floor(picture.width * picture.height / 30000));
    for (let p = 0; p < picture.width * picture.height; p += step)
      picture.sum(weights, p % picture.width, Math.floor(p / picture.width)).forEach((v, k) => {
        const stops = Math.log2(v) + this.display.exposure;  // 0 is white
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
  drawCurves() {
    const c = this.curve.getContext("2d"), { width, height } = this.curve;
    c.clearRect(0, 0, width, height);
    const points = Object.values(this.curves).flatMap((curve) => curve.points).filter(([s, e]) => s > 0 && e > 0);
    if (points.length === 0) return;
    const range = (values) => [Math.log10(Math.min(...values)) - 0.05, Math.log10(Math.max(...values)) + 0.05];
    const [s0, s1] = range(points.map((p) => p[0])), [e0, e1] = range(points.map((p) => p[1]));
    const at = ([s, e]) => [30 + (width - 34) * (Math.log10(s) - s0) / (s1 - s0), (height - 16) * (1 - (Math.log10(e) - e0) / (e1 - e0)) + 2];
    Object.entries(this.curves).forEach(([name, curve], k) => {
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

  // ---- The panel
  build(root) {
    root.replaceChildren();
    root.classList.add("mote-view");
    this.canvas = make("canvas"), this.overlay = make("canvas", { className: "overlay" });
    this.statusLine = make("div", { className: "status" }), this.problemLine = make("div", { className: "problem" });
    this.stage = make("div", { className: "stage", tabIndex: 0 }, this.canvas, this.overlay, this.problemLine, this.statusLine);
    const part = (title, open, ...children) => make("details", { open }, make("summary", {}, title), ...children);
    this.pictureList = make("div", { className: "row" });
    this.layerList = make("div"), this.knobList = make("div"), this.pixelInfo = make("div"), this.reproduceInfo = make("div");
    this.histogram = make("canvas", { className: "plot", width: 290, height: 90 });
    this.curve = make("canvas", { className: "plot", width: 290, height: 90 });
    this.secondRow = make("div");
    root.append(this.stage, make("div", { className: "panel" },
      part("picture", true, this.pictureList, this.displayControls()),
      part("layers", true, this.layerList),
      part("histogram", false, this.histogram),
      part("render", true, this.renderControls(), this.knobList),
      part("compare", false, this.secondRow, this.curve, make("div", { className: "hint" },
        "Both methods have half of the threads. Error against time needs --reference.")),
      part("light of a pixel", true, this.pixelInfo),
      part("save", false, this.saveControls(), this.reproduceInfo)));
    this.pixelInfo.append(make("div", { className: "hint" }, "Click a pixel."));
    this.image = new ImageCanvas(this.canvas);
    this.listen(root);
    new ResizeObserver(() => this.resize()).observe(this.stage);
    this.resize();
  }
  resize() {
    for (const canvas of [this.canvas, this.overlay])
      canvas.width = Math.max(1, this.stage.clientWidth), canvas.height = Math.max(1, this.stage.clientHeight);
    this.draw();
  }
  displayControls() {
    this.exposureText = make("span", { className: "unit" });
    this.exposureInput = make("input", { type: "range", min: -16, max: 16, step: 0.25, value: 0,
      oninput: () => this.setExposure(Number(this.exposureInput.value)) });
    const mode = make("select", { onchange: () => { this.display.mode = Number(mode.value); this.draw(); } },
      ...["colour", "false colour", "difference"].map((text, value) => make("option", { value }, text)));
    this.modeInput = mode;
    this.splitInput = make("input", { type: "range", min: 0, max: 1, step: 0.005, value: 0.5,
      oninput: () => { this.display.split = Number(this.splitInput.value); this.draw(); } });
    const split = make("button", { onclick: () => {
      this.display.split = this.display.split === null ? Number(this.splitInput.value) : null;
      split.classList.toggle("on", this.display.split !== null);
      this.draw();
    } }, "split");
    this.splitButton = split;
    const tool = make("select", { onchange: () => { this.tool = tool.value; } },
      make("option", { value: "camera" }, "moves the camera"), make("option", { value: "picture" }, "moves the picture"));
    this.toolInput = tool;
    return make("div", {},
      row(make("span", {}, "exposure"), this.exposureInput, this.exposureText,
        make("button", { onclick: () => this.adaptExposure() }, "adapt")),
      row(make("span", {}, "show"), mode, split, this.splitInput),
      row(make("span", {}, "mouse"), tool, make("button", { onclick: () => { this.zoom = { scale: 1, x: 0, y: 0 }; this.draw(); } }, "fit")),
      make("div", { className: "hint" }, "Keys: F flips, 1 to 9 choose a picture. Shift-drag pans, the wheel dollies; Ctrl and the wheel zoom the picture to its values."));
  }
  buildPictures() {
    if (!this.scene) return;
    this.pictureList.replaceChildren(...this.scene.pictures.map(({ name }) => make("button", {
      className: name === this.shown ? "on" : "", onclick: () => this.choose(name) }, name)));
  }
  choose(name) {
    if (name === this.shown) return;
    [this.shown, this.other] = [name, this.shown];
    this.buildKnobs();
    this.update();
  }
  flip() { if (this.other) this.choose(this.other); }
  buildLayers() {
    const picture = this.picture(this.shown);
    if (!picture) return;
    const names = JSON.stringify([picture.layers, this.alone, [...this.off], [...this.gains]]);
    if (names === this.layersBuilt) return;
    this.layersBuilt = names;
    this.layerList.replaceChildren(...picture.layers.map((layer) => {
      const { name } = layer, gain = this.gains.get(name) || 1;
      const check = make("input", { type: "checkbox", checked: layer.of_sum && !this.off.has(name), disabled: !layer.of_sum,
        dataset: { layer: name }, onchange: () => this.toggle(name, check.checked) });
      const alone = make("button", { className: this.alone === name ? "on" : "", dataset: { alone: name },
        onclick: () => this.showAlone(this.alone === name ? null : name) }, "alone");
      const times = make("select", { onchange: () => { this.gains.set(name, Number(times.value)); this.update(); } },
        ...[1, 2, 4, 8, 16, 32, 64].map((k) => make("option", { value: k, selected: k === gain }, `x${k}`)));
      return row(make("label", { title: name }, check, ` ${name}`), alone, times);
    }));
  }
  toggle(name, on) {
    if (on) this.off.delete(name);
    else this.off.add(name);
    this.alone = null;
    this.update();
  }
  showAlone(name) { this.alone = name; this.update(); }

  // ---- Knobs
  renderControls() {
    return row(make("button", { onclick: () => this.send({ type: "stop" }) }, "stop"),
      make("button", { onclick: () => this.send({ type: "start" }) }, "start again"),
      make("span", {}));
  }
  live() { return this.scene && this.scene.pictures.find((p) => p.name === this.shown && p.live); }
  buildKnobs() {
    if (!this.scene) return;
    const live = this.live();
    this.buildSecond();
    if (!live) return void this.knobList.replaceChildren(make("div", { className: "hint" }, "A picture from a file."));
    const open = new Set([...this.knobList.querySelectorAll("details[open]")].map((d) => d.dataset.title));
    const plain = (name, value) => make("input", { type: "text", value, dataset: { knob: name },
      onchange: (event) => this.send({ type: "set", picture: this.shown, [name]: Number(event.target.value) }) });
    const groups = this.scene.knobs[this.shown] || [];
    this.knobList.replaceChildren(
      row(make("span", {}, "passes"), plain("passes", live.changes.passes || this.scene.sample_count)),
      row(make("span", {}, "seed"), plain("seed", live.changes.seed)),
      ...groups.map((group) => this.knobGroup(group, live, open.has(group.title) || group.kind === "integrator")));
  }
  knobGroup(group, live, open) {
    const children = [];
    if (group.kind === "integrator") {
      const choice = make("select", { dataset: { knob: "integrator" },
        onchange: () => this.send({ type: "set", picture: this.shown, integrator: choice.value }) },
        ...group.types.map((type) => make("option", { value: type, selected: type === group.type }, type)));
      children.push(row(make("span", {}, "type"), choice));
    }
    children.push(...group.knobs.map((knob) => this.knobRow(knob, live)));
    return make("details", { open, dataset: { title: group.title } }, make("summary", {}, `${group.title} (${group.type})`), ...children);
  }
  knobRow(knob, live) {
    const value = live.changes.defines[knob.path] ?? knob.value;
    const set = (text) => this.send({ type: "set", picture: this.shown, define: { [knob.path]: text === "" ? null : String(text) } });
    let input;
    const choices = knob.type === "boolean" ? ["true", "false"] : knob.choices;
    if (choices.length > 0) {
      input = make("select", { onchange: () => set(input.value) }, make("option", { value: "" }, `(${knob.default || "none"})`),
        ...choices.map((c) => make("option", { value: c, selected: c === value }, c)));
    } else {
      input = make("input", { type: "text", value, placeholder: knob.default, onchange: () => set(input.value) });
    }
    input.dataset.knob = knob.path;
    const parts = [make("label", { title: `${knob.sentence} ${knob.values}` }, knob.name), input];
    if (knob.unit) parts.push(make("span", { className: "unit" }, knob.unit));
    if (["float", "integer", "rgb"].includes(knob.type) && value) parts.push(this.turns(knob, value, set));
    return row(...parts);
  }
  /** Half and twice: of a number within its range, or of all of a colour. */
  turns(knob, value, set) {
    const times = (factor) => {
      const numbers = value.split(/[ ,]+/).map((x) => {
        let v = Number(x) * factor;
        if (knob.type === "integer") v = Math.round(v);
        return Math.min(knob.upper ?? Infinity, Math.max(knob.lower ?? -Infinity, v));
      });
      if (numbers.every(Number.isFinite)) set(numbers.map((v) => Number(v.toPrecision(7))).join(" "));
    };
    return make("span", {}, make("button", { title: "half", onclick: () => times(0.5) }, "÷2"),
      make("button", { title: "twice", dataset: { twice: knob.path }, onclick: () => times(2) }, "×2"));
  }
  buildSecond() {
    const groups = this.scene.knobs && this.scene.knobs.A;
    if (!groups) return void this.secondRow.replaceChildren();
    const on = this.scene.pictures.some((p) => p.name === "B");
    const types = groups.find((g) => g.kind === "integrator").types;
    const choice = make("select", { dataset: { knob: "second" }, onchange: () => this.send({ type: "second", integrator: choice.value || null }) },
      make("option", { value: "" }, "(none)"),
      ...types.map((t) => make("option", { value: t, selected: on && this.scene.pictures.find((p) => p.name === "B").changes.integrator === t }, t)));
    this.secondRow.replaceChildren(row(make("span", {}, "second method B"), choice));
  }

  // ---- The light of a pixel
  askPixel(x, y) {
    this.asked = [x, y];
    this.send({ type: "pixel", picture: this.shown, x, y });
  }
  takePixel(message) {
    this.light = message.light ? message : null;
    const info = [make("div", {}, `pixel ${message.x}, ${message.y} of ${message.picture}`)];
    info.push(make("table", {}, ...message.values.map(({ layer, channels, values }) => make("tr", {},
      make("th", { title: channels.join(", ") }, layer), ...values.map((v) => make("td", {}, short(v)))))));
    if (message.light) info.push(...this.lightInfo(message.light));
    this.pixelInfo.replaceChildren(...info);
    this.drawOverlay();
  }
  lightInfo(light) {
    const first = light.first, lines = [];
    if (first) {
      lines.push(`shape ${first.shape}, depth ${short(first.depth)} m, at ${triple(first.position)}`,
        `normal ${triple(first.geometric_normal)} (shading ${triple(first.shading_normal)})${first.in_medium ? ", eye in a medium" : ""}`);
    } else lines.push("The ray meets no surface.");
    lines.push(`eye path of pass 0: ${light.path.length} vertices`);
    lines.push(`VPL set of pass 0: ${light.lights} of ${light.paths} paths, ${light.lit_by} light this pixel; bound ${light.bound === null ? "none" : short(light.bound)} 1/m²`);
    lines.push(`bounded sum ${triple(light.sum)}`, `residual that the bound takes ${triple(light.residual)}`);
    lines.push("Cuts, clusters and map texels are not recorded: all VPLs are evaluated.");
    return [...lines.map((text) => make("div", { className: "hint" }, text)),
      make("table", {}, make("tr", {}, ...["VPL", "bounce", "bounded", "unbounded"].map((t) => make("th", {}, t))),
        ...light.vpls.slice(0, 12).map((v) => make("tr", {}, make("td", {}, String(v.index)), make("td", {}, String(v.depth)),
          make("td", {}, Math.max(...v.bounded).toPrecision(3)), make("td", {}, Math.max(...v.all).toPrecision(3)))))];
  }

  // ---- Saving
  saveControls() {
    return row(make("button", { onclick: () => this.send({ type: "save", picture: this.shown }) }, "EXR"),
      make("button", { onclick: () => this.canvas.toBlob((blob) => this.download("view.png", blob)) }, "PNG as shown"),
      make("button", { onclick: () => this.send({ type: "reproduce", picture: this.shown }) }, "command and XML"), make("span", {}));
  }
  takeReproduce({ command, xml }) {
    this.reproduced = { command, xml };
    const copy = (text) => make("button", { onclick: () => navigator.clipboard.writeText(text) }, "copy");
    this.reproduceInfo.replaceChildren(row(make("span", {}, "command line"), copy(command)), make("pre", {}, command),
      row(make("span", {}, "scene file, to stand beside the scene's own"), copy(xml)));
  }

  // ---- Mouse and keys
  pixelAt(event) {
    const box = this.canvas.getBoundingClientRect(), place = this.place(), picture = this.picture(this.shown);
    if (!picture) return null;
    const [width, height] = picture.coarse && this.scene.size ? this.scene.size : [picture.width, picture.height];
    const x = Math.floor((event.clientX - box.left - place.x) / place.width * width);
    const y = Math.floor((event.clientY - box.top - place.y) / place.height * height);
    return x >= 0 && y >= 0 && x < width && y < height ? [x, y] : null;
  }
  listen(root) {
    let start = null, last = null;
    this.stage.addEventListener("pointerdown", (event) => {
      start = last = [event.clientX, event.clientY];
      this.stage.setPointerCapture(event.pointerId);
      this.stage.focus({ preventScroll: true });
    });
    this.stage.addEventListener("pointermove", (event) => {
      if (!start) return this.hoverAt(event);
      const dx = event.clientX - last[0], dy = event.clientY - last[1];
      last = [event.clientX, event.clientY];
      if (Math.hypot(last[0] - start[0], last[1] - start[1]) > 3) this.dragging = true;
      if (this.dragging) this.drag(dx, dy, event);
    });
    this.stage.addEventListener("pointerup", (event) => {
      const pixel = !this.dragging && this.pixelAt(event);
      if (pixel) this.askPixel(...pixel);
      if (this.dragging && this.camera && this.tool === "camera") this.move(false);
      start = null, this.dragging = false;
    });
    this.stage.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.wheel(event);
    }, { passive: false });
    root.addEventListener("keydown", (event) => {
      if (/INPUT|SELECT|TEXTAREA/.test(event.target.tagName)) return;
      if (event.key === "f" || event.key === "F") this.flip();
      const chosen = this.scene && this.scene.pictures[Number(event.key) - 1];
      if (chosen) this.choose(chosen.name);
    });
  }
  hoverAt(event) {
    const pixel = this.pixelAt(event), picture = this.picture(this.shown);
    const inside = pixel && !picture.coarse;
    this.hover = inside ? `${pixel[0]}, ${pixel[1]}: ${triple(picture.sum(this.weights(picture), ...pixel))}` : null;
    this.showStatus();
  }
  drag(dx, dy, event) {
    if (this.tool === "picture" || !this.camera) {
      this.zoom.x += dx, this.zoom.y += dy;
      return this.draw();
    }
    const size = this.stage.clientHeight;
    if (event.shiftKey || event.buttons & 4) this.camera.pan(dx / size, dy / size);
    else this.camera.orbit(4 * dx / size, 4 * dy / size);
    this.move(true);
  }
  wheel(event) {
    const factor = 1.0015 ** event.deltaY;
    if (this.tool === "camera" && this.camera && !event.ctrlKey) {
      this.camera.dolly(factor);
      this.move(true);
      clearTimeout(this.wheelTimer);
      this.wheelTimer = setTimeout(() => this.move(false), 200);
      return;
    }
    const place = this.place(), box = this.canvas.getBoundingClientRect();
    const x = event.clientX - box.left - place.x - place.width / 2, y = event.clientY - box.top - place.y - place.height / 2;
    const scale = Math.min(400, Math.max(0.1, this.zoom.scale / factor)), ratio = scale / this.zoom.scale;
    this.zoom = { scale, x: this.zoom.x + x * (1 - ratio), y: this.zoom.y + y * (1 - ratio) };
    this.draw();
  }
  /** While the camera moves the next message waits for the picture of the one before. */
  move(moving) {
    this.light = null;
    this.wanted = { type: "camera", view: this.camera.view, moving };
    if (!moving || !this.moveSent || performance.now() - this.moveSent > 250) this.sendMove();
  }
  sendMove() {
    if (!this.wanted) return;
    this.moveSent = performance.now();
    this.send(this.wanted);
    this.wanted = null;
  }
  moveIfWaiting() {
    this.moveSent = 0;
    this.sendMove();
  }
}

export function start(root, transport) { return new Viewer(root, transport); }
