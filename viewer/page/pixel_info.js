// The light of a pixel.
import { make, short, triple } from "./elements.js";

/** Rows about the pixel that was clicked. */
export function pixelInfo(message) {
  const rows = message.values.map(({ layer, channels, values }) => make("tr", {},
    make("th", { title: channels.join(", ") }, layer), ...values.map((v) => make("td", {}, short(v)))));
  return [make("div", {}, `pixel ${message.x}, ${message.y} of ${message.picture}`), make("table", {}, ...rows),
    ...(message.light ? lightInfo(message.light) : [])];
}

const brightness = (rgb) => (rgb === null ? "" : Math.max(...rgb).toPrecision(3));
/** A list of the points that light the pixel, brightest first. */
function sourceTable(light) {
  const clusters = light.sources.some((s) => s.cluster !== null), weights = light.sources.some((s) => Math.abs(s.weight - 1) > 1e-4);
  const columns = [[light.kind, (s) => String(s.index)], ["bounce", (s) => String(s.depth)], ["light", (s) => brightness(s.light)]];
  if (light.sources.some((s) => s.unbounded !== null) && light.kind === "VPL") columns.push(["unbounded", (s) => brightness(s.unbounded)]);
  if (weights) columns.push(["weight", (s) => s.weight.toPrecision(3)]);
  if (clusters) columns.push(["of cluster", (s) => String(s.cluster ?? "")]);
  return make("table", {}, make("tr", {}, ...columns.map(([title]) => make("th", {}, title))),
    ...light.sources.slice(0, 16).map((s) => make("tr", {}, ...columns.map(([, text]) => make("td", {}, text(s))))));
}

function lightInfo(light) {
  const first = light.first, lines = [];
  if (first) {
    lines.push(`shape ${first.shape}, depth ${short(first.depth)} m, at ${triple(first.position)}`,
      `normal ${triple(first.geometric_normal)} (shading ${triple(first.shading_normal)})${first.in_medium ? ", eye in a medium" : ""}`);
  } else lines.push("The ray meets no surface.");
  lines.push(`eye path of pass 0: ${light.path.length} vertices`, `${light.kind}s of pass 0, by ${light.method}:`,
    ...light.facts.map(([topic, choice]) => `${topic}: ${choice}`),
    `${light.connected} connections for the pixel, ${light.lit_by} with light`, `their sum ${triple(light.sum)}`);
  if (light.kind === "VPL")
    lines.push(`residual that the bound takes ${triple(light.residual)}`, "Visibility by shadow rays; texels of maps are not shown.");
  return [...lines.map((text) => make("div", { className: "hint" }, text)), sourceTable(light)];
}
