#!/usr/bin/env python3
"""Holds the answers of `limn tune` against the grid of all settings, and prints a table for docs/tune.md.

In each scene every setting is measured (`--exhaustive`), and two questions are asked: the quickest setting whose error a quarter
of the grid keeps, and the least error in a time that about half of the grid keeps. A last bench times both answers and those of the
grid that may be better in turns one after the other, since times of the grid and of a search are minutes apart. The same command
goes on where it was interrupted.
"""
import argparse
import json
import math
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

VISIBILITY = "--light key --steps 1 --techniques"
SCENES = {  # what `limn tune` is asked
    "balls": f"balls {VISIBILITY} hard_shadow_map,pcf,pcss",
    "chess": f"chess {VISIBILITY} hard_shadow_map,savsm,moment_soft_shadow_map",
    "teapot": f"teapot_pattern {VISIBILITY} pcf,cssm",
    "frog": f"frog {VISIBILITY} hard_shadow_map,pcss,sampled_area_light",
    "soda": "soda_corner --term direct --steps 1 --techniques hard_shadow_map,pcss,savsm",
    "gem": "gem --term caustic --steps 2 --techniques surface_caustics --set surface_caustics.medium_steps=16",
    "milk": "milk --term subsurface --steps 2 --techniques subsurface_scattering,separable_subsurface",
    "colonnade": "colonnade --term indirect --steps 1 "
                 "--techniques reflective_shadow_map,imperfect_shadow_maps,clustered_visibility "
                 "--set clustered_visibility.points=4096 --set clustered_visibility.terms=4 --set clustered_visibility.splits=1",
}
EFFORT = "--size 128x96 --spp 256 --frames 3 --turns 2 --max-masked-share 0.05"
TURNS = 8  # of the last bench
STUDENT = 2.365  # 97.5 % of Student's distribution with TURNS - 1 degrees of freedom
RIVALS = 6  # settings of the grid that are timed again for each answer
NEAR = 1.25  # a time of the grid may be off by this factor


def run(command, log):
    """Returns the output of a command, and the processor time of it and its children in seconds."""
    with log.open("w") as said, subprocess.Popen(command, stdout=subprocess.PIPE, stderr=said, text=True) as process:
        output = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}: exit status {process.returncode}, {log} says why")
    return output, usage.ru_utime + usage.ru_stime


def tune(limn, scene, out, *limit):
    """Returns what `limn tune --json` prints, with the processor time of all of it."""
    file = out.with_suffix(".json")
    if not file.exists():
        shutil.rmtree(out, ignore_errors=True)
        question = f"{SCENES[scene]} {EFFORT}".split()
        output, seconds = run([limn, "tune", *question, *limit, "--json", "--out", out], out.with_suffix(".log"))
        file.write_text(json.dumps(json.loads(output) | {"seconds": seconds}))
    return json.loads(file.read_text())


def setting(row):
    """Returns technique and parameters of a row or an answer."""
    return row["technique"], tuple(sorted((name, str(value)) for name, value in row["parameters"].items()))


def rows(folder):
    """Returns the rows of a folder by their settings, without those that failed."""
    return {setting(row): row for row in map(json.loads, (folder / "results.jsonl").open()) if "error" in row}


def error(row):
    return row["error"]["rmse"]


def ms(row):
    return row["stats"]["frame_ms"]["median"]


def timed_again(limn, settings, grid, out):
    """Returns rows of these settings that one bench measured in turns."""
    suite = (grid / "tuned.toml").read_text().split("\n[[techniques]]")[0]
    suite = re.sub(r"^turns = .*$", f"turns = {TURNS}", suite, flags=re.M)
    for technique, parameters in settings:
        values = ", ".join(f'{name.removeprefix(technique + ".")} = "{value}"' for name, value in parameters)
        suite += f'\n[[techniques]]\ntechnique = "{technique}"\nparameters = {{{values}}}\n'
    out.mkdir(exist_ok=True)
    (out / "suite.toml").write_text(suite)
    run([limn, "bench", out / "suite.toml", "--out", out], out / "bench.log")
    return rows(out)


