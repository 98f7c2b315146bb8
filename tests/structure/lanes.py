"""Members of structs and blocks that GLSL reads hold one thing each, whose name they have: lanes.py SOURCE.

No comment of a member says what its lanes are ("x: type, y: flags"), and nothing reads the fourth lane of a vector that a
block, or a struct in a buffer, holds: it would be another thing than the first three. Colours have alpha (.a); texels and
the vectors of functions may have lanes. Flags are asked for by their constants, not by the numbers that these have.
"""
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
FOLDERS = ("glsl", "core", "techniques", "apps", "benchmarks", "tests", "scripts")
BLOCK = re.compile(r"^\s*struct \w+ \{.*?^\};"                                       # a struct
                   r"|^LIMN_UNIFORM_BLOCK\(.*?^LIMN_END_UNIFORM_BLOCK"                # a block that C++ shares
                   r"|^\s*layout\([^\n]*\b(?:buffer|uniform) \w+ \{[^}]*\}[^\n]*",    # a block of a shader
                   re.MULTILINE | re.DOTALL)
LANES = re.compile(r"//[/<]*\s*(?:[^;,.(\n]*[;,.(]\s+)*[xyzw]{1,4}(?:, [xyzw])*: ")
HELD = re.compile(r"\b(?:buffer|uniform) \w+ \{\s*(?:const )?(\w+) \w+(?:\[\w*\])?;")  # structs that memory holds
VECTOR = re.compile(r"^[^/\n]*?\b[iu]?vec4 (\w+);", re.MULTILINE)
PACKED = re.compile(r"\.(info)\.[xyzw]\b")
FLAG = re.compile(r"\bflags\s*&\s*\d\w*")


def files(*suffixes):
    return [path for folder in FOLDERS for path in sorted((source / folder).rglob("*")) if path.suffix in suffixes]


def line_of(text, position):
    return text.count("\n", 0, position) + 1


problems = []
texts = {path.relative_to(source): path.read_text(encoding="utf-8") for path in files(".glsl", ".cpp", ".h")}
shaders = {name: text for name, text in texts.items() if name.suffix == ".glsl"}
held = {struct for name, text in shaders.items() if name.parts[0] != "tests" for struct in HELD.findall(text)}
vectors = set()
for name, text in shaders.items():
    for block in BLOCK.finditer(text):
        struct = re.match(r"\s*struct (\w+)", block[0])
        if struct[1] in held if struct else name.parts[0] != "tests":
            vectors.update(VECTOR.findall(block[0]))
        for lanes in LANES.finditer(block[0]):
            problems.append(f"{name}:{line_of(text, block.start() + lanes.start())}: a member's lanes need names: {lanes[0]}")
fourth = re.compile(r"(?:\.|->)(" + "|".join(sorted(vectors)) + r")\.w\b")
for name, text in texts.items():
    for pattern in (fourth, PACKED):
        for read in pattern.finditer(text):
            problems.append(f"{name}:{line_of(text, read.start())}: reads a lane instead of a name: {read[0]}")
    for read in FLAG.finditer(text):
        problems.append(f"{name}:{line_of(text, read.start())}: a flag by its number instead of its constant: {read[0]}")
print("\n".join(problems))
sys.exit(1 if problems or not vectors else 0)
