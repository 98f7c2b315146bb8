"""Pictures need a library that is loaded with the first of them. Without it, or with another limn's, all else works, and what
needs pictures says so in one line."""
import shutil

from common import PREFIX, check, fresh, installed_copy, limn, options, techniques

scratch = fresh("picture_library")
prefix = installed_copy(scratch)
library = prefix / options.libdir / "limn/limn-image-files.so"
scene = PREFIX / "share/limn/assets/cornell_box/cornell_box.glb"
picture = scratch / "picture.png"

limn("render", scene, "--size", "8x8", "--out", picture, prefix=prefix)
picture.unlink()
library.unlink()
for damage in (lambda: None, lambda: library.write_text("not a library\n"),
               lambda: shutil.copy(prefix / options.libdir / "limn/techniques/pcf.so", library)):
    damage()
    check(techniques(prefix), "no technique is listed")
    _, message = limn("render", scene, "--size", "8x8", "--out", picture, prefix=prefix, status=1)
    check("limn-image-files.so" in message and len(message.splitlines()) == 1, f"not one line about the library: {message}")
    check(not picture.exists(), "half a picture was written")
