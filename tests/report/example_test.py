"""The example of docs/bench.md draws the rows of the small bench that schema_test.py has measured."""
import argparse
import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SKIPPED = 77

parser = argparse.ArgumentParser()
for option in ("results", "root"):
    parser.add_argument("--" + option, required=True, type=pathlib.Path)
options = parser.parse_args()
if importlib.util.find_spec("matplotlib") is None:
    print("skipped: no matplotlib (Debian package python3-matplotlib)")
    sys.exit(SKIPPED)
if not (options.results / "results.jsonl").is_file():
    print("skipped: report.schema, which measures the rows, was skipped")
    sys.exit(SKIPPED)

for drawn in options.results.glob("*.svg"):
    drawn.unlink()
example = re.search(r"```python\n(.*?)```", (options.root / "docs" / "bench.md").read_text(), re.S).group(1)


def curves(folder):
    """Runs the example in the folder and returns how many curves it draws."""
    printed = subprocess.run([sys.executable, "-c", example + "\nprint(len(points))"], cwd=folder, check=True, text=True,
                             stdout=subprocess.PIPE, env={**os.environ, "MPLBACKEND": "Agg"}).stdout
    return int(printed)


drawn = curves(options.results)
if not any(options.results.glob("*.svg")):
    sys.exit("FAILED: the example draws nothing")
rows = [row for row in map(json.loads, (options.results / "results.jsonl").open()) if "error" in row]
for what, changed in (("term", lambda row: {"term": "other " + row["term"]}),
                      ("size", lambda row: {"size": [8, 8]}),
                      ("mode", lambda row: {"dynamic": not row["dynamic"]}),
                      ("renderer", lambda row: {"stats": row["stats"] | {"renderer": "A GPU"}})):
    others = [row | changed(row) | {"key": row["key"] + "o"} for row in rows]
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "results.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows + others))
        if curves(folder) != 2 * drawn:
            sys.exit(f"FAILED: rows that differ in their {what} share a curve")
