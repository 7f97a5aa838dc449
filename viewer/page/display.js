// Which image is shown, which layers of it, and how.
import { make, row } from "./elements.js";

export function adaptExposure(viewer) {
  const picture = viewer.picture(viewer.shown), weights = viewer.weights(picture), values = [];
  const step = Math.max(1, Math.floor(picture.width * picture.height / 20000));
  for (let p = 0; p < picture.width * picture.height; p += step) {
    const rgb = picture.sum(weights, p % picture.width, Math.floor(p / picture.width));
    values.push(Math.max(...rgb));
  }
  values.sort((a, b) => a - b);
  const bright = values[Math.floor(0.95 * values.length)];
  viewer.setExposure(bright > 0 ? Math.round(-4 * Math.log2(bright)) / 4 : 0);
}

export function displayControls(viewer) {
  viewer.exposureText = make("span", { className: "unit" });
  viewer.exposureInput = make("input", { type: "range", min: -16, max: 16, step: 0.25, value: 0,
    oninput: () => viewer.setExposure(Number(viewer.exposureInput.value)) });
  const mode = make("select", { onchange: () => { viewer.display.mode = Number(mode.value); viewer.draw(); } },
    ...["colour", "false colour", "difference"].map((text, value) => make("option", { value }, text)));
  viewer.modeInput = mode;
  viewer.splitInput = make("input", { type: "range", min: 0, max: 1, step: 0.005, value: 0.5,
    oninput: () => { viewer.display.split = Number(viewer.splitInput.value); viewer.draw(); } });
  const split = make("button", { onclick: () => {
    viewer.display.split = viewer.display.split === null ? Number(viewer.splitInput.value) : null;
    split.classList.toggle("on", viewer.display.split !== null);
    viewer.draw();
  } }, "split");
  viewer.splitButton = split;
  const tool = make("select", { onchange: () => { viewer.tool = tool.value; } },
    make("option", { value: "camera" }, "moves the camera"), make("option", { value: "picture" }, "moves the picture"));
  viewer.toolInput = tool;
  return make("div", {},
    row(make("span", {}, "exposure"), viewer.exposureInput, viewer.exposureText,
      make("button", { onclick: () => adaptExposure(viewer) }, "adapt")),
    row(make("span", {}, "show"), mode, split, viewer.splitInput),
    row(make("span", {}, "mouse"), tool, make("button", { onclick: () => { viewer.zoom = { scale: 1, x: 0, y: 0 }; viewer.draw(); } }, "fit")),
    make("div", { className: "hint" }, "Keys: F flips, 1 to 9 choose a picture. Shift-drag pans, the wheel dollies; Ctrl and the wheel zoom the picture to its values."));
}

export function buildPictures(viewer) {
  if (!viewer.scene) return;
  viewer.pictureList.replaceChildren(...viewer.scene.pictures.map(({ name }) => make("button", {
    className: name === viewer.shown ? "on" : "", onclick: () => viewer.choose(name) }, name)));
}

export function buildLayers(viewer) {
  const picture = viewer.picture(viewer.shown);
  if (!picture) return;
  const names = JSON.stringify([picture.layers, viewer.alone, [...viewer.off], [...viewer.gains]]);
  if (names === viewer.layersBuilt) return;
  viewer.layersBuilt = names;
  viewer.layerList.replaceChildren(...picture.layers.map((layer) => {
    const { name } = layer, gain = viewer.gains.get(name) || 1;
    const check = make("input", { type: "checkbox", checked: layer.of_sum && !viewer.off.has(name), disabled: !layer.of_sum,
      dataset: { layer: name }, onchange: () => viewer.toggle(name, check.checked) });
    const alone = make("button", { className: viewer.alone === name ? "on" : "", dataset: { alone: name },
      onclick: () => viewer.showAlone(viewer.alone === name ? null : name) }, "alone");
    const times = make("select", { onchange: () => { viewer.gains.set(name, Number(times.value)); viewer.update(); } },
      ...[1, 2, 4, 8, 16, 32, 64].map((k) => make("option", { value: k, selected: k === gain }, `x${k}`)));
    return row(make("label", { title: name }, check, ` ${name}`), alone, times);
  }));
}
