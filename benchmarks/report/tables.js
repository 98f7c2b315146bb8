// The same numbers as tables: errors, frames per second, milliseconds per pass.
import {el, number} from "./dom.js";
import {TIMES, errorText, isNumber, knownMetrics, lowFrequencyShare, measured, paretoFront} from "./metrics.js";
import {page} from "./page.js";
import {OUTDATED, markedTitle, outdatedText, settingsText} from "./series.js";
import {percent, sparkline} from "./spectrum.js";

const FRAME = TIMES[0];
const NAMES = ["technique", "parameters"].map((key) => ({...page.columns[key], text: true}));

export function tableElement(caption, head, rows) {
  const header = (cell) => el("th", {scope: "col", class: cell.text ? "text" : null, title: cell.help}, cell.label);
  return el("div", {class: "scroll", role: "region", tabindex: 0, "aria-label": caption},
    el("table", {}, el("caption", {}, el("span", {}, caption)), el("thead", {}, el("tr", {}, head.map(header))), el("tbody", {}, rows)));
}

/** A caption that explains the mark, where a row has it. */
const withNote = (caption, rows) => [caption, outdatedText(rows).trim()].filter(Boolean).join(". ");

const cell = (value) => el("td", {}, value);
const text = (value) => el("td", {class: "text"}, value);

function nameCell(row, onCurrent) {
  const name = markedTitle(row);
  return el("th", {scope: "row"}, onCurrent ? el("button", {type: "button", click: () => onCurrent(row)}, name) : name);
}

function ratioText(ratio) {
  if (!ratio) return "–";
  return `${number(ratio.value)} (${ratio.turns > 1 ? `${number(ratio.low)}–${number(ratio.high)}` : `n = ${ratio.turns}`})`;
}

const referenceText = (time) => (time ? `${time.at_least ? ">" : ""}${number(time.value)}` : "–");

export function errorTable(table, metric, time, onCurrent) {
  const metrics = knownMetrics(table.rows);
  const front = paretoFront(measured(table.rows, metric, time)).map((point) => point.row);
  const traced = table.rows.some((row) => row.reference_ms);
  const {median_ms, p99_ms, n, reference_ms, memory_bytes, front: onFront} = page.columns;
  const head = [...NAMES, ...metrics,
    {label: "spectrum", help: "power of the error over frequency, both logarithmic"},
    {label: "above 16 px", help: "share of the error's power at wavelengths above 16 pixels"},
    ...(table.baseline ? [{label: "times as fast", help: `as ${table.baseline}, with the interval of 95 %; n = 1: one turn, no interval`}] : []),
    median_ms, {label: "quartiles", help: "lower and upper quartile of the time of a frame, milliseconds"}, p99_ms, n,
    ...(traced ? [reference_ms] : []), memory_bytes, onFront];
  const rows = table.rows.map((row) => {
    const start = [nameCell(row, onCurrent), text(settingsText(row))];
    if (row.failure)
      return el("tr", {"data-key": row.key}, start, el("td", {class: "failure", colspan: head.length - 2}, `failed: ${row.failure}`));
    const time = row.frame_ms?.n > 0 ? row.frame_ms : null;
    return el("tr", {"data-key": row.key}, start, metrics.map((known) => cell(errorText(known, row))),
      cell(sparkline(row.spectrum)), cell(percent(lowFrequencyShare(row.spectrum))),
      table.baseline ? cell(ratioText(row.times_as_fast)) : null, cell(time ? number(time.median) : "–"),
      cell(time ? `${number(time.q1)}–${number(time.q3)}` : "–"),
      cell(isNumber(time?.p99) ? number(time.p99 / time.median) : "–"), cell(time ? String(time.n) : "–"),
      traced ? cell(referenceText(row.reference_ms)) : null, cell(isNumber(row.memory_bytes) ? number(row.memory_bytes / 2 ** 20) : "–"), cell(front.includes(row) ? "*" : ""));
  });
  const compared = table.baseline ? `Times as fast: against ${table.baseline}, with the interval of 95 % (n = 1: one turn, no interval). ` : "";
  return tableElement(`Errors and times. ${compared}${outdatedText(table.rows)}` +
    `* on the Pareto front of ${metric.label} and time (${time.label}); < below three times the reference's noise`, head, rows);
}

/**
 * The thesis's form: a line per setting, a column per resolution and number of lights. One renderer, machine, driver and mode; where
 * tables differ in their reference alone, the first one's times stand there.
 */
export function framesPerSecond(tables) {
  const columns = new Map(), lines = new Map(), shown = [];
  for (const table of tables) {
    for (const row of table.rows) {
      const ms = FRAME.read(row);
      if (!isNumber(ms)) continue;
      const lights = row.lights ? `, ${row.lights} light${row.lights > 1 ? "s" : ""}` : "";
      const column = `${table.time_size.join(" x ")}${lights}`;
      const {["environment lights"]: _, ...own} = row.parameters ?? {};
      const settings = settingsText({...row, parameters: own, environment_lights: 0});
      const key = `${row.title || row.technique}\n${settings}`;
      columns.set(column, table.time_size[0] * table.time_size[1] * 1e4 + (row.lights ?? 0));
      if (!lines.has(key)) lines.set(key, {row, settings, values: new Map()});
      const {values} = lines.get(key);
      if (values.has(column)) continue;
      values.set(column, {ms, mark: row.outdated ? OUTDATED : ""});  // a line may hold rows of several versions
      shown.push(row);
    }
  }
  if (lines.size === 0) return null;
  const ordered = [...columns].sort((a, b) => a[1] - b[1]).map(([name]) => name);
  const speedText = ({ms, mark}) => `${number(1000 / ms)} (${number(ms)} ms)${mark}`;
  const rows = [...lines.values()].map(({row, settings, values}) => el("tr", {}, nameCell({...row, outdated: false}, null),
    text(settings), ordered.map((column) => cell(values.has(column) ? speedText(values.get(column)) : "–"))));
  return tableElement(withNote("Frames per second (milliseconds per frame), by resolution and number of lights", shown),
    [...NAMES, ...ordered.map((label) => ({label}))], rows);
}

export function passTable(table) {
  const timed = table.rows.filter((row) => isNumber(FRAME.read(row)));
  if (timed.length === 0) return null;
  const parts = ["maps", "filters", "technique", "rest"];
  const bounded = timed.some((row) => row.x_bound);
  const summary = timed.map((row) => el("tr", {}, nameCell(row, null), text(settingsText(row)),
    parts.map((part) => cell(number(row.split_ms?.[part]))), cell(number(FRAME.read(row))),
    bounded ? cell(ratioText(row.x_bound)) : null));
  const every = timed.flatMap((row) => (row.passes ?? []).filter((pass) => pass.state !== "left_out").map((pass) =>
    el("tr", {}, nameCell(row, null), text(settingsText(row)), text(String(pass.technique)), text(String(pass.name)),
      cell(number(pass.ms)))));
  return [
    tableElement(withNote("Milliseconds per frame and where they go; passes are timed in a run of their own", timed), [...NAMES,
      ...["maps_ms", "filters_ms", "technique_ms"].map((key) => page.columns[key]), {label: "G-buffer, shading ms"},
      page.columns.median_ms, ...(bounded ? [page.columns.x_bound] : [])],
      summary),
    every.length ? el("details", {}, el("summary", {}, "Every pass"), tableElement(withNote("Milliseconds per pass", timed), [...NAMES,
      {label: "of", text: true}, {label: "pass", text: true}, {label: "ms"}], every)) : null,
  ];
}

