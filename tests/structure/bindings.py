"""Checks that resources are bound by name: no binding number stands in GLSL or C++.

bindings.py SOURCE_DIR. Shaders give no `binding`; the commands that take a unit are called by the frame graph alone, which
asks the linked program for it (core/frame/places.cpp), and by what tests it.
"""
import pathlib
import re
import sys

GLSL = re.compile(r"layout\s*\([^)]*\bbinding\s*=")
COMMANDS = re.compile(r"\bBind(BufferBase|BufferRange|TextureUnit|ImageTexture|Sampler|Textures|Samplers|ImageTextures|"
                      r"BuffersBase|BuffersRange)\s*\(")
MAY_BIND = {"core/frame/places.cpp", "tests/gpu/bind_by_name.h", "tests/gpu/objects_test.cpp"}


def problems(root):
    for folder in ("apps", "assets", "benchmarks", "core", "docs", "glsl", "scripts", "techniques", "tests"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".cpp", ".h", ".glsl", ".md", ".in"):
                continue
            name = str(path.relative_to(root))
            for number, line in enumerate(path.read_text().splitlines(), 1):
                if GLSL.search(line):
                    yield f"{name}:{number}: a binding number: {line.strip()}"
                if COMMANDS.search(line) and name not in MAY_BIND:
                    yield f"{name}:{number}: binds by number: {line.strip()}"


def main():
    found = list(problems(pathlib.Path(sys.argv[1])))
    for problem in found:
        print(problem)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
