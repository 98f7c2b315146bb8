"""What an outsider writes against an installed limn: a technique, and a program that loads it."""
import shutil

from common import PREFIX, SOURCE, build, check, fresh, limn, options, run, techniques

here = SOURCE / "tests/install"
scratch = fresh("example")
prefix = scratch / "prefix"
shutil.copytree(PREFIX, prefix, symlinks=True)
built = scratch / "example_technique/lib/limn/techniques"
installed = prefix / options.libdir / "limn/techniques"
loader = scratch / "loader/load_technique"

for project in ("example_technique", "loader"):
    build(here / project, scratch / project, prefix)
run(loader, built, "example_technique")
check("example_technique" in techniques(prefix, LIMN_TECHNIQUE_PATH=str(built)), "not found through LIMN_TECHNIQUE_PATH")

# It is installed beside limn's own, whatever folder of libraries its project has, and renders: V = 0.25 wherever the light counts.
run("cmake", scratch / "example_technique", "-DCMAKE_INSTALL_LIBDIR=elsewhere")
run("cmake", "--install", scratch / "example_technique", "--prefix", prefix)
run(loader, installed, "example_technique")
picture = scratch / "v.exr"
limn("render", "cornell_box", "--technique", "example_technique", "--set", "example_technique.value=0.25",
     "--output-term", "visibility", "--light", "#0", "--size", "64x48", "--out", picture, prefix=prefix)
check(picture.stat().st_size > 0, "no picture")
