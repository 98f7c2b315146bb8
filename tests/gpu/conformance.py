"""Compiles what the techniques hand to the driver, in every permutation, with the Khronos reference compiler, which accepts less
than Mesa does, and counts what OpenGL 4.5 promises only few of: what only Mesa accepts would fail on another driver. Usage:
conformance.py GLSLANG FOLDER, where FOLDER holds what the driver was given when PermutationTest compiled all programs. Exit
status 77 where the driver does not write that down (Mesa does, into MESA_SHADER_DUMP_PATH)."""
import collections
import pathlib
import re
import subprocess
import sys

STAGES = {"VS": "vert", "GS": "geom", "FS": "frag", "CS": "comp"}
# Per stage, at least (OpenGL 4.5 core, tables 23.57 to 23.63). Vertex and geometry shaders read storage blocks, too, of which no
# number is promised there and every desktop driver offers 8 or more.
PROMISED = {"storage blocks": (r"\bbuffer\s+\w+\s*\{", 8), "samplers": (r"\buniform\s+[iu]?sampler", 16),
            "images": (r"\buniform\s+(?:\w+\s+)*[iu]?image", 8)}
# Of an extension that the compiler supports without defining its macro, as the language asks.
LAYER = "GL_ARB_shader_viewport_layer_array"
BATCH = 32  # files for one process, which takes longer to start than to compile a shader


def assume_layer(shaders):
    """Has shaders take the way of drivers that have the extension: names of its kind cannot be defined from outside."""
    for shader in shaders:
        text = shader.read_text()
        if f"#ifdef {LAYER}" in text:
            shader.write_text(text.replace(f"#ifdef {LAYER}", "#if 1"))


def batches(shaders):
    """Files of one stage, in lists of at most BATCH."""
    stages = collections.defaultdict(list)
    for shader in shaders:
        stages[STAGES[shader.name.split("_")[0]]].append(shader)
    for stage, files in stages.items():
        for first in range(0, len(files), BATCH):
            yield stage, files[first:first + BATCH]


def preprocessed(glslang, shaders):
    """The shaders' text without comments, inactive parts and line numbers, each but once."""
    texts = {}
    for stage, files in batches(shaders):
        output = subprocess.check_output([glslang, "-E", "-S", stage, *files], text=True)
        parts = ["#version" + part for part in output.split("#version")[1:]]
        if len(parts) != len(files):
            raise RuntimeError(f"{len(files)} shaders became {len(parts)}")
        for shader, part in zip(files, parts):
            texts.setdefault((stage, re.sub(r"(?m)^#line.*\n|^\s*\n", "", part)), shader)
    return {shader: text for (_, text), shader in texts.items()}


def refused(glslang, shaders):
    """What the compiler says about each shader that it refuses."""
    for stage, files in batches(shaders):
        if subprocess.run([glslang, "-S", stage, *files], capture_output=True, text=True).returncode == 0:
            continue
        for shader in files:
            compiled = subprocess.run([glslang, "-S", stage, shader], capture_output=True, text=True)
            if compiled.returncode != 0:
                yield shader, compiled.stdout


def beyond(texts):
    """What each shader has more of than every driver promises."""
    for shader, text in texts.items():
        for what, (pattern, most) in PROMISED.items():
            count = len(re.findall(pattern, text))
            if count > most:
                yield shader, f"{count} {what}, of which {most} are promised"


def uncached(shaders):
    """Shaders that Mesa preprocesses before it looks them up in its cache: those that spell the directive, even in a comment."""
    for shader in shaders:
        if "#include" in shader.read_text():
            yield shader, "it has '#include', be it in a comment"


def main(glslang, folder):
    written = sorted(pathlib.Path(folder).glob("*.glsl"))
    if not written:
        print("the driver does not write the shaders it is given")
        return 77
    assume_layer(written)
    texts = preprocessed(glslang, written)
    failed = [*refused(glslang, texts), *beyond(texts), *uncached(written)]
    for shader, why in failed:
        print(why, shader.read_text()[:400], sep="\n")
    print(f"{len(written)} shaders, {len(texts)} of which differ, {len(failed)} refused")
    return 1 if failed else 0


sys.exit(main(*sys.argv[1:]))
