// The line below the image.
import { percent } from "./elements.js";

export function showStatus(viewer) {
  const picture = viewer.picture(viewer.shown);
  if (!picture) return void (viewer.statusLine.textContent = "waiting for the first picture");
  const state = viewer.state[viewer.shown], parts = [viewer.shown];
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
  if (picture.finished && viewer.scene && viewer.scene.file) parts.push("finished");
  if (viewer.hover) parts.push(viewer.hover);
  viewer.statusLine.textContent = parts.join("  ·  ");
}
