// What is measured of a row, on which axis it goes, and who is on the Pareto front.
import {number} from "./dom.js";

const share = (part, whole) => (whole > 0 ? part / whole : null);
const floorOf = (metrics) => metrics?.noise_floor ?? null;

/** `floor`: below which an error is no difference, where the reference's noise says so. */
export const METRICS = [
  {key: "penumbra_rmse", label: "RMSE in the penumbra", read: (row) => row.penumbra?.rmse,
   floor: (row) => floorOf(row.penumbra), help: "over pixels whose reference visibility lies between 0.02 and 0.98"},
  {key: "rmse", label: "RMSE", read: (row) => row.error?.rmse, floor: (row) => floorOf(row.error),
   help: "root mean square error of linear values"},
  {key: "rel_mse", label: "relative MSE", read: (row) => row.error?.rel_mse,
   help: "mean of squared error over squared reference"},
  {key: "bias", label: "|bias|", read: (row) => (row.error ? Math.abs(row.error.bias) : null),
   help: "size of the mean signed error"},
  {key: "p999", label: "99.9th percentile", read: (row) => row.error?.p999,
   help: "which 99.9 % of the pixels' errors in luminance do not exceed"},
  {key: "flip", label: "FLIP", read: (row) => row.error?.flip,
   help: "mean perceived difference of the tone-mapped pictures, 0 to 1"},
  {key: "structured", label: "structured error", read: (row) => row.error?.structured,
   help: "RMS of the error after a 9 x 9 Gaussian: banding survives it, noise does not"},
  {key: "penumbra_structured", label: "structured error in the penumbra", read: (row) => row.penumbra?.structured,
   help: "the same over penumbra pixels"},
  {key: "lit_in_umbra", label: "lit in the umbra", read: (row) => share(row.misjudged?.lit_in_umbra, row.misjudged?.umbra),
   help: "share of the umbra's pixels with a visibility above 0.1: light leaks"},
  {key: "dark_in_light", label: "dark in full light", read: (row) => share(row.misjudged?.dark_in_light, row.misjudged?.lit),
   help: "share of the fully lit pixels with a visibility below 0.9"},
];

export const TIMES = [
  {key: "frame", label: "whole frame", read: (row) => (row.frame_ms?.n > 0 ? row.frame_ms.median : null),
   spread: (row) => [row.frame_ms.q1, row.frame_ms.q3]},
  {key: "shadows", label: "maps, filters and the technique's passes",
   read: (row) => {
     const split = row.frame_ms?.n > 0 ? row.split_ms : null;
     return split ? split.maps + split.filters + split.technique : null;
   },
   spread: () => null},
];

export const isNumber = (value) => typeof value === "number" && Number.isFinite(value);

/** The metrics that at least one row has. */
export function knownMetrics(rows) {
  return METRICS.filter((metric) => rows.some((row) => isNumber(metric.read(row))));
}

/** An error, or the bound that the reference's noise sets. */
export function errorText(metric, row) {
  const value = metric.read(row), floor = metric.floor?.(row);
  return isNumber(value) && floor > value ? `<${number(floor)}` : number(value);
}

/** Rows with an error and a time, as {row, error, ms, bound}; the bound is the error, or the noise where that is larger. */
export function measured(rows, metric, time) {
  return rows.map((row) => ({row, error: metric.read(row), ms: time.read(row),
                             bound: Math.max(metric.read(row) ?? NaN, metric.floor?.(row) ?? 0)}))
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
