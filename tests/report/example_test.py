"""The example of docs/bench.md draws the rows of the small bench that schema_test.py has measured."""
import argparse
import importlib.util
import os
import pathlib
import re
import subprocess
import sys

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
subprocess.run([sys.executable, "-c", example], cwd=options.results, check=True, env={**os.environ, "MPLBACKEND": "Agg"})
if not any(options.results.glob("*.svg")):
    sys.exit("FAILED: the example draws nothing")
