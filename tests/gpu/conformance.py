"""Compiles what the techniques hand to the driver with the Khronos reference compiler, which accepts less than Mesa does, and
counts what OpenGL 4.5 promises only few of: what only Mesa accepts would fail on another driver. Usage:
conformance.py LIMN GLSLANG. Exit status 77 where the driver does not say what it compiles (Mesa does)."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

STAGES = {"VS": "vert", "GS": "geom", "FS": "frag", "CS": "comp"}
# Per stage, at least (OpenGL 4.5 core, tables 23.57 to 23.63). Vertex and geometry shaders read storage blocks, too, of which no
# number is promised there and every desktop driver offers 8 or more.
PROMISED = {"storage blocks": (r"\bbuffer\s+\w+\s*\{", 8), "samplers": (r"\buniform\s+[iu]?sampler", 16),
            "images": (r"\buniform\s+(?:\w+\s+)*[iu]?image", 8)}
CHEAP = {"instant_radiosity": ["--set", "instant_radiosity.vpls=16"]}


def scene_for(technique):
    terms = set(technique["terms"])
    if terms & {"media", "caustic", "specular"}:
        return "glass_sphere"
    return "balls_sky" if "environment" in terms else "cornell_box"


def complaints(glslang, shader):
    stage = STAGES[shader.name.split("_")[0]]
    compiled = subprocess.run([glslang, "-S", stage, shader], capture_output=True, text=True)
    if compiled.returncode != 0:
        return [compiled.stdout]
    text = subprocess.check_output([glslang, "-E", "-S", stage, shader], text=True)
    counts = {what: len(re.findall(pattern, text)) for what, (pattern, _) in PROMISED.items()}
    return [f"{counts[what]} {what}, of which {most} are promised" for what, (_, most) in PROMISED.items() if counts[what] > most]


def main(limn, glslang):
    techniques = json.loads(subprocess.check_output([limn, "list", "--json"]))["techniques"]
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, MESA_SHADER_DUMP_PATH=folder)
        for technique in techniques:
            name = technique["name"]
            subprocess.run([limn, "render", scene_for(technique), "--technique", name, *CHEAP.get(name, []), "--size", "32x24",
                            "--out", os.path.join(folder, "picture.png")], env=environment, check=True)
        shaders = sorted(pathlib.Path(folder).glob("*.glsl"))
        if not shaders:
            print("the driver does not write the shaders it is given")
            return 77
        failed = 0
        for shader in shaders:
            found = complaints(glslang, shader)
            if found:
                failed += 1
                print(*found, shader.read_text()[:400], sep="\n")
        print(f"{len(shaders)} shaders of {len(techniques)} techniques, {failed} refused")
        return 1 if failed else 0


sys.exit(main(*sys.argv[1:]))
