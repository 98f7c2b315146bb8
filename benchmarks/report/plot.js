// The chart of error against time, both logarithmic.
import {axisBottom, axisLeft} from "d3-axis";
import {scaleLog} from "d3-scale";
import {clientPoint, create, select} from "d3-selection";
import {line as polyline} from "d3-shape";

import {isShortcut, milliseconds} from "./dom.js";
import {errorText, measured, paretoFront} from "./metrics.js";
import {colour, dashes, marker} from "./marks.js";
import {settingsText} from "./series.js";

const MARGIN = {top: 12, right: 16, bottom: 44, left: 58};
const REACH = 13;  // pixels around a point in which the pointer means it
const LABEL = {width: 100, height: 16};  // pixels that "as the reference" takes at most

/** From a little below the smallest to a little above the largest; at least a factor of two. */
export function logDomain(values) {
  const low = Math.min(...values), high = Math.max(...values);
  const middle = Math.sqrt(low * high), reach = Math.max(Math.sqrt(high / low) * 1.15, 1.5);
  return [middle / reach, middle * reach];
}

export function logAxes(svg, x, y, width, height, labels) {
  const short = (value) => (value < 1e-3 || value >= 1e5 ? value.toExponential(0) : String(Number(value.toPrecision(3))));
  const ticks = (pixels, each) => [Math.max(2, Math.min(8, pixels / each)), short];
  const grid = svg.append("g").attr("class", "grid").attr("aria-hidden", "true");
  grid.append("g").attr("transform", `translate(0,${height - MARGIN.bottom})`)
    .call(axisBottom(x).ticks(...ticks(width, 110)).tickSize(-(height - MARGIN.top - MARGIN.bottom)));
  grid.append("g").attr("transform", `translate(${MARGIN.left},0)`)
    .call(axisLeft(y).ticks(...ticks(height, 70)).tickSize(-(width - MARGIN.left - MARGIN.right)));
  grid.append("text").attr("class", "axis").attr("x", (MARGIN.left + width - MARGIN.right) / 2).attr("y", height - 6)
    .attr("text-anchor", "middle").text(labels[0]);
  grid.append("text").attr("class", "axis").attr("transform", `translate(13,${(height - MARGIN.bottom) / 2}) rotate(-90)`)
    .attr("text-anchor", "middle").text(labels[1]);
}

function levelLine(svg, y, value, width, name, label) {
  const group = svg.append("g").attr("class", `level ${name}`);
  group.append("line").attr("x1", MARGIN.left).attr("x2", width - MARGIN.right).attr("y1", y(value)).attr("y2", y(value));
  group.append("text").attr("x", width - MARGIN.right - 4).attr("y", y(value) - 4).attr("text-anchor", "end").text(label);
}

/** Where a budget of time or error lies: a line across the chart. */
function budgetLine(group, x, y, width, height, key, value) {
  const [low, high] = (key === "ms" ? x : y).domain();
  const inside = value >= low && value <= high;
  group.style("display", inside ? null : "none");
  if (!inside) return;
  const across = key === "ms" ? [x(value), x(value), MARGIN.top, height - MARGIN.bottom]
    : [MARGIN.left, width - MARGIN.right, y(value), y(value)];
  ["x1", "x2", "y1", "y2"].forEach((name, i) => group.select("line").attr(name, across[i]));
}

/**
 * The reference's own method, whose error falls with the square root of its time. Markers are drawn over its label, which therefore
 * stands at the first place along the line that they leave free.
 */
function tracedLine(svg, x, y, {ms, sigma}, markers) {
  const error = (time) => sigma * Math.sqrt(ms / time), time = (value) => ms * (sigma / value) ** 2;
  const [low, high] = y.domain();
  const start = Math.max(x.domain()[0], time(high)), end = Math.min(x.domain()[1], time(low));
  if (!(start < end)) return;
  const group = svg.append("g").attr("class", "level traced");
  group.append("line").attr("x1", x(start)).attr("x2", x(end)).attr("y1", y(error(start))).attr("y2", y(error(end)));
  const left = (at) => x(at) + 6, base = (at) => y(error(at)) - 4;
  const isFree = (at) => left(at) + LABEL.width < x.range()[1] && !markers.some(([px, py]) =>
    px > left(at) - REACH && px < left(at) + LABEL.width + REACH && Math.abs(py - base(at) + 4) < LABEL.height / 2 + REACH);
  const place = Array.from({length: 40}, (_, i) => start * (end / start) ** (i / 40)).find(isFree) ?? start;
  group.append("text").attr("x", left(place)).attr("y", base(place)).text("as the reference");
}

function frontLine(front, x, y) {
  return front.map((point, i) =>
    i === 0 ? `M${x(point.ms)},${y(point.error)}` : `H${x(point.ms)}V${y(point.error)}`).join("");
}

/** Arrow keys walk through the points: left and right by time, up and down from curve to curve. */
function neighbour(points, current, key) {
  const byTime = [...points].sort((a, b) => a.ms - b.ms);
  const at = byTime.indexOf(current);
  if (key === "Home") return byTime[0];
  if (key === "End") return byTime.at(-1);
  if (key === "ArrowRight") return byTime[at + 1];
  if (key === "ArrowLeft") return byTime[at - 1];
  const step = key === "ArrowDown" ? 1 : key === "ArrowUp" ? -1 : 0;
  const curves = [...new Set(points.map((point) => point.curve))];
  const next = curves[curves.indexOf(current.curve) + step];
  return step === 0 ? undefined : points.find((point) => point.curve === next);
}

