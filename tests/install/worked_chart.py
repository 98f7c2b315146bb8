"""A chart more on the report page, made as CONTRIBUTING.md describes it in a scratch copy of benchmarks/report: it is bundled as
limn's page is, and drawn in a browser from the data that the program of worked_examples.py writes. Skipped without a browser."""
import os
import sys

from common import SCRATCH, SOURCE, cached, check, fresh, run
from scratch_copy import Addition, copy_sources

sys.path.append(str(SOURCE / "tests/report"))
from chromium import Browser  # noqa: E402

SKIPPED = 77
CHART = """// How many rows each technique has, as bars.
import {scaleLinear} from "d3-scale";
import {create} from "d3-selection";

import {el} from "./dom.js";

/** The section, as a list of elements. */
export function counts(tables) {
  const rows = tables.flatMap((table) => table.rows);
  const techniques = [...new Set(rows.map((row) => row.technique))];
  const x = scaleLinear([0, rows.length], [0, 200]);
  const svg = create("svg").attr("class", "counts").attr("width", 200).attr("height", 20 * techniques.length).attr("role", "img")
    .attr("aria-label", "Rows by technique");
  for (const [i, technique] of techniques.entries())
    svg.append("rect").attr("y", 20 * i).attr("height", 16)
      .attr("width", x(rows.filter((row) => row.technique === technique).length));
  return [el("section", {id: "counts"}, el("h2", {}, "Rows by technique"), svg.node())];
}
"""

scratch = fresh("worked_chart")
report = scratch / "benchmarks/report"


def add_chart():
    chart = Addition(scratch, "A chart of the report")
    chart.create("benchmarks/report/counts.js", CHART)
    chart.before("benchmarks/report/main.js", 'import {el} from "./dom.js";\n', 'import {counts} from "./counts.js";\n')
    chart.before("benchmarks/report/main.js", "  ...stability(page.stability)", "  ...counts(page.tables),\n")


def build_page():
    """Bundles and assembles the page as core/CMakeLists.txt does, and puts the data into it."""
    script, template = scratch / "page.js", scratch / "page.html"
    run(cached("LIMN_ESBUILD"), report / "main.js", "--bundle", "--format=iife", "--charset=ascii", "--minify-whitespace",
        "--legal-comments=inline", "--log-level=warning", f"--outfile={script}", NODE_PATH=cached("LIMN_NODE_MODULES"))
    run(sys.executable, "-B", report / "assemble.py", report / "page.html", report / "page.css", script, template)
    page = scratch / "index.html"
    data = (SCRATCH / "worked_examples/report.json").read_text()
    page.write_text(template.read_text().replace("{{pictures}}", "").replace("{{data}}", data))
    return page


copy_sources(scratch, "benchmarks/report")
add_chart()
page = build_page()
chromium = cached("LIMN_CHROMIUM")
if not os.path.isfile(chromium):
    print("skipped: the chart is built, and no chromium draws it (Debian package chromium)")
    sys.exit(SKIPPED)
with Browser(chromium) as browser:
    browser.open(page)
    check(not browser.problems, f"the page complains: {browser.problems}")
    bars = browser.evaluate("[...document.querySelectorAll('#counts svg.counts rect')].map(bar => bar.getBBox().width)")
    check(bars == [200], f"the bars are {bars} wide, expected one of 200")
    check(browser.evaluate("document.querySelectorAll('svg.plot').length") == 1, "the page's own chart is gone")
    errors = browser.evaluate("[...document.querySelectorAll('.chooser option')].map(option => option.textContent)")
    check("worst error" in errors, f"the metric that worked_examples.py added cannot be chosen: {errors}")
