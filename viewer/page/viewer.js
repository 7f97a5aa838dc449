// The viewer: what it shows, and its messages. `transport` has send(message) and calls receive(data) with text, or with
// an ArrayBuffer.
import { Camera } from "./camera.js";
import { adaptExposure, buildLayers, buildPictures, displayControls } from "./display.js";
import { make, row } from "./elements.js";
import { ImageCanvas, Picture } from "./image.js";
import { buildKnobs, renderControls } from "./knobs.js";
import { drawOverlay } from "./overlay.js";
import { pixelInfo } from "./pixel_info.js";
import { drawCurves, drawHistogram } from "./plots.js";
import { listen, moveIfWaiting } from "./pointer.js";
import { saveControls, showReproduced } from "./save.js";
import { showStatus } from "./status.js";

const BEAUTY = "beauty";

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
    this.points = null;           // VPLs or photons over the image
    this.statistics = { frames: 0, coarse: 0 };
    this.build(root);
    transport.receive = (data) => this.receive(data);
    transport.closed = () => this.problem("The program has ended, or has dropped this page.");
    transport.send({ type: "hello" });
  }
  receive(data) {
    if (typeof data === "string") return this.take(JSON.parse(data));
    const length = new DataView(data).getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length)));
    if (header.type === "frame") this.takeFrame(header, new Uint16Array(data, 4 + length));
    if (header.type === "file") this.download(header.name, new Blob([new Uint8Array(data, 4 + length)]));
  }
  take(message) {
    if (message.type === "scene") this.takeScene(message);
    else if (message.type === "progress") this.state[message.picture] = { ...message }, showStatus(this);
    else if (message.type === "problem" || message.type === "refused") this.problem(message.text);
    else if (message.type === "pixel") this.takePixel(message);
    else if (message.type === "lights") this.takePoints(message);
    else if (message.type === "reproduce") showReproduced(this, message);
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
    buildKnobs(this);
    this.askPoints();
    this.update();
  }
  takeFrame(header, halves) {
    const picture = new Picture(header, halves), first = !this.pictures.has(header.picture);
    this.transport.send({ type: "got", picture: header.picture });
    this.pictures.set(header.picture, picture);
    this.image.upload(header.picture, picture);
    this.problem("");
    if (first && header.picture === this.shown) adaptExposure(this);
    ++this.statistics.frames;
    if (header.coarse) ++this.statistics.coarse;
    this.lastChange = header.change;
    if (header.error !== undefined && header.error !== null) {
      const curve = this.curves[header.picture] ||= { change: -1, points: [] };
      if (curve.change !== header.change) curve.change = header.change, curve.points = [];
      curve.points.push([header.seconds, header.error]);
    }
    moveIfWaiting(this);
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
  setExposure(stops) {
    this.display.exposure = stops;
    this.exposureInput.value = stops;
    this.exposureText.textContent = `${stops >= 0 ? "+" : ""}${stops.toFixed(2)} stops`;
    this.draw();
  }
  draw() {
    const second = this.display.mode === 2 || this.display.split !== null ? this.chosen(this.other) : null;
    this.image.draw(this.chosen(this.shown), second, this.place(), this.display);
    drawOverlay(this);
  }
  update() {
    buildLayers(this);
    buildPictures(this);
    showStatus(this);
    this.draw();
    drawHistogram(this);
    drawCurves(this);
  }
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
    this.pointsInput = make("input", { type: "checkbox", onchange: () => this.askPoints() });
    this.pointsText = make("span", { className: "unit" });
    root.append(this.stage, make("div", { className: "panel" },
      part("picture", true, this.pictureList, displayControls(this)),
      part("layers", true, this.layerList),
      part("histogram", false, this.histogram),
      part("render", true, renderControls(this), this.knobList),
      part("compare", false, this.secondRow, this.curve, make("div", { className: "hint" },
        "Both methods have half of the threads. Error against time needs --reference.")),
      part("light of a pixel", true, row(make("label", {}, this.pointsInput, " VPLs or photons over the image"), this.pointsText),
        this.pixelInfo),
      part("save", false, saveControls(this), this.reproduceInfo)));
    this.pixelInfo.append(make("div", { className: "hint" }, "Click a pixel."));
    this.image = new ImageCanvas(this.canvas);
    listen(this, root);
    new ResizeObserver(() => this.resize()).observe(this.stage);
    this.resize();
  }
  resize() {
    for (const canvas of [this.canvas, this.overlay])
      canvas.width = Math.max(1, this.stage.clientWidth), canvas.height = Math.max(1, this.stage.clientHeight);
    this.draw();
  }
  choose(name) {
    if (name === this.shown) return;
    [this.shown, this.other] = [name, this.shown];
    buildKnobs(this);
    this.askPoints();
    this.update();
  }
  flip() { if (this.other) this.choose(this.other); }
  toggle(name, on) {
    if (on) this.off.delete(name);
    else this.off.add(name);
    this.alone = null;
    this.update();
  }
  showAlone(name) { this.alone = name; this.update(); }
  live() { return this.scene && this.scene.pictures.find((p) => p.name === this.shown && p.live); }
  askPixel(x, y) {
    this.asked = [x, y];
    this.send({ type: "pixel", picture: this.shown, x, y });
  }
  takePixel(message) {
    this.light = message.light ? message : null;
    this.pixelInfo.replaceChildren(...pixelInfo(message));
    drawOverlay(this);
  }
  /** Points are those of the scene as it is now. */
  askPoints() {
    this.points = null;
    if (this.pointsInput.checked && this.live()) this.send({ type: "lights", picture: this.shown });
    drawOverlay(this);
  }
  takePoints(message) {
    if (!this.pointsInput.checked || message.picture !== this.shown) return;
    this.points = message;
    this.pointsText.textContent = `${message.points.length} of ${message.count} ${message.kind}s, by ${message.method}`;
    drawOverlay(this);
  }
}

export function start(root, transport) { return new Viewer(root, transport); }
