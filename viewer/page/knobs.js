// Knobs of the render, made from the declared parameters.
import { make, row } from "./elements.js";

export function renderControls(viewer) {
  return row(make("button", { onclick: () => viewer.send({ type: "stop" }) }, "stop"),
    make("button", { onclick: () => viewer.send({ type: "start" }) }, "start again"),
    make("span", {}));
}

export function buildKnobs(viewer) {
  if (!viewer.scene) return;
  const live = viewer.live();
  buildSecond(viewer);
  if (!live) return void viewer.knobList.replaceChildren(make("div", { className: "hint" }, "A picture from a file."));
  const open = new Set([...viewer.knobList.querySelectorAll("details[open]")].map((d) => d.dataset.title));
  const plain = (name, value) => make("input", { type: "text", value, dataset: { knob: name },
    onchange: (event) => viewer.send({ type: "set", picture: viewer.shown, [name]: Number(event.target.value) }) });
  const groups = viewer.scene.knobs[viewer.shown] || [];
  viewer.knobList.replaceChildren(
    row(make("span", {}, "passes"), plain("passes", live.changes.passes || viewer.scene.sample_count)),
    row(make("span", {}, "seed"), plain("seed", live.changes.seed)),
    ...groups.map((group) => knobGroup(viewer, group, live, open.has(group.title) || group.kind === "integrator")));
}

function knobGroup(viewer, group, live, open) {
  const children = [];
  if (group.kind === "integrator") {
    const choice = make("select", { dataset: { knob: "integrator" },
      onchange: () => viewer.send({ type: "set", picture: viewer.shown, integrator: choice.value }) },
      ...group.types.map((type) => make("option", { value: type, selected: type === group.type }, type)));
    children.push(row(make("span", {}, "type"), choice));
  }
  children.push(...group.knobs.map((knob) => knobRow(viewer, knob, live)));
  return make("details", { open, dataset: { title: group.title } }, make("summary", {}, `${group.title} (${group.type})`), ...children);
}

function knobRow(viewer, knob, live) {
  const value = live.changes.defines[knob.path] ?? knob.value;
  const set = (text) => viewer.send({ type: "set", picture: viewer.shown, define: { [knob.path]: text === "" ? null : String(text) } });
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
  if (["float", "integer", "rgb"].includes(knob.type) && value) parts.push(turns(knob, value, set));
  return row(...parts);
}

/** Half and twice: of a number within its range, or of all of a colour. */
function turns(knob, value, set) {
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

function buildSecond(viewer) {
  const groups = viewer.scene.knobs && viewer.scene.knobs.A;
  if (!groups) return void viewer.secondRow.replaceChildren();
  const on = viewer.scene.pictures.some((p) => p.name === "B");
  const types = groups.find((g) => g.kind === "integrator").types;
  const choice = make("select", { dataset: { knob: "second" }, onchange: () => viewer.send({ type: "second", integrator: choice.value || null }) },
    make("option", { value: "" }, "(none)"),
    ...types.map((t) => make("option", { value: t, selected: on && viewer.scene.pictures.find((p) => p.name === "B").changes.integrator === t }, t)));
  viewer.secondRow.replaceChildren(row(make("span", {}, "second method B"), choice));
}
