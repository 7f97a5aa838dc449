// Elements of the page, and numbers as texts.

/** An element with properties, and children: nodes or texts. */
export function make(tag, properties = {}, ...children) {
  const { className = "", dataset = {}, style = "", ...rest } = properties;
  const node = Object.assign(document.createElement(tag), rest);
  if (className) node.className = className;
  if (style) node.style.cssText = style;
  Object.assign(node.dataset, dataset);
  node.append(...children);
  return node;
}

export const row = (...children) => make("div", { className: "row" }, ...children);
export const percent = (x) => `${(100 * x).toPrecision(2)} %`;
export const short = (x) => (x === null || x === undefined ? "unknown"
  : x !== 0 && Math.abs(x) < 1e-3 ? x.toExponential(2) : x.toPrecision(4));
export const triple = (v) => v.map(short).join(" ");
