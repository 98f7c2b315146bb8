"""The sources of a folder compile together, as a unity build has them: unity.py BUILD TARGET...

No two of them give the same name to different things, not even in their unnamed namespaces: such twins are either the
same thing, which belongs in one place, or things that deserve names of their own. Compiles nothing to the end.
"""
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

build, targets = pathlib.Path(sys.argv[1]), sys.argv[2:]


def sources_of(target, commands):
    """The commands of a target's own sources."""
    own = [c for c in commands if f"CMakeFiles/{target}.dir/" in c["command"].split(" -c ")[0].split(" -o ")[-1]]
    return [c for c in own if not pathlib.Path(c["file"]).is_relative_to(build)]


def flags(command):
    """What of a command says how to compile, not what, nor where to."""
    words = [word for word in shlex.split(command["command"]) if not word.endswith("ccache") and word != command["file"]]
    kept, drop = [], False
    for word in words:
        if not drop and word not in ("-c", "-MD"):
            if word not in ("-o", "-MT", "-MF"):
                kept.append(word)
        drop = word in ("-o", "-MT", "-MF") and not drop
    return kept


def problems(group):
    """What the compiler says of sources that are one."""
    with tempfile.NamedTemporaryFile("w", suffix=".cpp") as unit:
        unit.write("".join(f'#include "{command["file"]}"\n' for command in group))
        unit.flush()
        quiet = ["-Wno-subobject-linkage"] if "g++" in flags(group[0])[0] or "/c++" in flags(group[0])[0] else []
        run = subprocess.run([*flags(group[0]), *quiet, "-fsyntax-only", unit.name], cwd=group[0]["directory"],
                             capture_output=True, text=True)
        return [line for line in run.stderr.splitlines() if re.search(r"\berror:", line)] if run.returncode else []


commands = json.loads((build / "compile_commands.json").read_text())
if any("/Unity/unity_" in command["file"] for command in commands):
    print("this is a unity build, which says so itself")
    sys.exit(77)
groups = []
for name in targets:
    files = sources_of(name, commands)
    if not files:
        sys.exit(f"{name}: no sources in compile_commands.json")
    folders = {}
    for file in files:
        folders.setdefault(pathlib.Path(file["file"]).parent, []).append(file)
    groups += folders.values()
with ThreadPoolExecutor(2) as pool:
    found = [line for lines in pool.map(problems, groups) for line in lines]
print("\n".join(found) or f"{len(groups)} folders of sources compile")
sys.exit(bool(found))
