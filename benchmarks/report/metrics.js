// What is measured of a row, on which axis it goes, and who is on the Pareto front.
import {number} from "./dom.js";
import {page} from "./page.js";

export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

const at = (row, [part, field]) => row[part]?.[field];

function reader({path, whole, magnitude}) {
  if (whole) return (row) => (at(row, whole) > 0 ? at(row, path) / at(row, whole) : null);
  return (row) => (magnitude && isNumber(at(row, path)) ? Math.abs(at(row, path)) : at(row, path));
}

/** As limn lists them; `read(row)`, and `floor(row)` below which an error is no difference where the reference's noise says so. */
export const METRICS = page.metrics.map((metric) => ({...metric, read: reader(metric),
  floor: (row) => (metric.floored ? at(row, [metric.path[0], "noise_floor"]) ?? null : null)}));

export const TIMES = [
  {key: "frame", label: "whole frame", read: (row) => (row.frame_ms?.n > 0 ? row.frame_ms.median : null),
   spread: (row) => [row.frame_ms.q1, row.frame_ms.q3]},
  {key: "shadows", label: "maps, filters and the technique's passes", note: " (other frames, timed pass by pass)",
   read: (row) => {
     const split = row.frame_ms?.n > 0 ? row.split_ms : null;
     return split ? split.maps + split.filters + split.technique : null;
   },
   spread: () => null},
];

/** The metrics that at least one row has. */
export function knownMetrics(rows) {
  return METRICS.filter((metric) => rows.some((row) => isNumber(metric.read(row))));
}

/** An error, or the bound that the reference's noise sets. */
export function errorText(metric, row) {
  const value = metric.read(row), floor = metric.floor(row);
  return isNumber(value) && floor > value ? `<${number(floor)}` : number(value);
}

/** Rows with an error and a time, as {row, error, ms, bound}; the bound is the error, or the noise where that is larger. */
export function measured(rows, metric, time) {
  return rows.map((row) => ({row, error: metric.read(row), ms: time.read(row),
                             bound: Math.max(metric.read(row) ?? NaN, metric.floor(row) ?? 0)}))
    .filter((point) => isNumber(point.error) && isNumber(point.ms) && point.ms > 0);
}

/** Time and noise of the reference, where they may be set beside the rows': {ms, sigma} or null. */
export function tracedBy(table, metric, time) {
  const row = table.rows.find((other) => other.reference_ms);
  if (!row || metric.key !== "rmse" || time.key !== "frame") return null;
  return {ms: 1000 * table.reference.seconds, sigma: metric.floor(row) / 3};
}

/** The rows that nobody beats in both error and time, quickest first; errors below the noise are no difference. */
export function paretoFront(points) {
  const front = [];
  for (const point of [...points].sort((a, b) => a.ms - b.ms || a.bound - b.bound)) {
    const last = front.at(-1);
    if (!last || point.bound < last.bound || (point.bound === last.bound && point.ms === last.ms)) front.push(point);
  }
  return front;
}

/** The share of the error's power at wavelengths above 16 pixels, of what lies below 0.5 cycles per pixel. */
export function lowFrequencyShare(spectrum) {
  if (!spectrum?.length) return null;
  const power = spectrum.map((value, ring) => value * (2 * ring + 1));  // rings grow with their radius
  const sum = (values) => values.reduce((total, value) => total + value, 0);
  const total = sum(power);
  return total > 0 ? sum(power.slice(0, spectrum.length / 8)) / total : null;
}
