"""What the tests of an installed limn share: its place, and a way to run programs."""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

_parser = argparse.ArgumentParser()
for option in ("source", "build", "libdir", "compiler", "generator"):
    _parser.add_argument("--" + option, required=True)
options = _parser.parse_args()

SOURCE = pathlib.Path(options.source)
SCRATCH = pathlib.Path(options.build) / "install_test"
PREFIX = SCRATCH / "moved"  # written by the test install.prefix


def fail(message):
    sys.exit("FAILED: " + message)


def check(condition, message):
    if not condition:
        fail(message)


def run(*command, status=0, cwd=None, **environment):
    """Runs a program, expects its exit status, and gives what it printed (stdout, stderr)."""
    command = [str(part) for part in command]
    done = subprocess.run(command, capture_output=True, text=True, cwd=cwd, env={**os.environ, **environment})
    if done.returncode != status:
        fail(f"{' '.join(command)}: exit status {done.returncode}, expected {status}\n{done.stdout}{done.stderr}")
    return done.stdout, done.stderr


def installed_copy(scratch):
    """The programs and libraries of the installed limn in a folder of their own, for a test that takes some of them away."""
    prefix = scratch / "prefix"
    for folder in ("bin", options.libdir):
        shutil.copytree(PREFIX / folder, prefix / folder, symlinks=True)
    return prefix


def limn(*arguments, prefix=PREFIX, **settings):
    return run(prefix / "bin/limn", *arguments, **settings)


def techniques(prefix=PREFIX, **environment):
    """Names in `limn list`; nothing may have been refused."""
    listed = json.loads(limn("list", "--json", prefix=prefix, **environment)[0])
    check(not listed["refused"], f"refused: {listed['refused']}")
    return [technique["name"] for technique in listed["techniques"]]


def cached(name):
    """The value of a variable in the build's cache; "" where it was not found."""
    found = re.search(rf"^{name}:\w+=(.*)$", (pathlib.Path(options.build) / "CMakeCache.txt").read_text(), re.MULTILINE)
    return "" if found is None or found[1].endswith("-NOTFOUND") else found[1]


def fresh(name):
    """An empty folder of that name for one test."""
    folder = SCRATCH / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def build(source, folder, prefix=PREFIX):
    """Configures and builds a project against an installed limn."""
    run("cmake", "-S", source, "-B", folder, "-G", options.generator, f"-DCMAKE_CXX_COMPILER={options.compiler}",
        f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", folder)
