// The setting that is looked at: what it is, what it costs, how wrong it is, and its pictures.
import {breakable, el, milliseconds, number} from "./dom.js";
import {METRICS, TIMES, errorText, isNumber} from "./metrics.js";
import {command} from "./command.js";
import {enlarge} from "./enlarge.js";
import {picture} from "./pictures.js";
import {outdatedText, ownName, settings} from "./series.js";

/**
 * The thumbnail of picture `shown` of a list, [{thumbnail, whole, name, text}], with the magnified windows drawn on it; pressed,
 * the whole picture is enlarged and flips to the others.
 */
export function framed(table, pictures, shown) {
  const [width, height] = table.size;
  const boxes = table.windows.map(([x, y, w, h], i) => el("span", {class: `window-${i}`, "aria-hidden": "true",
    style: {left: `${100 * x / width}%`, top: `${100 * y / height}%`, width: `${100 * w / width}%`, height: `${100 * h / height}%`}}));
  return el("button", {type: "button", class: "framed", title: "Enlarge", click: () => enlarge(pictures, shown)},
    picture(pictures[shown].thumbnail, {alt: pictures[shown].text, style: {aspectRatio: `auto ${width} / ${height}`}}), boxes);
}

function facts(row) {
  const entries = Object.entries(settings(row)).map(([name, value]) => [ownName(row, name), value]);
  for (const time of TIMES) {
    const ms = time.read(row);
    if (isNumber(ms)) entries.push([`time, ${time.label}${time.note ?? ""}`, milliseconds(ms)]);
  }
  for (const metric of METRICS) {
    if (isNumber(metric.read(row))) entries.push([metric.label, errorText(metric, row)]);
  }
  if (isNumber(row.memory_bytes)) entries.push(["memory", `${number(row.memory_bytes / 2 ** 20)} MiB`]);
  return el("dl", {}, entries.map(([name, value]) => el("div", {}, el("dt", {}, breakable(name)), el("dd", {}, value))));
}

/** All but its name. */
export function detail(table, row) {
  const pictures = [
    {...row.picture, name: "picture", caption: row.name, text: `Picture by ${row.name}`},
    {...row.difference, name: "difference", caption: "FLIP difference: black equal, light yellow wholly different",
     text: `Difference between ${row.name} and the reference`},
    {...table.reference.picture, name: "reference", caption: "reference", text: "Picture of the reference"},
  ].filter(({thumbnail}) => thumbnail >= 0);
  return [
    pictures.length ? el("div", {class: "pictures"}, pictures.map(({caption}, i) =>
      el("figure", {}, framed(table, pictures, i), el("figcaption", {}, caption))))
      : el("p", {class: "note"}, "No pictures were kept; a suite with pictures = true keeps them."),
    row.failure ? el("p", {}, `Failed: ${row.failure}`) : facts(row),
    row.outdated ? el("p", {class: "note"}, outdatedText([row])) : null,
    command(row),
  ].filter(Boolean);
}
