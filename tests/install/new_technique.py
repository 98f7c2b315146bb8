"""scripts/new-technique: on day one the technique builds, renders, passes every technique's tests and has bench rows."""
import json
import pathlib

from common import SOURCE, build, check, fail, fresh, limn, options, run, techniques

NAME = "stamped_2nd"
scratch = fresh("new_technique")
stamp = SOURCE / "scripts/new-technique"

run(stamp, NAME, "--into", scratch)
folder = scratch / NAME
files = sorted(folder.iterdir())
lines = sum(len(file.read_text().splitlines()) for file in files)
check(len(files) <= 4, f"{len(files)} files, at most 4: {files}")
check(lines <= 150, f"{lines} lines, at most 150")
for file in files:
    check("@" not in file.read_text(), f"a placeholder is left in {file}")

# Bad names and folders that exist are refused in one line.
for arguments in ([], ["Upper"], ["../up"], ["2nd"], ["with-dash"], [""], ["é"], [NAME, "--into", scratch],
                  ["name", "--into", scratch / "none"], ["a", "b"], ["--unknown"]):
    _, message = run(stamp, *arguments, status=2)
    check(message.count("\n") == 1 and message.startswith("new-technique: "), f"{arguments}: {message}")
check(not list(scratch.glob(".*")), "something was left behind")

project = scratch / "project"
project.mkdir()
(project / "CMakeLists.txt").write_text(
    "cmake_minimum_required(VERSION 3.25)\nproject(outside LANGUAGES CXX)\nfind_package(limn REQUIRED)\n"
    f"limn_add_technique({NAME} {folder})\n")
build(project, scratch / "build")
path = {"LIMN_TECHNIQUE_PATH": str(scratch / "build/lib/limn/techniques")}

check(NAME in techniques(**path), f"limn list does not show {NAME}")
picture = scratch / "picture.png"
limn("render", "cornell_box", "--technique", NAME, "--size", "64x48", "--out", picture, **path)
check(picture.stat().st_size > 0, "no picture")

limn("bench", folder / "bench.toml", "--filter", "cornell_box", "--out", scratch / "bench", **path)
rows = [json.loads(row) for row in (scratch / "bench/results.jsonl").read_text().splitlines()]
check(len(rows) == 2, f"{len(rows)} bench rows, expected 2")
for row in rows:
    if not (row["technique"] == NAME and 0 < row["error"]["rmse"] < 1 and row["stats"]["frame_ms"]["median"] > 0):
        fail(f"a bench row lacks error or time: {row}")
check(rows[1]["error"]["rmse"] != rows[0]["error"]["rmse"], "the swept parameter changes nothing")

# The laws that every technique obeys are its tests.
tests = pathlib.Path(options.build) / "bin/limn_gpu_tests"
if tests.exists():
    run(tests, "--gtest_filter=TechniqueTest.EveryTechnique*:TechniqueTest.ShadowsOnly*", **path)
