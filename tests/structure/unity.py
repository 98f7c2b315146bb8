"""The sources of a folder compile each alone and all together, of which a build does one: unity.py BUILD TARGET...

Alone, each includes what it needs. Together, as a unity build has them, no two give the same name to different things, not even
in their unnamed namespaces: such twins are either the same thing, which belongs in one place, or things that deserve names of
their own. Compiles nothing to the end.
"""
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

build, targets = pathlib.Path(sys.argv[1]), sys.argv[2:]


def sources_of(target, commands):
    """The commands of a target's sources, those that the build has made of several among them."""
    own = [c for c in commands if f"CMakeFiles/{target}.dir/" in c["command"].split(" -c ")[0].split(" -o ")[-1]]
    return [c for c in own if "/Unity/" in c["file"] or not pathlib.Path(c["file"]).is_relative_to(build)]


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


def errors(command, *arguments):
    """What the compiler says of a source with the flags of a command."""
    run = subprocess.run([*flags(command), "-fsyntax-only", *arguments], cwd=command["directory"], capture_output=True, text=True)
    return [line for line in run.stderr.splitlines() if re.search(r"\berror:", line)] if run.returncode else []


def together(group):
    """Errors of sources that are one."""
    with tempfile.NamedTemporaryFile("w", suffix=".cpp") as unit:
        unit.write("".join(f'#include "{command["file"]}"\n' for command in group))
        unit.flush()
        gcc = "g++" in flags(group[0])[0] or "/c++" in flags(group[0])[0]
        return errors(group[0], *(["-Wno-subobject-linkage"] if gcc else []), unit.name)


def alone(source):
    """Errors of a source that the build includes in another one."""
    command, file = source
    return errors(command, file)


commands = json.loads((build / "compile_commands.json").read_text())
sources, groups = [], []
for name in targets:
    files = sources_of(name, commands)
    if not files:
        sys.exit(f"{name}: no sources in compile_commands.json")
    folders = {}
    for command in files:
        if "/Unity/" in command["file"]:
            united = re.findall(r'^#include "(.+)"', pathlib.Path(command["file"]).read_text(), re.MULTILINE)
            sources += [(command, file) for file in united]
        else:
            folders.setdefault(pathlib.Path(command["file"]).parent, []).append(command)
    groups += [group for group in folders.values() if len(group) > 1]
# The longest first, or the last of them has one processor to itself at the end.
groups.sort(key=lambda group: -sum(pathlib.Path(command["file"]).stat().st_size for command in group))
with ThreadPoolExecutor(os.cpu_count()) as pool:
    found = [line for lines in [*pool.map(alone, sources), *pool.map(together, groups)] for line in lines]
print("\n".join(found) or f"{len(sources)} sources compile alone, {len(groups)} folders of sources together")
sys.exit(bool(found) or not (sources or groups))
