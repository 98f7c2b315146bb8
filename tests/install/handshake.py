"""A technique compiled from other headers, other shared GLSL or with another layout of types is refused: whatever of an
installed limn changes, the hash that both sides compare covers it."""
import re
import shutil

from common import PREFIX, SOURCE, check, fresh, limn, options, run, techniques

NAME = "example_technique"
scratch = fresh("handshake")
prefix = scratch / "prefix"
include = prefix / "include/limn"
built = scratch / "build/lib/limn/techniques"
liblimn = PREFIX / options.libdir / "liblimn.so"


def build(flags=""):
    """Builds the example against the changed prefix; the limn that loads it is the unchanged one."""
    run("cmake", "-S", SOURCE / "tests/install" / NAME, "-B", scratch / "build", "-G", options.generator,
        f"-DCMAKE_CXX_COMPILER={options.compiler}", f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_FLAGS={flags}")
    run("cmake", "--build", scratch / "build")


def change(name, old, new):
    file = include / name
    text = file.read_text()
    check(old in text, f"{file} has no '{old}'")
    file.write_text(text.replace(old, new, 1))


def refused(difference):
    """The line with which limn refuses the module names both sides, what differs and what to do."""
    _, message = limn("render", "cornell_box", "--technique", NAME, "--size", "8x8", "--out", scratch / "x.png",
                      LIMN_TECHNIQUE_PATH=str(built), status=1)
    expected = (f"limn: technique {NAME} was refused: {re.escape(str(built / NAME))}.so: {difference} "
                rf"\(limn: {re.escape(str(liblimn))}\); rebuild it against this limn\n")
    check(re.fullmatch(expected, message), f"expected {expected}, got {message}")


def changed_header(name, old, new):
    before = (include / name).read_text()
    change(name, old, new)
    build()
    refused("it was built from headers [0-9a-f]{32}, limn from headers [0-9a-f]{32}")
    (include / name).write_text(before)


for part in ("include", options.libdir, "bin"):
    shutil.copytree(PREFIX / part, prefix / part, symlinks=True)

# What lies beside the folder of the headers is none of them.
beside = include.parent / "core/technique/technique.h"
beside.parent.mkdir(parents=True)
beside.touch()
build()
check(NAME in techniques(LIMN_TECHNIQUE_PATH=str(built)), "refused though nothing differs")

# A field more in a structure that C++ and GLSL share, in a header that technique.h includes over others, in one that
# only some techniques include, and in one that is generated.
light = re.search(r"struct Light \{\n", (include / "glsl/scene/light.glsl").read_text())
check(light, "glsl/scene/light.glsl has no struct Light")
changed_header("glsl/scene/light.glsl", light[0], light[0] + "  vec4 more;\n")
changed_header("core/gpu/objects.h", "#pragma once\n", "#pragma once\n// changed\n")
changed_header("core/scene/environment_light.h", "#pragma once\n", "#pragma once\n// changed\n")
changed_header("core/context/gl_functions.h", "#pragma once\n", "#pragma once\n// changed\n")

# Containers with checks are larger, quaternions may lie the other way round.
build("-D_GLIBCXX_DEBUG -DGLM_FORCE_QUAT_DATA_WXYZ")
refused("_GLIBCXX_DEBUG is 1 in it and undefined in limn; GLM_FORCE_QUAT_DATA_WXYZ is 1 in it and undefined in limn")

# A header that no list knows is covered from the moment another includes it, and must be there.
change("core/technique/technique.h", "#pragma once\n", '#pragma once\n#include "core/technique/new.h"\n')
run("cmake", "--build", scratch / "build", status=1)
(include / "core/technique/new.h").write_text("#pragma once\n")
build()
refused("it was built from headers [0-9a-f]{32}, limn from headers [0-9a-f]{32}")

