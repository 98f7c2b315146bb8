"""Installs limn once for the tests beside this one. The prefix is moved: nothing in it may name where it was.

Nothing else in the scratch folder is touched: tests that need no prefix may have begun there."""
import pathlib
import shutil

from common import PREFIX, SCRATCH, check, limn, options, run, techniques

for left in (SCRATCH / "prefix", PREFIX):
    shutil.rmtree(left, ignore_errors=True)
# A header of an earlier limn goes, or the hash would never be that of this one again.
gone = SCRATCH / "prefix/include/limn/glsl/gone.glsl"
gone.parent.mkdir(parents=True)
gone.touch()
run("cmake", "--install", options.build, "--prefix", SCRATCH / "prefix")
check(not gone.exists(), "a header that limn no longer has stays installed")
manifest = (pathlib.Path(options.build) / "install_manifest.txt").read_text().splitlines()
for file in (SCRATCH / "prefix").rglob("*"):
    check(file.is_dir() or str(file) in manifest, f"install_manifest.txt does not name {file}")
(SCRATCH / "prefix").rename(PREFIX)
check(techniques(), "the installed limn lists no technique")

# What the program says of itself is installed beside it.
for program, option in {"limn": "--tonemap", "limn-view": "--tonemap", "ch7-variance-soft-shadows": "--headless"}.items():
    completion = (PREFIX / f"share/bash-completion/completions/{program}").read_text()
    check(option in completion, f"the completion of {program} does not know {option}")
for page in ("limn", "limn-render", "limn-bench", "limn-explain-cost", "limn-view", "ch7-variance-soft-shadows"):
    manual = PREFIX / f"share/man/man1/{page}.1"
    check(manual.is_file() and "SEE ALSO" in manual.read_text(), f"there is no manual page {page}")

# Grids are read by a program that is found beside the library.
grid = SCRATCH / "cloud.vdb"
grid.write_bytes(b"no volume")
scene = PREFIX / "share/limn/assets/cornell_box/cornell_box.glb"
_, message = limn("render", scene, "--sigma-s", "0.1", "--grid", grid, "--technique", "hard_shadow_map", "--size", "8x8",
                  "--out", SCRATCH / "fog.png", status=1)
check("cloud.vdb: not an OpenVDB file that can be read (" in message, f"the grid's reader did not answer: {message}")
