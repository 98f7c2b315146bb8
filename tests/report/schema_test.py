"""Rows of a small bench, statistics of a frame and the stored results are as `limn schema` says."""
import argparse
import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77
SUITE = """
name = "schema"
sizes = ["40x30"]
frames = 2
warmup = 0
pictures = true
bound = true
separation_floor = true
reference = {spp = 4}
term = "visibility"
[[scenes]]
scene = "balls"
lights = ["key"]
max_masked_share = 0.2
[[scenes]]
scene = "glass_sphere"
term = "media"
g = 0.5
max_masked_share = 0.2
[[scenes]]
scene = "balls"
lights = ["key"]
term = "direct"
max_masked_share = 0.2
[[techniques]]
technique = "pcf"
[[techniques]]
technique = "airlight"
"""

parser = argparse.ArgumentParser()
for option in ("limn", "scratch", "root"):
    parser.add_argument("--" + option, required=True, type=pathlib.Path)
options = parser.parse_args()
if importlib.util.find_spec("jsonschema") is None:
    print("skipped: no jsonschema (Debian package python3-jsonschema)")
    sys.exit(SKIPPED)
import jsonschema


def limn(*arguments, **how):
    return subprocess.run([options.limn, *map(str, arguments)], stdout=subprocess.PIPE, text=True, **how).stdout


def shut(schema):
    """The schema that lets no key through that it does not describe."""
    if isinstance(schema, list):
        return [shut(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    closed = {key: shut(value) for key, value in schema.items()}
    if isinstance(schema.get("properties"), dict) and "type" in schema:
        closed["additionalProperties"] = False
    return closed


def validator(kind):
    schema = json.loads(limn("schema", kind, check=True))
    kind = jsonschema.validators.validator_for(schema)
    kind.check_schema(schema)
    return kind(schema), kind(shut(schema))


def check(validator, value, what):
    for error in validator.iter_errors(value):
        sys.exit(f"FAILED: {what}: {'/'.join(map(str, error.absolute_path))}: {error.message[:400]}")


out = options.scratch.resolve()
shutil.rmtree(out, ignore_errors=True)
out.mkdir(parents=True)
row, strict_row = validator("row")
_, strict_stats = validator("stats")

(out / "suite.toml").write_text(SUITE)
limn("bench", out / "suite.toml", "--out", out)  # a technique that does not answer a term is a row of a failure
rows = [json.loads(line) for line in (out / "results.jsonl").read_text().splitlines()]
for value in rows:
    check(strict_row, value, f"{value['scene']}/{value['technique']}")
print(f"{len(rows)} new rows, {sum('failure' in value for value in rows)} of them failures")
if not any(value["technique"] == "separation_floor" for value in rows):
    sys.exit("FAILED: no row of the separation floor")
if not any("x_bound" in value.get("stats", {}) for value in rows):
    sys.exit("FAILED: no row with a bound")

limn("render", "balls", "--technique", "pcss", "--size", "40x30", "--repeat", 1, "--stats", out / "stats.json", "--out", out / "a.png",
     check=True)
check(strict_stats, json.loads((out / "stats.json").read_text()), "stats")

for file in sorted((options.root / "docs" / "results").glob("*/*/results.jsonl")):
    stored = [json.loads(line) for line in file.read_text().splitlines()]
    for value in stored:
        check(row, value, f"{file.parent.name}: {value['scene']}/{value['technique']}")
    print(f"{len(stored)} rows of {file.parent.name}")

broken = dict(rows[0], technique=3)
if row.is_valid(broken) or row.is_valid({key: value for key, value in rows[0].items() if key != "error"}):
    sys.exit("FAILED: rows that are none pass")
if row.is_valid(dict(rows[0], medium={"g": None})):
    sys.exit("FAILED: a null passes that limn does not read")
