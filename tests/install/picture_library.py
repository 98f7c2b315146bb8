"""Pictures need a library that is loaded with the first of them. Without it, or with another limn's, all else works, and what
needs pictures says so in one line before it renders."""
import shutil

from common import PREFIX, check, fresh, installed_copy, limn, options, run, techniques

scratch = fresh("picture_library")
prefix = installed_copy(scratch)
library = prefix / options.libdir / "limn/limn-image-files.so"
scene = PREFIX / "share/limn/assets/cornell_box/cornell_box.glb"
picture = scratch / "picture.png"
suite = scratch / "suite.toml"
suite.write_text(f'''name = "pictures"
sizes = "8x8"
frames = 1
term = "direct"
pictures = true
reference = {{spp = 1}}
[[scenes]]
scene = "{scene}"
[[techniques]]
technique = "hard_shadow_map"
''')

limn("render", scene, "--size", "8x8", "--out", picture, prefix=prefix)
picture.unlink()
library.unlink()
for damage in (lambda: None, lambda: library.write_text("not a library\n"),
               lambda: shutil.copy(prefix / options.libdir / "limn/techniques/pcf.so", library)):
    damage()
    check(techniques(prefix), "no technique is listed")
    limn("info", scene, prefix=prefix)
    # Progress and results would be further lines.
    for command in (("limn", "render", scene, "--size", "8x8", "--frames", "1", "--out", picture),
                    ("limn", "reference", scene, "--size", "8x8", "--spp", "1", "--out", picture),
                    ("limn", "brdf", "info", "metal:0.1", "--picture", picture),
                    ("limn", "bench", suite, "--out", scratch / "bench"),
                    ("limn-view", scene, "--frames", "1", "--screenshot", picture)):
        printed, message = run(prefix / "bin" / command[0], *command[1:], status=1)
        check("limn-image-files.so" in message and len(message.splitlines()) == 1 and not printed,
              f"{command}: not one line about the library alone: {printed}{message}")
    check(not list(scratch.glob("picture*.png")), "half a picture was written")
    check(not (scratch / "bench/results.jsonl").exists(), "a row was measured")
if shutil.which("ffmpeg"):
    limn("render", scene, "--size", "8x8", "--frames", "2", "--out", scratch / "movie.gif", prefix=prefix)
