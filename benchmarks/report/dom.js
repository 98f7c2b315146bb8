// Elements from data. Texts only ever become text nodes and attribute values, never markup.

/**
 * An element; functions among the attributes are listeners, null and false are left out, children may be texts. `style` is an
 * object: the page's policy lets no style attribute in.
 */
export function el(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (name === "style") Object.assign(element.style, value);
    else if (value !== null && value !== undefined && value !== false)
      element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return element;
}

/** A labelled drop-down; `options` are {value, label}. Without a choice to make there is none. */
export function chooser(label, options, value, onChange) {
  if (options.length < 2) return null;
  const select = el("select", {change: () => onChange(select.value)},
    options.map((option) => el("option", {value: option.value, selected: option.value === value}, option.label)));
  return el("label", {class: "chooser"}, el("span", {}, label), select);
}

/** Puts choosers, some of them null, in the place of those before them; the focus stays in the one of the same label. */
export function putChoosers(tools, choosers) {
  const labelOf = (element) => element.closest(".chooser")?.firstChild.textContent;
  const focused = tools.contains(document.activeElement) ? labelOf(document.activeElement) : null;
  tools.replaceChildren(...choosers.filter(Boolean));
  if (focused) [...tools.querySelectorAll("select, input")].find((field) => labelOf(field) === focused)?.focus();
}

/** Whether a key belongs to the browser: with Alt, an arrow goes back. */
export const isShortcut = (event) => event.altKey || event.ctrlKey || event.metaKey;

/** A name that may be broken after its underscores. */
export function breakable(name) {
  return String(name).split(/(?<=_)/).flatMap((part, i) => (i ? [el("wbr"), part] : [part]));
}

/** Three significant digits, with a power of ten only where zeros would be counted. */
export function number(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e6 || size < 1e-4 ? value.toExponential(2) : String(Number(value.toPrecision(3)));
}

export function milliseconds(value) {
  return value === null ? "not timed" : `${number(value)} ms`;
}

/**
 * A slider over the logarithm of `values`, which lie above zero, with its value beside it as `text(value)` says it. It begins at
 * `start`; `onValue(value)` is told that and every move.
 */
export function slider(label, values, start, text, onValue) {
  const low = Math.log(Math.min(...values)), high = Math.log(Math.max(...values));
  const output = el("output", {});
  const show = () => {
    const value = Math.exp(low + (high - low) * input.value / 100);
    output.textContent = text(value);
    input.setAttribute("aria-valuetext", text(value));
    onValue(value);
  };
  const input = el("input", {type: "range", min: 0, max: 100, step: 1, input: show,
    value: high > low ? Math.round(100 * (Math.log(start) - low) / (high - low)) : 0});
  show();
  return el("label", {class: "chooser"}, el("span", {}, label), el("span", {class: "slider"}, input, output));
}
