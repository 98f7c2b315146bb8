"""No technique needs another: each is left out of the build, and taken out of an installed limn, in turn."""
import shutil

from common import PREFIX, SOURCE, check, fresh, limn, options, run, techniques

scratch = fresh("independence")
prefix = scratch / "prefix"
for folder in ("bin", options.libdir):
    shutil.copytree(PREFIX / folder, prefix / folder, symlinks=True)
modules = prefix / options.libdir / "limn/techniques"
scene = PREFIX / "share/limn/assets/cornell_box/cornell_box.glb"

names = sorted({source.parent.name for source in (SOURCE / "techniques").glob("*/*.cpp")})
check(len(names) >= 2, f"too few techniques to tell: {names}")
check(sorted(techniques(prefix)) == names, f"installed are {techniques(prefix)}, the folders are {names}")
for i, name in enumerate(names):
    others = names[:i] + names[i + 1:]

    build = scratch / "build"  # configured again: only the technique left out changes
    run("cmake", "-S", SOURCE, "-B", build, "-G", options.generator, f"-DCMAKE_CXX_COMPILER={options.compiler}",
        f"-DLIMN_EXCLUDE_TECHNIQUES={name}", "-DLIMN_BUILD_TESTS=ON")
    targets = run("cmake", "--build", build, "--target", "help")[0]
    found = [other for other in names if f"technique_{other}:" in targets]
    check(found == others, f"without {name} the techniques built are {found}, expected {others}")

    module = modules / (name + ".so")
    module.rename(scratch / "aside.so")
    check(sorted(techniques(prefix)) == others, f"without {name}.so limn lists {techniques(prefix)}")
    picture = scratch / f"without_{name}.png"
    limn("render", scene, "--technique", others[0], "--size", "32x24", "--out", picture, prefix=prefix)
    check(picture.stat().st_size > 0, "no picture")
    _, message = limn("render", scene, "--technique", name, "--size", "8x8", "--out", picture, prefix=prefix, status=2)
    check(name in message and others[0] in message, f"the technique that is gone is not named: {message}")
    (scratch / "aside.so").rename(module)
