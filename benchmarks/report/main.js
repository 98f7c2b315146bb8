// The report of a bench: reads what `limn bench` put into the page and shows it, a section per subject.
import "./licence.js";
import {Section} from "./section.js";
import {el} from "./dom.js";
import {groupBy} from "./series.js";
import {page} from "./page.js";
import {stability} from "./stability.js";
import {takeOverAll} from "./take.js";

const main = document.getElementById("results");

function summary(tables) {
  const renderers = [...new Set(tables.map((table) => table.renderer))];
  return renderers.map((renderer) => {
    const own = tables.filter((table) => table.renderer === renderer);
    const all = (key) => [...new Set(own.flatMap((table) => table[key]))];
    const counts = (key) => all(key).sort((a, b) => a - b).join(", ").replace(/, (?=[^,]*$)/, " or ");
    const failed = own.flatMap((table) => table.rows).filter((row) => row.failure).length;
    const rows = own.flatMap((table) => table.rows).length;
    const software = own.some((table) => table.software), known = own.some((table) => table.software !== null);
    const machines = all("machines"), several = ["machines", "drivers"].filter((key) => all(key).length > 1);
    return el("div", {class: "machine"},
      el("p", {}, el("strong", {}, renderer), known ? ` – ${software ? "software" : "hardware"} rendering. ` : ". ",
        all("drivers").map((driver) => `Driver: ${driver}. `), machines.map((machine) => `Machine: ${machine}. `),
        `${rows} row${rows === 1 ? "" : "s"}${failed ? `, ${failed} failed` : ""}; `,
        `medians of ${counts("frames")} ${counts("frames") === "1" ? "frame" : "frames"} a turn (turns: ${counts("turns") || "none"}), after ${counts("warmup")} to warm up.`),
      several.length ? el("p", {class: "note"}, `Rows of several ${several.join(" and ")}: each has charts and tables of its own.`) : null,
      software ? el("p", {class: "note"}, "Software rendering says nothing about the times of a GPU.") : null);
  });
}

const bySubject = groupBy(page.tables, (table) => table.subject);
const sections = [...bySubject.values()].map((tables, i) => new Section(tables, `subject-${i}`));
main.replaceChildren(
  ...summary(page.tables),
  ...(page.compressed ? [el("p", {class: "note"}, "To keep this file small, whole pictures are compressed with loss (WebP)" +
    (page.reduction > 1 ? ` and reduced ${page.reduction} times in both directions` : "") +
    "; magnified windows are not, and pictures/ beside it has all of them whole.")] : []),
  ...[takeOverAll(page.tables, {
    question: (table) => `${table.term}, ${table.measured}`,
    onVisit: (table, row) => sections.find((section) => section.tables.includes(table)).goTo(table, row)})].filter(Boolean),
  ...(sections.length > 1 ? [el("nav", {"aria-label": "Scenes"}, el("ul", {class: "contents"}, sections.map((section, i) =>
    el("li", {}, el("a", {href: `#subject-${i}`, click: () => section.open()}, section.subject)))))] : []),
  ...(sections.length ? sections.map((section) => section.element) : [el("p", {}, "No rows yet.")]),
  ...stability(page.stability));

// What is near the window is made at once, the rest while nothing else happens: the page answers before it is whole.
const near = new IntersectionObserver((entries) => {
  for (const entry of entries.filter(({isIntersecting}) => isIntersecting)) {
    near.unobserve(entry.target);
    sections.find((section) => section.element === entry.target).open();
  }
}, {rootMargin: "100%"});
for (const section of sections) near.observe(section.element);
const openAll = () => sections.forEach((section) => section.open());
addEventListener("beforeprint", openAll);
document.documentElement.dataset.ready = "no";
const idle = window.requestIdleCallback ?? ((callback) => setTimeout(callback, 50));
function openNext() {
  const next = sections.find((section) => !section.table);
  next?.open();
  if (next) idle(openNext);
  else document.documentElement.dataset.ready = "yes";
}
idle(openNext);
