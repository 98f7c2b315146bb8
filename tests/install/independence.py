"""No technique needs another: each is left out of a build without its like, and taken out of an installed limn in turn."""
from common import PREFIX, SOURCE, check, fresh, installed_copy, limn, options, run, techniques

scratch = fresh("independence")
prefix = installed_copy(scratch)
modules = prefix / options.libdir / "limn/techniques"
scene = PREFIX / "share/limn/assets/cornell_box/cornell_box.glb"

names = sorted({source.parent.name for source in (SOURCE / "techniques").glob("*/*.cpp")})
check(len(names) >= 2, f"too few techniques to tell: {names}")
check(sorted(techniques(prefix)) == names, f"installed are {techniques(prefix)}, the folders are {names}")

# Builds without half of them. Two numbers differ in a binary digit: of any two techniques each is there once without the other.
build = scratch / "build"  # configured again: only the techniques left out change
for digit in range((len(names) - 1).bit_length()):
    for value in (0, 1):
        kept = [name for i, name in enumerate(names) if i >> digit & 1 == value]
        left_out = ";".join(name for name in names if name not in kept)
        run("cmake", "-S", SOURCE, "-B", build, "-G", options.generator, f"-DCMAKE_CXX_COMPILER={options.compiler}",
            f"-DLIMN_EXCLUDE_TECHNIQUES={left_out}", "-DLIMN_BUILD_TESTS=ON", "-DLIMN_BUILD_BENCHMARKS=OFF")
        targets = run("cmake", "--build", build, "--target", "help")[0]
        found = [name for name in names if f"technique_{name}:" in targets]
        check(found == kept, f"without {left_out} the techniques built are {found}, expected {kept}")

for i, name in enumerate(names):
    others = names[:i] + names[i + 1:]
    module = modules / (name + ".so")
    module.rename(scratch / "aside.so")
    check(sorted(techniques(prefix)) == others, f"without {name}.so limn lists {techniques(prefix)}")
    picture = scratch / f"without_{name}.png"
    limn("render", scene, "--technique", others[0], "--size", "32x24", "--out", picture, prefix=prefix)
    check(picture.stat().st_size > 0, "no picture")
    _, message = limn("render", scene, "--technique", name, "--size", "8x8", "--out", picture, prefix=prefix, status=2)
    check(name in message and others[0] in message, f"the technique that is gone is not named: {message}")
    (scratch / "aside.so").rename(module)
