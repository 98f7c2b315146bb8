// What `limn stress` found: which extremes each technique survives.
import {el, number} from "./dom.js";
import {tableElement} from "./tables.js";

const VERDICTS = [["pass", "\u2713"], ["degraded", "\u25b2"], ["refused", "\u25cb"], ["failed", "\u2715"]];

/** The answers, the one that counts first; results of earlier versions are their only one. */
const answersOf = (result) => Array.isArray(result.answers) && result.answers.length > 0 ? result.answers : [result];
const worst = (result) => answersOf(result)[0];

function verdictText(answer) {
  const sign = VERDICTS.find(([name]) => name === answer.verdict)?.[1] ?? "";
  return `${sign} ${answer.verdict}${answer.message ? `: ${answer.message}` : ""}`;
}

const measured = (answer) => answer.verdict === "pass" || answer.verdict === "degraded";

/** Null where nothing was measured, and where the case allows no factor (0): there only values are checked. */
const factorOf = (result, answer) => (measured(answer) && result.allowed !== 0 ? answer.factor : null);

/** The term that counts, and the others: "indirect (visibility 1.00)". */
function termText(result) {
  const others = answersOf(result).slice(1).map((answer) =>
    `${answer.term} ${measured(answer) ? number(factorOf(result, answer)) : answer.verdict}`);
  return (worst(result).term ?? "") + (others.length ? ` (${others.join(", ")})` : "");
}

/** What distinguishes the case: "four steps (steps=4, beside airlight)". */
function caseText(result) {
  const details = [result.settings, result.beside && `beside ${result.beside}`].filter(Boolean).join(", ");
  return details ? `${result.case} (${details})` : result.case;
}

function caseTable(caption, results) {
  const head = [...["technique", "case", "scene", "verdict", "term that counts (others)"].map((label) => ({label, text: true})),
    {label: "error"}, {label: "unchanged"}, {label: "factor"}, {label: "allowed"}];
  const text = (value) => el("td", {class: "text"}, String(value ?? ""));
  return tableElement(caption, head, results.map((result) => {
    const answer = worst(result);
    return el("tr", {}, el("th", {scope: "row"}, `${result.technique}${result.outdated ? " †" : ""}`),
      text(caseText(result)), text(result.scene),
      el("td", {class: "failure"}, verdictText(answer)), text(termText(result)),
      [measured(answer) ? answer.error : null, answer.benign, factorOf(result, answer), result.allowed || null]
        .map((value) => el("td", {}, number(value))));
  }));
}

/** The section, as a list of elements; none where limn stress was not run. */
export function stability(found) {
  const results = Array.isArray(found?.results) ? found.results : [];
  if (results.length === 0) return [];
  const techniques = [...new Set(results.map((result) => result.technique))];
  const counts = techniques.map((technique) => el("tr", {}, el("th", {scope: "row"}, String(technique)), VERDICTS.map(([verdict]) =>
    el("td", {}, String(results.filter((result) => result.technique === technique && worst(result).verdict === verdict).length)))));
  const troubled = results.filter((result) => worst(result).verdict !== "pass");
  return [el("section", {id: "stability", "aria-labelledby": "stability-name"},
    el("h2", {id: "stability-name"}, "Stability"),
    el("p", {class: "note"}, `Extreme cases by limn stress on ${found.renderer}. Factor: the error over that of the unchanged scene.`,
      results.some((result) => result.outdated)
        ? " † measured with another version of the program, of a technique or of the scene than the newest case." : null),
    tableElement("Extreme cases by verdict", [{label: "technique", text: true},
      ...VERDICTS.map(([name, sign]) => ({label: `${sign} ${name}`}))], counts),
    troubled.length ? caseTable("Cases that do not pass", troubled) : null,
    el("details", {}, el("summary", {}, "Every case"), caseTable("Every extreme case", results)))];
}
