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
