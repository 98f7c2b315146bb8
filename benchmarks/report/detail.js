// The setting that is looked at: what it is, what it costs, how wrong it is, and its pictures.
import {breakable, el, milliseconds, number} from "./dom.js";
import {METRICS, TIMES, errorText, isNumber} from "./metrics.js";
import {ownName, settings} from "./series.js";

/** The picture with the magnified windows drawn on it. */
export function framed(uri, text, table) {
  const [width, height] = table.size;
  const boxes = table.windows.map(([x, y, w, h], i) => el("span", {class: `window-${i}`, "aria-hidden": "true",
    style: {left: `${100 * x / width}%`, top: `${100 * y / height}%`, width: `${100 * w / width}%`, height: `${100 * h / height}%`}}));
  return el("div", {class: "framed"}, el("img", {src: uri, alt: text}), boxes);
}

function picture(page, index, table, caption, text) {
  if (!(index >= 0)) return null;
  return el("figure", {}, framed(page.pictures[index], text, table), el("figcaption", {}, caption));
}

function facts(row) {
  const entries = Object.entries(settings(row)).map(([name, value]) => [ownName(row, name), value]);
  for (const time of TIMES) {
    const ms = time.read(row);
    if (isNumber(ms)) entries.push([`time, ${time.label}`, milliseconds(ms)]);
  }
  for (const metric of METRICS) {
    if (isNumber(metric.read(row))) entries.push([metric.label, errorText(metric, row)]);
  }
  if (isNumber(row.memory_bytes)) entries.push(["memory", `${number(row.memory_bytes / 2 ** 20)} MiB`]);
  return el("dl", {}, entries.map(([name, value]) => el("div", {}, el("dt", {}, breakable(name)), el("dd", {}, value))));
}

/** All but its name. */
export function detail(page, table, row) {
  const pictures = [
    picture(page, row.picture, table, row.name, `Picture by ${row.name}`),
    picture(page, row.difference, table, "FLIP difference: black equal, light yellow wholly different",
      `Difference between ${row.name} and the reference`),
    picture(page, table.reference.picture, table, "reference", "Picture of the reference"),
  ].filter(Boolean);
  return [
    pictures.length ? el("div", {class: "pictures"}, pictures)
      : el("p", {class: "note"}, "No pictures were kept; a suite with pictures = true keeps them."),
    row.failure ? el("p", {}, `Failed: ${row.failure}`) : facts(row),
  ];
}