/**
 * Draws the chart into `container` and returns {mark(row), budget(key, value)}: what shows a row as the current one, and where
 * the budget of time ("ms") or error lies.
 * `level`: the separation floor. `traced`: {ms, sigma} of the reference, where its time may be set beside the rows'.
 * `onCurrent(row)` is told when a point is hovered, touched or focused.
 */
export function drawPlot(container, {curves, rows, metric, time, level, traced, onCurrent}) {
  const points = curves.flatMap((curve) => measured(curve.rows, metric, time).map((point) => ({...point, curve})));
  if (points.length === 0) {
    container.replaceChildren("No row has both a time and this error.");
    return {mark() {}, budget() {}};
  }
  const width = Math.max(280, container.clientWidth), height = Math.min(460, Math.max(300, width * 0.62));
  const front = paretoFront(points);
  const floors = rows.map((row) => metric.floor(row)).filter((value) => value > 0);
  const floor = floors.length ? Math.max(...floors) : null;
  const levels = [floor, level].filter((value) => value > 0);
  const positive = points.map((point) => point.error).filter((error) => error > 0);
  const spreads = points.flatMap((point) => time.spread(point.row) ?? []).filter((ms) => ms > 0);
  const x = scaleLog(logDomain([...points.map((point) => point.ms), ...spreads]), [MARGIN.left, width - MARGIN.right]);
  const y = scaleLog(logDomain([...positive, ...levels, ...(positive.length ? [] : [1])]),
    [height - MARGIN.bottom, MARGIN.top]);
  const place = (error) => y(error > 0 ? error : y.domain()[0]);  // no error at all: the lower edge

  const svg = create("svg").attr("class", "plot").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width)
    .attr("height", height).attr("role", "group")
    .attr("aria-label", `${metric.label} against milliseconds, ${points.length} points; arrow keys walk through them`);
  logAxes(svg, x, y, width, height, [`milliseconds, ${time.label}`, metric.label]);
  if (floor) levelLine(svg, y, floor, width, "noise", "noise of the reference (3 sigma)");
  if (level > 0) levelLine(svg, y, level, width, "separation", "separation floor");
  if (traced) tracedLine(svg, x, y, traced, points.map((point) => [x(point.ms), place(point.error)]));
  svg.append("path").attr("class", "front").attr("d", frontLine(front, x, place));
  const bound = svg.append("g").attr("class", "level budget").style("display", "none");
  bound.append("line");

  for (const curve of curves) {
    const path = polyline().x((point) => x(point.ms)).y((point) => place(point.error));
    for (const line of curve.lines) {
      svg.append("path").attr("class", "curve").attr("d", path(measured(line, metric, time)) ?? "")
        .attr("stroke", colour(curve)).attr("stroke-dasharray", dashes(curve));
    }
  }
  const marks = svg.selectAll("g.point").data(points).enter().append("g").attr("class", "point")
    .classed("pareto", (point) => front.includes(point))
    .attr("transform", (point) => `translate(${x(point.ms)},${place(point.error)})`)
    .attr("role", "button").attr("tabindex", -1)
    .attr("aria-label", (point) => `${point.curve.name} ${settingsText(point.row)}: ${milliseconds(point.ms)}, ` +
      `${metric.label} ${errorText(metric, point.row)}${front.includes(point) ? ", on the Pareto front" : ""}`);
  marks.each(function (point) {
    const spread = time.spread(point.row);
    if (spread?.[0] > 0)
      select(this).append("path").attr("class", "spread").attr("stroke", colour(point.curve))
        .attr("d", `M${x(spread[0]) - x(point.ms)},0H${x(spread[1]) - x(point.ms)}`);
  });
  marks.append("circle").attr("class", "reach").attr("r", REACH);
  marks.filter((point) => front.includes(point)).append("circle").attr("class", "ring").attr("r", 9);
  marks.append("path").attr("class", "marker").attr("d", (point) => marker(point.curve))
    .attr("fill", (point) => colour(point.curve));
  const pointOf = (event) => {
    const mark = event.target.closest("g.point");
    return mark && select(mark).datum();
  };
  const focusOn = (point) => marks.filter((other) => other === point).node()?.focus();
  // The nearest point, not the topmost: those that lie close together cover each other's reach.
  const nearest = (event) => {
    const [px, py] = clientPoint(svg.node(), event);
    const distance = (point) => Math.hypot(x(point.ms) - px, place(point.error) - py);
    const found = points.reduce((best, point) => (distance(point) < distance(best) ? point : best));
    return distance(found) <= REACH ? found : null;
  };
  let current = null;
  marks.on("focus", (point) => onCurrent(point.row));
  svg.node().addEventListener("pointermove", (event) => {
    const point = nearest(event);
    if (point && point.row !== current) onCurrent(point.row);
  });
  svg.node().addEventListener("mousedown", (event) => {
    const point = nearest(event);
    if (!point) return;
    event.preventDefault();  // or the topmost would take the focus
    focusOn(point);
  });
  svg.node().addEventListener("click", (event) => {
    const point = event.detail === 0 && pointOf(event);  // pressed by a screen reader
    if (point) onCurrent(point.row);
  });
  svg.node().addEventListener("keydown", (event) => {
    const focused = !isShortcut(event) && pointOf(event);
    const next = focused && neighbour(points, focused, event.key);
    if (!next) return;
    event.preventDefault();
    focusOn(next);
  });
  container.replaceChildren(svg.node());

  return {
    mark(row) {
      current = row;
      const any = points.some((point) => point.row === row);
      marks.classed("current", (point) => point.row === row)
        .attr("aria-pressed", (point) => String(point.row === row))
        .attr("tabindex", (point, i) => (any ? point.row === row : i === 0) ? 0 : -1);
    },
    budget(key, value) { budgetLine(bound, x, y, width, height, key, value); },
  };
}
