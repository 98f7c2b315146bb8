"""Each parameter that a technique declares is set by a test: parameters.py LIMN SOURCE.

Tests that set it stand in tests/gpu: a parameter that nothing sets there could be ignored without a test that says so.
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
declared = {(parameter["name"], technique["name"])
            for technique in listed["techniques"] for parameter in technique["parameters"]}
problems = [f"{technique}.{name}: no test sets it" for name, technique in sorted(declared) if name not in set_somewhere]
print("\n".join(problems))
sys.exit(1 if problems or not declared else 0)
