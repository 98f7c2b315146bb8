// What to take for a budget: a slider for time or error, and the setting, its command and the runner-up that answer it.
import {breakable, chooser, el, milliseconds, number, putChoosers, slider} from "./dom.js";
import {command} from "./command.js";
import {METRICS, TIMES, errorText, knownMetrics, measured, paretoFront} from "./metrics.js";
import {curves as curvesOf, markedTitle, outdatedText, settingsText} from "./series.js";
import {tableElement} from "./tables.js";
import {swatch} from "./marks.js";

/** `of` is the figure of a point that the budget bounds: which of several errors below the noise is less, nobody knows. */
const KINDS = [
  {key: "ms", of: "ms", bounded: "at most this time", label: "Most milliseconds", text: milliseconds,
   better: (a, b) => a.bound - b.bound || a.ms - b.ms},
  {key: "error", of: "bound", bounded: "at most this error", label: "Largest error", text: number,
   better: (a, b) => a.ms - b.ms || a.bound - b.bound},
];

/** All points of the curves: {row, error, ms, bound, curve}. */
function pointsOf(curves, metric, time) {
  return curves.flatMap((curve) => measured(curve.rows, metric, time).map((point) => ({...point, curve})));
}

/**
 * The best point within the budget, and the best of another curve: of least error in that time, or quickest at that error.
 * Outdated points come after all others.
 */
export function take(curves, metric, time, kind, budget) {
  const age = ({row}) => (row.outdated ? 1 : 0);
  const within = pointsOf(curves, metric, time).filter((point) => point[kind.of] <= budget)
    .sort((a, b) => age(a) - age(b) || kind.better(a, b));
  return {best: within[0] ?? null, next: within.find((point) => point.curve !== within[0].curve) ?? null};
}

const pointText = (point, metric) => `${metric.label} ${errorText(metric, point.row)}, ${milliseconds(point.ms)}`;

function settingName({row, curve}) {
  return el("strong", {}, swatch(curve), breakable(markedTitle(row)), " ", breakable(settingsText(row)));
}

function outdatedNote(points) {
  const text = outdatedText(points.map(({row}) => row));
  return text ? el("p", {class: "note"}, text) : null;
}

/** The middle of the values on a logarithmic scale. */
const middle = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** Asks for a kind of budget and its amount; `answer(kind, budget)` gives a line that is read aloud, and what stands below. */
function asked(all, answer) {
  const said = el("p", {"aria-live": "polite"}), body = el("div"), tools = el("div", {class: "tools"});
  const choose = (kind) => {
    const values = all.map((point) => point[kind.of]).filter((value) => value > 0);
    // The ends are values that rows have: rounding must not lose them.
    const show = (value) => {
      const {line, below} = answer(kind, value * (1 + 1e-9));
      said.replaceChildren(...line);
      body.replaceChildren(...below);
    };
    putChoosers(tools, [
      chooser("Budget", kinds.map((other) => ({value: other.key, label: other.bounded})), kind.key,
        (key) => choose(kinds.find((other) => other.key === key))),
      slider(kind.label, values, middle(values), kind.text, show),
    ]);
  };
  const kinds = KINDS.filter(({of}) => all.some((point) => point[of] > 0));
  if (kinds.length === 0) return null;
  choose(kinds[0]);
  return [tools, said, body];
}

/** For one table: the setting to take, with its command, and the runner-up. `onBudget(kind.key, budget)` marks it elsewhere. */
export function takeOne(curves, metric, time, onBudget) {
  const answer = (kind, budget) => {
    onBudget(kind.key, budget);
    const {best, next} = take(curves, metric, time, kind, budget);
    if (!best) return {line: [`Nothing measured keeps ${kind.text(budget)}.`], below: []};
    return {line: ["Take ", settingName(best), `: ${pointText(best, metric)}.`], below: [
      command(best.row),
      next && el("p", {class: "note"}, "Runner-up: ", settingName(next), `: ${pointText(next, metric)}.`),
      outdatedNote([best, next].filter(Boolean)),
    ].filter(Boolean)};
  };
  const parts = asked(pointsOf(curves, metric, time), answer);
  return parts && el("div", {class: "take"}, el("h3", {}, "What to take"), parts);
}

