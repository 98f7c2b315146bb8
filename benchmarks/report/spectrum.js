// The error's power over frequency: noise is level, banding stands at the left.
import {scaleLog} from "d3-scale";
import {create} from "d3-selection";
import {line as polyline} from "d3-shape";

import {colour, dashes} from "./marks.js";
import {lowFrequencyShare} from "./metrics.js";
import {logAxes, logDomain} from "./plot.js";
import {el} from "./dom.js";

const HIGHEST = 0.5;  // cycles per pixel

/** [cycles per pixel, power] at the middle of every ring; rings without power are left out. */
function points(spectrum) {
  return spectrum.map((power, ring) => [(ring + 0.5) * HIGHEST / spectrum.length, power]).filter(([, power]) => power > 0);
}

export function percent(share) {
  return share === null ? "–" : `${Math.round(100 * share)} %`;
}

/** `entries`: [{curve, row}], the first one in front; that of the row `current` is drawn strong. */
export function drawSpectrum(container, entries, current) {
  const shown = entries.filter((entry) => entry.row.spectrum?.length && points(entry.row.spectrum).length);
  if (shown.length === 0) {
    container.replaceChildren(el("p", {class: "note"}, "No spectrum was recorded for this setting."));
    return;
  }
  const width = Math.max(280, container.clientWidth), height = 240;
  const all = shown.flatMap((entry) => points(entry.row.spectrum));
  const x = scaleLog([all.map(([f]) => f).reduce((a, b) => Math.min(a, b)), HIGHEST], [58, width - 16]);
  const y = scaleLog(logDomain(all.map(([, power]) => power)), [height - 44, 12]);
  const path = polyline().x(([f]) => x(f)).y(([, power]) => y(power));
  const svg = create("svg").attr("class", "spectrum").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width)
    .attr("height", height).attr("role", "img")
    .attr("aria-label", "Power of the error over frequency. Share at wavelengths above 16 pixels: " +
      shown.map(({curve, row}) => `${curve.name} ${percent(lowFrequencyShare(row.spectrum))}`).join(", "));
  logAxes(svg, x, y, width, height, ["cycles per pixel", "power of the error"]);
  for (const {curve, row} of [...shown].reverse()) {
    svg.append("path").attr("class", row === current ? "curve current" : "curve")
      .attr("d", path(points(row.spectrum))).attr("stroke", colour(curve)).attr("stroke-dasharray", dashes(curve));
  }
  container.replaceChildren(svg.node());
}

/** The spectrum as a word-sized picture for tables. */
export function sparkline(spectrum) {
  const known = points(spectrum ?? []);
  if (known.length < 2) return "–";
  const x = scaleLog([known[0][0], HIGHEST], [1, 63]);
  const y = scaleLog(logDomain(known.map(([, power]) => power)), [17, 1]);
  const svg = create("svg").attr("class", "sparkline").attr("width", 64).attr("height", 18).attr("viewBox", "0 0 64 18")
    .attr("role", "img").attr("aria-label", `${percent(lowFrequencyShare(spectrum))} above 16 pixels`);
  svg.append("path").attr("d", polyline().x(([f]) => x(f)).y(([, power]) => y(power))(known));
  return svg.node();
}
