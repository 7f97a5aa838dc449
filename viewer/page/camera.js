// A camera that the mouse turns, and its vectors.

const add = (a, b, k = 1) => a.map((x, i) => x + k * b[i]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a.reduce((s, x, i) => s + x * b[i], 0);
const unit = (a) => a.map((x) => x / Math.hypot(...a));
/** `v` turned about the unit `axis`. */
const turned = (v, axis, angle) => add(add(v.map((x) => x * Math.cos(angle)), cross(axis, v), Math.sin(angle)), axis,
                                       dot(axis, v) * (1 - Math.cos(angle)));

/** A camera as origin, target and up. */
export class Camera {
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
