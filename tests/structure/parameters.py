"""Each parameter that a technique declares is set by a test and explained on its page: parameters.py LIMN SOURCE.

Tests that set it stand in tests/gpu: a parameter that nothing sets there could be ignored without a test that says so. The page
names it in its section "Parameters", whose tables name no other.
"""
import json
import pathlib
import re
import subprocess
import sys

limn, source = sys.argv[1], pathlib.Path(sys.argv[2])
listed = json.loads(subprocess.run([limn, "list", "--json"], check=True, capture_output=True, text=True).stdout)
tests = "\n".join(path.read_text(encoding="utf-8") for path in sorted((source / "tests/gpu").glob("*.[ch]*")))
# {"name", value}, settings["name"] and set("name", value)
set_somewhere = set(re.findall(r'[{\[(]\s*"(\w+)"\s*[,\]]', tests))
problems = []


def explained(technique):
    """The names that a page's section "Parameters" has in backticks, and those in the first columns of its tables."""
    text = (source / "techniques" / technique / "README.md").read_text(encoding="utf-8")
    section = text.partition("\n## Parameters\n")[2].partition("\n## ")[0]
    first = "\n".join(re.findall(r"^\| (`[^|]*) \|", section, re.MULTILINE))
    return set(re.findall(r"`(\w+)`", section)), set(re.findall(r"`(\w+)`", first))


declared = {technique["name"]: {parameter["name"] for parameter in technique["parameters"]}
            for technique in listed["techniques"]}
for technique, names in sorted(declared.items()):
    named, rows = explained(technique)
    problems += [f"{technique}.{name}: no test sets it" for name in sorted(names - set_somewhere)]
    problems += [f"{technique}.{name}: its page does not explain it" for name in sorted(names - named)]
    problems += [f"{technique}: its page explains {name}, which it does not declare" for name in sorted(rows - names)]
print("\n".join(problems))
sys.exit(1 if problems or not any(declared.values()) else 0)
