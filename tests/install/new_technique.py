"""scripts/new-technique: on day one the technique builds, renders, passes every technique's tests and has bench rows."""
import json
import pathlib
import re

from common import PREFIX, SOURCE, build, check, fail, fresh, limn, options, run, techniques

NAME = "stamped_2nd"
scratch = fresh("new_technique")
stamp = SOURCE / "scripts/new-technique"

printed, _ = run(stamp, NAME, "--into", scratch)
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

# Out of tree it is built and run as README.md says, word for word but for names and folders.
section = (SOURCE / "README.md").read_text().split("## A technique of your own")[1]
project = re.search("```cmake\n(.*?)```", section, re.DOTALL)[1]
(scratch / "CMakeLists.txt").write_text(project.replace("other_technique other_technique", f"{NAME} {NAME}"))
for told in (printed, section):
    check(" -G Ninja " in told, "a command for cmake takes make, which scripts/build does not install")
documented = re.search(r"LIMN_TECHNIQUE_PATH=\$HOME/my_techniques/(\S+)", section)[1]
build(scratch, scratch / "build")
path = {"LIMN_TECHNIQUE_PATH": str(scratch / documented)}

# It is optimised as limn is, though neither names a build type: its times stand beside those of limn's own.
run("cmake", scratch / "build", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
commands = [entry["command"] for entry in json.loads((scratch / "build/compile_commands.json").read_text())]
check(commands and all(" -O3 " in command for command in commands), f"compiled without optimisation: {commands}")

# A folder without sources is an error when the project is configured, not when its module is used.
nothing = scratch / "nothing"
nothing.mkdir()
(nothing / "CMakeLists.txt").write_text(project.replace("other_technique other_technique", NAME))
_, message = run("cmake", "-S", nothing, "-B", nothing / "build", "-G", options.generator,
                 f"-DCMAKE_CXX_COMPILER={options.compiler}", f"-DCMAKE_PREFIX_PATH={PREFIX}", status=1)
message = " ".join(message.split())
check(f"limn_add_technique({NAME}): no *.cpp in {nothing}; name the technique's folder: limn_add_technique({NAME} FOLDER)"
      in message, f"a folder without sources: {message}")

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
    run(tests, "--gtest_filter=TechniqueTest.EveryTechnique*:TechniqueTest.ShadowsOnly*", LIMN_TEST_TECHNIQUE=NAME, **path)
