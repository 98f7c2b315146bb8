// What `limn stress` found: which extremes each technique survives.
import {el, number} from "./dom.js";
import {tableElement} from "./tables.js";

const VERDICTS = [["pass", "\u2713"], ["degraded", "\u25b2"], ["refused", "\u25cb"], ["failed", "\u2715"]];

function verdictText(result) {
  const sign = VERDICTS.find(([name]) => name === result.verdict)?.[1] ?? "";
  return `${sign} ${result.verdict}${result.message ? `: ${result.message}` : ""}`;
}

function caseTable(caption, results) {
  const head = [...["technique", "case", "scene", "verdict"].map((label) => ({label, text: true})),
    {label: "error"}, {label: "unchanged"}, {label: "factor"}, {label: "allowed"}];
  const text = (value) => el("td", {class: "text"}, String(value ?? ""));
  return tableElement(caption, head, results.map((result) => {
    const measured = result.verdict === "pass" || result.verdict === "degraded";
    return el("tr", {}, el("th", {scope: "row"}, String(result.technique)),
      text(result.settings ? `${result.case} (${result.settings})` : result.case), text(result.scene),
      el("td", {class: "failure"}, verdictText(result)),
      [measured ? result.error : null, result.benign, measured ? result.factor : null, result.allowed]
        .map((value) => el("td", {}, number(value))));
  }));
}

/** The section, as a list of elements; none where limn stress was not run. */
export function stability(found) {
  const results = Array.isArray(found?.results) ? found.results : [];
  if (results.length === 0) return [];
  const techniques = [...new Set(results.map((result) => result.technique))];
  const counts = techniques.map((technique) => el("tr", {}, el("th", {scope: "row"}, String(technique)), VERDICTS.map(([verdict]) =>
    el("td", {}, String(results.filter((result) => result.technique === technique && result.verdict === verdict).length)))));
  const troubled = results.filter((result) => result.verdict !== "pass");
  return [el("section", {id: "stability", "aria-labelledby": "stability-name"},
    el("h2", {id: "stability-name"}, "Stability"),
    el("p", {class: "note"}, `Extreme cases by limn stress on ${found.renderer}. Factor: the error over that of the unchanged scene.`),
    tableElement("Extreme cases by verdict", [{label: "technique", text: true},
      ...VERDICTS.map(([name, sign]) => ({label: `${sign} ${name}`}))], counts),
    troubled.length ? caseTable("Cases that do not pass", troubled) : null,
    el("details", {}, el("summary", {}, "Every case"), caseTable("Every extreme case", results)))];
}
