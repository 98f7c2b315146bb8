"""Passes that limn writes for other engines do there what they do in limn: their shaders compile by themselves, and a compute pass
run by scripts/replay-pass leaves the same bytes. Usage: replay.py LIMN SOURCE. Exit status 77 without PyOpenGL."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

# Storage blocks, uniform blocks, arrays of textures, mip levels, image reads; hidden and lit pixels in each.
PASSES = [("robot", "pcss", "pcss/visibility"),
          ("robot", "vssm", "shadow/summed-area table rows"),
          ("robot", "vssm", "shadow/summed-area table columns"),  # a slot
          ("robot", "vssm", "shadow/min-max windows level 1"),     # two levels of one texture
          ("robot", "vssm", "vssm/visibility"),
          ("cornell_box", "clustered_visibility", "clustered_visibility/shade"),
          ("cornell_box", "clustered_visibility", "clustered_visibility/blur"),
          ("balls_sky", "prefiltered_environment", "prefiltered_environment/environment light"),
          ("glass_sphere", "airlight", "airlight/airlight")]
SIZE = "64x48"


def told_something_else(folder):
    """Has the pass of pcss take other samples than it took in limn."""
    passes = json.loads((folder / "passes.json").read_text())
    uniforms = next(p for p in passes["passes"] if p["technique"] == "pcss")["programs"][0]["uniforms"]
    next(u for u in uniforms if u["name"] == "filter_samples")["value"] = "2"
    (folder / "passes.json").write_text(json.dumps(passes))


def main(limn, source):
    if subprocess.run(["/usr/bin/python3", "-c", "import OpenGL"], capture_output=True).returncode != 0:
        print("PyOpenGL is missing (Debian package python3-opengl)")
        return 77
    replay = pathlib.Path(source) / "scripts/replay-pass"
    glslang = shutil.which("glslangValidator")
    compiled = set()  # stages and texts: frames have shaders in common
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "passes"
        for scene, technique, title in PASSES:
            subprocess.run([limn, "passes", scene, "--technique", technique, "--size", SIZE, "--contents", title,
                            "--out", folder, "-q"], check=True)
            subprocess.run([replay, folder, title], check=True)
            for shader in (folder / "shaders").iterdir() if glslang else ():
                stage, text = shader.name.split(".")[-2], shader.read_bytes()
                if (stage, text) not in compiled:
                    subprocess.run([glslang, "-S", stage, shader], check=True, stdout=subprocess.DEVNULL)
                    compiled.add((stage, text))
            print(scene, title, "is the same")
            # A pass that is told something else leaves something else: the comparison can fail.
            if title == "pcss/visibility":
                told_something_else(folder)
                if subprocess.run([replay, folder, title]).returncode != 1:
                    print("other samples left the same")
                    return 1
    return 0


sys.exit(main(*sys.argv[1:]))