/** How often each curve's technique is on the front and best within the budget, over the tables. */
function tally(fronts, taken) {
  const counts = new Map();
  const count = (name) => counts.get(name) ?? counts.set(name, {asked: 0, front: 0, best: 0}).get(name);
  fronts.forEach(({points, front}, i) => {
    for (const name of new Set(points.map(({row}) => row.technique))) count(name).asked++;
    for (const name of new Set(front.map(({row}) => row.technique))) count(name).front++;
    if (taken[i].best) count(taken[i].best.row.technique).best++;
  });
  return [...counts].sort(([, a], [, b]) => b.best - a.best || b.front - a.front || a.asked - b.asked);
}

/** Over all scenes that are asked the same: what to take in each, and how often each technique is taken. */
function takeMany(tables, metric, time, onVisit) {
  const fronts = tables.map((table) => {
    const curves = curvesOf(table.rows), points = pointsOf(curves, metric, time);
    return {table, curves, points, front: paretoFront(points)};
  });
  const answer = (kind, budget) => {
    const taken = fronts.map(({curves}) => take(curves, metric, time, kind, budget));
    const lineOf = ({table, points}, {best}) => el("tr", {}, el("th", {scope: "row"}, el("button", {type: "button",
      click: () => onVisit(table, best?.row)}, table.subject)), best
      ? [el("td", {class: "text"}, breakable(markedTitle(best.row))), el("td", {class: "text"}, settingsText(best.row)),
         el("td", {}, errorText(metric, best.row)), el("td", {}, number(best.ms)), el("td", {class: "text"}, command(best.row))]
      : el("td", {class: "text", colspan: 5},
           points.length > 0 ? `nothing keeps ${kind.text(budget)}` : "no row has both a time and this error"));
    const counts = tally(fronts, taken), [most, {best: often}] = counts[0];
    const kept = taken.filter(({best}) => best).length;
    const counted = counts.map(([technique, {asked, front, best}]) => el("tr", {}, el("th", {scope: "row"}, technique),
      [best, front, asked].map((value) => el("td", {}, String(value)))));
    const line = `${kind.text(budget)} is kept in ${kept} of ${fronts.length} scenes` +
      (often > 0 ? `; most often, in ${often}, ${most} is the one to take.` : ".");
    return {line: [line], below: [
      tableElement(`What to take with ${kind.text(budget)}`, [{label: "scene", text: true}, {label: "take", text: true},
        {label: "parameters", text: true}, {label: metric.label, help: metric.help}, {label: "ms"}, {label: "command", text: true}],
        fronts.map((front, i) => lineOf(front, taken[i]))),
      tableElement("In how many scenes a technique is the one to take, is on the Pareto front, and was measured",
        [{label: "technique", text: true}, {label: "to take"}, {label: "on the front"}, {label: "measured"}], counted),
      outdatedNote(taken.flatMap(({best}) => best ?? [])),
    ].filter(Boolean)};
  };
  return asked(fronts.flatMap(({points}) => points), answer) ?? [el("p", {class: "note"}, "No row has both a time and this error.")];
}

const distinct = (values) => [...new Set(values)];

/**
 * The first answer of the page, over all scenes. `question(table)` says what a scene was asked and how it was measured,
 * `onVisit(table, row)` goes to one. Nothing where there is only one scene: its own section says it.
 */
export function takeOverAll(tables, {question, onVisit}) {
  const questions = distinct(tables.map(question));
  const of = (text) => tables.filter((table) => question(table) === text);
  if (questions.every((text) => of(text).length < 2)) return null;
  const most = questions.reduce((a, b) => (of(b).length > of(a).length ? b : a));
  const tools = el("div", {class: "tools"}), body = el("div");
  const options = (items) => items.map(({key, label}) => ({value: key, label}));
  let metric = METRICS[0], time = TIMES[0];
  const show = (text) => {
    const rows = of(text).flatMap((table) => table.rows), metrics = knownMetrics(rows);
    metric = metrics.find((other) => other.key === metric.key) ?? metrics[0] ?? METRICS[0];
    putChoosers(tools, [
      chooser("Question", questions.map((other) => ({value: other, label: `${other} (${of(other).length} scenes)`})), text, show),
      chooser("Error", options(metrics), metric.key, (key) => { metric = METRICS.find((other) => other.key === key); show(text); }),
      chooser("Time", options(TIMES), time.key, (key) => { time = TIMES.find((other) => other.key === key); show(text); }),
    ]);
    body.replaceChildren(...takeMany(of(text), metric, time, onVisit));
  };
  show(most);
  return el("section", {id: "take", "aria-labelledby": "take-name"}, el("h2", {id: "take-name"}, "What to take for a budget"), tools, body);
}
