// Pictures at equal time and at equal error, as comparisons are printed: the same magnified windows of each technique.
import {breakable, el, milliseconds, number, slider} from "./dom.js";
import {framed} from "./detail.js";
import {errorText, measured} from "./metrics.js";
import {picture} from "./pictures.js";
import {OUTDATED, outdatedText, ownName, settings} from "./series.js";
import {swatch} from "./marks.js";

const NEAR = 1.5;  // times or errors within this factor of the target count as equal

const distance = (value, target) => Math.abs(Math.log(value / target));

/**
 * Of every curve the point nearest to the target, if it is near, of equally near ones the quickest, outdated ones after all
 * others: [{curve, row, ms, error}].
 */
export function nearest(curves, metric, time, key, target) {
  const found = [], missing = [];
  for (const curve of curves) {
    const points = measured(curve.rows, metric, time).filter((point) => point[key] > 0);
    if (points.length === 0) continue;
    const age = ({row}) => (row.outdated ? 1 : 0), away = (point) => distance(point[key], target);
    const [best] = points.filter((point) => away(point) <= Math.log(NEAR))
      .sort((a, b) => age(a) - age(b) || away(a) - away(b) || a.ms - b.ms);
    if (best) found.push({...best, curve});
    else missing.push(curve.name);
  }
  return {found, missing};
}

/** The target that most techniques come near to, and of several the one they come nearest to. */
export function commonTarget(curves, metric, time, key) {
  const values = curves.flatMap((curve) => measured(curve.rows, metric, time).map((point) => point[key]))
    .filter((value) => value > 0);
  let best = null;
  for (const value of values) {
    const {found} = nearest(curves, metric, time, key, value);
    const away = found.reduce((sum, point) => sum + distance(point[key], value), 0);
    if (!best || found.length > best.count || (found.length === best.count && away < best.away))
      best = {value, count: found.length, away};
  }
  return best?.value ?? null;
}

function magnified(windows, text) {
  return windows.map((index, i) => index < 0 ? null
    : picture(index, {class: `magnified window-${i}`, alt: `${text}, window ${i + 1}`}));
}

function strip(table, points, metric) {
  const reference = table.reference.windows.some((index) => index >= 0)
    ? el("figure", {}, magnified(table.reference.windows, "Reference"),
        el("figcaption", {}, el("strong", {}, "reference"))) : null;
  const shown = points.map(({curve, row, ms}) => el("figure", {}, magnified(row.windows, row.name),
    el("figcaption", {}, el("strong", {}, swatch(curve), breakable(curve.name), row.outdated ? OUTDATED : null),
      Object.entries(settings(row)).map(([name, value]) => el("span", {}, breakable(`${ownName(row, name)} ${value}`))),
      el("span", {}, `${milliseconds(ms)}, error ${errorText(metric, row)}`))));
  const note = outdatedText(points.map(({row}) => row));
  return [el("div", {class: "strip"}, reference, shown), note ? el("p", {class: "note"}, note) : null].filter(Boolean);
}

/** One row of pictures with the slider that chooses its target. */
function equalRow(table, curves, metric, time, kind) {
  const key = kind.of;
  const values = curves.flatMap((curve) => measured(curve.rows, metric, time).map((point) => point[key]))
    .filter((value) => value > 0);
  if (values.length === 0) return null;
  const body = el("div");
  const show = (target) => {
    const {found, missing} = nearest(curves, metric, time, key, target);
    found.sort((a, b) => (key === "ms" ? a.bound - b.bound : a.ms - b.ms));
    const text = `${kind.name(metric, time)} ${kind.text(target)}`;
    body.replaceChildren(el("p", {class: "note", "aria-live": "polite"},
      `${text}, within a factor of ${NEAR}, ${key === "ms" ? "least error" : "quickest"} first.` +
      (missing.length ? ` Not near it: ${missing.join(", ")}.` : "")), ...strip(table, found, metric));
  };
  const target = commonTarget(curves, metric, time, key);
  return el("div", {class: `equal equal-${kind.key}`}, el("h3", {}, kind.title),
    slider(kind.label, values, target, kind.text, show), body);
}

/** `of` is the figure of a point that is to be equal: errors below the noise are. */
const KINDS = [
  {key: "ms", of: "ms", title: "Equal time", label: "Target time", text: milliseconds,
   name: (metric, time) => `Time, ${time.label}:`},
  {key: "error", of: "bound", title: "Equal error", label: "Target error", text: number,
   name: (metric) => `${metric.label}:`},
];

/** Every setting, for tables that time nothing. */
function allRows(table, curves, metric) {
  const points = curves.flatMap((curve) => curve.rows.map((row) => ({curve, row, ms: null})));
  return el("div", {}, el("h3", {}, "Every setting"), strip(table, points, metric));
}

export function equalRows(table, curves, metric, time) {
  const rows = KINDS.map((kind) => equalRow(table, curves, metric, time, kind)).filter(Boolean);
  if (rows.length === 0) rows.push(allRows(table, curves, metric));
  const whole = table.reference.picture.thumbnail >= 0
    ? el("figure", {class: "overview"}, framed(table, [{...table.reference.picture, name: "reference", text: "Reference"}], 0),
        el("figcaption", {}, "The reference; the frames are where the techniques' errors differ most.")) : null;
  return [whole, ...rows].filter(Boolean);
}
