// One subject (scene, camera, light, environment): its chart, its pictures and its tables. A table of the bench is
// shown at a time, so that terms, sizes, modes and renderers never mix.
import {breakable, chooser, el, number, putChoosers} from "./dom.js";
import {METRICS, TIMES, isNumber, knownMetrics, tracedBy} from "./metrics.js";
import {OUTDATED, SEPARATION_FLOOR, curveOf, curves as curvesOf} from "./series.js";
import {commonTarget, equalRows, nearest} from "./equal.js";
import {errorTable, framesPerSecond, passTable} from "./tables.js";
import {detail} from "./detail.js";
import {drawPlot} from "./plot.js";
import {drawSpectrum} from "./spectrum.js";
import {swatch} from "./marks.js";
import {takeOne} from "./take.js";

const unique = (values) => [...new Set(values)];

/** Has a place on the page from the beginning and content once it is opened, so that long reports are read at once. */
export class Section {
  constructor(tables, id) {
    this.tables = tables;
    this.subject = tables[0].subject;
    this.tools = el("div", {class: "tools"});
    this.body = el("div");
    this.element = el("section", {id, "aria-labelledby": `${id}-name`},
      el("h2", {id: `${id}-name`, tabindex: -1}, this.subject), this.tools, this.body);
    this.time = TIMES[0];
  }

  /** Makes the content, once. */
  open() {
    if (this.table) return;
    this.choose(this.tables[0]);
    // Charts are drawn for a width; what stands beside them keeps the focus when it changes.
    new ResizeObserver(() => { if (this.body.clientWidth !== this.width) this.drawCharts(); }).observe(this.body);
  }

  choose(table) {
    this.table = table;
    const metrics = knownMetrics(table.rows);
    this.metric = metrics.find((metric) => metric.key === this.metric?.key) ?? metrics[0] ?? METRICS[0];
    this.curves = curvesOf(table.rows);
    this.current = table.rows.find((row) => !row.failure && row.technique !== SEPARATION_FLOOR) ?? table.rows[0];
    this.show();
  }

  showTools() {
    const {table, tables, metric} = this;
    const sameTerm = tables.filter((other) => other.term === table.term);
    const options = (items) => items.map(({key, label}) => ({value: key, label}));
    const terms = unique(tables.map((other) => other.term));
    putChoosers(this.tools, [
      chooser("Term", terms.map((term) => ({value: term, label: term})), table.term,
        (term) => this.choose(tables.find((other) => other.term === term))),
      chooser("Measured", sameTerm.map((other, i) => ({value: String(i), label: other.measured})),
        String(sameTerm.indexOf(table)), (i) => this.choose(sameTerm[Number(i)])),
      chooser("Error", options(knownMetrics(table.rows)), metric.key,
        (key) => { this.metric = METRICS.find((other) => other.key === key); this.show(); }),
      chooser("Time", options(TIMES), this.time.key,
        (key) => { this.time = TIMES.find((other) => other.key === key); this.show(); }),
    ]);
  }

  show() {
    const {table, curves, metric, time} = this;
    this.showTools();
    this.chart = el("div", {class: "chart"});
    this.name = el("h3", {"aria-live": "polite"});
    this.facts = el("div");
    this.detail = el("div", {class: "detail"}, this.name, this.facts);
    this.spectrum = el("div", {class: "chart"});
    const legend = el("ul", {class: "legend"}, curves.map((curve) => el("li", {}, swatch(curve), curve.name)));
    const noise = isNumber(table.reference.noise_rms)
      ? `Noise of the reference: ${number(100 * table.reference.noise_rms)} % of the mean. ` : "";
    const others = this.tables.filter((other) => other !== table && other.term === table.term && other.renderer === table.renderer &&
      other.machines.join() === table.machines.join() && other.drivers.join() === table.drivers.join() &&
      other.dynamic === table.dynamic);
    this.budget = null;
    this.body.replaceChildren(...[
      takeOne(curves, metric, time, (...budget) => { this.budget = budget; this.plot?.budget(...budget); }),
      el("p", {class: "note"}, `Term: ${table.term}. ${table.measured}. ${noise}${metric.label}: ${metric.help}.`),
      el("div", {class: "columns"},
        el("div", {}, this.chart, legend,
          el("p", {class: "note"}, "Ringed points lie on the Pareto front; errors below the reference's noise count as equal. " +
            "Hover, touch or focus a point to see it; bars are quartiles of the time.")),
        this.detail,
        el("div", {}, el("h3", {}, "Frequency content of the error"), this.spectrum,
          el("p", {class: "note"},
            "Strong: the setting shown; the others at equal time. Noise is level, banding stands at the left."))),
      ...equalRows(table, curves, metric, time),
      el("h3", {}, "Tables"), errorTable(table, metric, time, (row) => this.visit(row)),
      framesPerSecond([table, ...others]), ...(passTable(table) ?? []),
    ].filter(Boolean));
    this.drawCharts();
    this.describe();
  }

  drawCharts() {
    if (!this.body.isConnected) return;  // the observer calls again once there is a width
    const {table, curves, metric, time} = this;
    const floor = table.rows.find((row) => row.technique === SEPARATION_FLOOR && !row.failure);
    const focused = this.chart.contains(document.activeElement);
    this.plot = drawPlot(this.chart, {curves, rows: table.rows, metric, time, level: floor && metric.read(floor),
      traced: tracedBy(table, metric, time), onCurrent: (row) => { if (row !== this.current) this.select(row); }});
    if (this.budget) this.plot.budget(...this.budget);
    this.plot.mark(this.current);
    this.drawSpectra();
    this.width = this.body.clientWidth;
    if (focused) this.chart.querySelector(".current")?.focus();
  }

  /** From a table: the setting may be out of sight. */
  visit(row) {
    this.select(row);
    this.detail.scrollIntoView({block: "nearest"});
  }

  /** From elsewhere on the page: one of the section's tables, and a row of it if there is one. */
  goTo(table, row) {
    this.open();
    if (this.table !== table) this.choose(table);
    if (row) this.select(row);
    this.element.scrollIntoView();
    this.element.querySelector("h2").focus();
  }

  select(row) {
    this.current = row;
    this.plot.mark(row);
    this.drawSpectra();
    this.describe();
  }

  /** Says what the current setting is, and marks it in the table. */
  describe() {
    const row = this.current;
    this.name.replaceChildren(...breakable(row.name), ...(row.outdated ? [OUTDATED] : []));
    this.facts.replaceChildren(...detail(this.table, row));
    for (const line of this.body.querySelectorAll("tr[data-key]")) line.classList.toggle("current", line.dataset.key === row.key);
  }

  /** The current setting's, and those of the others at equal time. */
  drawSpectra() {
    const {curves, metric, time, current: row} = this;
    const own = curveOf(curves, row);
    const target = time.read(row) ?? commonTarget(curves, metric, time, "ms");
    const others = target ? nearest(curves, metric, time, "ms", target).found.filter((point) => point.curve !== own) : [];
    drawSpectrum(this.spectrum, own ? [{curve: own, row}, ...others] : others, row);
  }
}
