"""Where programs and modules look for libraries, built and installed: nowhere that depends on the working folder. An empty
entry of a run path names it, and so does a relative one."""
import os
import pathlib
import re

from common import PREFIX, SOURCE, build, check, fresh, options, run


def elf_files(folder):
    for path in sorted(folder.rglob("*")):
        if path.is_file() and not path.is_symlink():
            with open(path, "rb") as file:
                if file.read(4) == b"\x7fELF" and file.seek(16) and file.read(2) in (b"\2\0", b"\3\0"):  # not objects
                    yield path


def run_paths(path):
    dynamic = run("readelf", "-d", "-W", path)[0]
    return re.findall(r"\((?:RPATH|RUNPATH)\)\s+Library r(?:un)?path: \[(.*)\]", dynamic)


def examine(folder, accepted):
    """Every entry of every file's run path begins with one of `accepted`. Gives how many files were looked at."""
    files = list(elf_files(folder))
    for file in files:
        for paths in run_paths(file):
            for entry in paths.split(":"):
                check(entry.startswith(accepted), f"{file} looks for libraries in '{entry}' ({paths})")
    return len(files)


check(run("readelf", "--version")[0], "readelf is missing")
tree = pathlib.Path(options.build)
outside = fresh("search_paths") / "example_technique"
build(SOURCE / "tests/install/example_technique", outside)
for folder, least in ((tree / "bin", 2), (tree / "lib", 5), (tree / "tests", 2), (outside, 1)):
    count = examine(folder, ("$ORIGIN", "/"))
    check(count >= least, f"{count} programs and modules in {folder}, expected {least} or more")
check(examine(PREFIX, ("$ORIGIN",)) >= 5, "nothing is installed")

# A library of the working folder is not loaded in the place of the system's.
planted = outside / "planted"
planted.mkdir()
for needed in re.findall(r"\(NEEDED\)\s+Shared library: \[(.*)\]", run("readelf", "-d", tree / "lib/liblimn.so")[0]):
    (planted / needed).write_text("not a library\n")
run(tree / "bin/limn", "--version", cwd=planted)
run(os.path.join(PREFIX, "bin/limn"), "--version", cwd=planted)
