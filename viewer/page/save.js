// What is seen, as files and as a command.
import { make, row } from "./elements.js";

export function saveControls(viewer) {
  return row(make("button", { onclick: () => viewer.send({ type: "save", picture: viewer.shown }) }, "EXR"),
    make("button", { onclick: () => viewer.canvas.toBlob((blob) => viewer.download("view.png", blob)) }, "PNG as shown"),
    make("button", { onclick: () => viewer.send({ type: "reproduce", picture: viewer.shown }) }, "command and XML"),
    make("button", { dataset: { save: "comparison" }, onclick: () => viewer.send({ type: "compare" }) }, "comparison page"));
}

export function showReproduced(viewer, { command, xml }) {
  viewer.reproduced = { command, xml };
  const copy = (text) => make("button", { onclick: () => navigator.clipboard.writeText(text) }, "copy");
  viewer.reproduceInfo.replaceChildren(row(make("span", {}, "command line"), copy(command)), make("pre", {}, command),
    row(make("span", {}, "scene file, to stand beside the scene's own"), copy(xml)));
}