def ratio(above, below):
    """Returns the ratio of two rows' times, turn by turn, and its interval of 95 %."""
    def turns(row):
        samples = row["stats"]["frame_samples_ms"]
        frames = len(samples) // TURNS
        return [statistics.median(samples[i * frames:(i + 1) * frames]) for i in range(TURNS)]
    if above is below:
        return 1, 1, 1
    logs = [math.log(a / b) for a, b in zip(turns(above), turns(below))]
    middle, half = statistics.fmean(logs), STUDENT * statistics.stdev(logs) / math.sqrt(TURNS)
    return math.exp(middle), math.exp(middle - half), math.exp(middle + half)


def rounded_up(value):
    """Returns a number of four digits that is not below the value: a limit that the setting with that error keeps."""
    step = 10 ** (math.floor(math.log10(value)) - 3)
    return float(f"{math.ceil(value / step) * step:.4g}")


def middle_gap(values):
    """Returns the middle of the widest gap between values of the middle third: where settings take as long as the limit, noise
    decides which of them keep it."""
    values = sorted(values)
    middle = values[len(values) // 3:len(values) - len(values) // 3]
    low, high = max(zip(middle, middle[1:]), key=lambda pair: pair[1] / pair[0])
    return math.sqrt(low * high)


def judged(limn, scene, out):
    """Returns the lines of the table that a scene has: their cells, the ratio to the grid's best and the share of the cost."""
    out.mkdir(parents=True, exist_ok=True)
    grid = tune(limn, scene, out / "grid", "--max-error", "rmse=1e9", "--exhaustive")
    every = rows(out / "grid")
    most_error = rounded_up(sorted(map(error, every.values()))[len(every) // 4])
    most_ms = float(f"{middle_gap(map(ms, every.values())):.4g}")
    quick = tune(limn, scene, out / "quickest", "--max-error", f"rmse={most_error}")
    good = tune(limn, scene, out / "best", "--max-ms", f"{most_ms}")
    quickest, best = setting(quick["answer"]), setting(good["answer"])

    keep = sorted((s for s in every if error(every[s]) <= most_error), key=lambda s: ms(every[s]))
    better = sorted((s for s in every if error(every[s]) < error(every[best]) and ms(every[s]) < NEAR * most_ms),
                    key=lambda s: error(every[s]))
    again = timed_again(limn, dict.fromkeys([quickest, best, *keep[:RIVALS], *better[:RIVALS]]), out / "grid", out / "again")

    rival = min((s for s in again if s in keep), key=lambda s: ms(again[s]))
    time, low, high = ratio(again[quickest], again[rival])
    allowed = max(most_ms, ms(again[best]))  # the last bench may meet a slower machine, with all of its rows alike
    least = min(error(every[s]) for s in every if (ms(again[s]) <= allowed if s in again else ms(every[s]) <= most_ms))
    figures = ((f"RMSE {most_error}", quick, time, f"{time:.2f} ({low:.2f} to {high:.2f})", error(every[quickest]) / most_error),
               (f"{most_ms} ms", good, error(every[best]) / least, f"{error(every[best]) / least:.2f}", ms(again[best]) / most_ms))
    for limit, answer, value, text, used in figures:
        share = answer["seconds"] / grid["seconds"]
        yield ((scene, limit, len(every), f"{answer['settings_tried']} / {answer['settings_measured']}",
                f"{grid['seconds']:.0f} s", f"{answer['seconds']:.1f} s ({share:.0%})".replace("%", " %"), text, f"{used:.2f}"),
               value, share)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", help=f"of {', '.join(SCENES)}; default: all")
    parser.add_argument("--limn", default="build/bin/limn", help="the program")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for results")
    options = parser.parse_args()
    for scene in options.scenes:
        if scene not in SCENES:
            parser.error(f"'{scene}' is none of {', '.join(SCENES)}")
    print("| scene | limit | settings | tried / measured | processor time, grid | search | answer over the grid's best | "
          "of the limit |\n| --- | --- | --: | --: | --: | --: | --: | --: |", flush=True)
    ratios, shares = [], []
    for scene in options.scenes or SCENES:
        for cells, value, share in judged(options.limn, scene, options.out / scene):
            print(f"| {' | '.join(map(str, cells))} |", flush=True)
            ratios.append(value)
            shares.append(share)
    print(f"\n{sum(value <= 1.1 for value in ratios)} of {len(ratios)} answers are within 10 % of the grid's best (most: "
          f"{max(ratios):.2f}), at {min(shares):.0%} to {max(shares):.0%} of its cost.".replace("%", " %").replace("  %", " %"))


if __name__ == "__main__":
    sys.exit(main())
