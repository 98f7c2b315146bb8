"""One addition of each kind that CONTRIBUTING.md describes, made in a scratch copy: it is then all that the document promises.
A technique and its parameter: new_technique.py. A service: FrameService in tests/unit/technique. A chart: worked_chart.py."""
import concurrent.futures
import json
import os
import pathlib
import re
import shlex

from common import SOURCE, cached, check, fresh, options, run
from scratch_copy import Addition, copy_sources

BUILD = pathlib.Path(options.build)
HERE = pathlib.Path(__file__).parent / "worked_examples"
scratch = fresh("worked_examples")
tree, objects = scratch / "limn", scratch / "objects"

# What shows an addition: the folders that read its table, and the tests of these tables as limn has them.
LINKED = ["core/base/*.cpp", "core/question/*.cpp", "core/image/*.cpp", "core/brdf/*_file.cpp", "core/brdf/measured_model.cpp",
          "core/brdf/tabulated.cpp", "core/brdf/visible_normals.cpp", "core/relief/height_field.cpp", "core/relief/slopes.cpp",
          "core/scene/*.cpp", "core/scene_io/*.cpp",
          *(f"core/bench/{name}.cpp" for name in (
              "columns", "comparison", "markdown", "provenance", "question_json", "question_toml", "ratio", "report",
              "report_pictures", "row", "suite", "suite_toml", "tables", "toml_nesting", "toml_section")),
          *(f"core/session/{name}.cpp" for name in ("find", "light_edits", "mesh_light", "view")),
          "core/shading/environment.cpp", "core/shading/environment_decomposition.cpp", "core/reference/content_hash.cpp",
          "core/reference/render.cpp", "core/reference/term.cpp", "core/render/settings.cpp", "core/render/frame_stats.cpp",
          "apps/limn/scene_flags.cpp", "tests/unit/question/*.cpp", "tests/unit/image/metric_table_test.cpp",
          "tests/unit/bench/bench_columns_test.cpp", "tests/unit/session/view_test.cpp"]
TARGETS = ["limn", "limn_reference", "limn_bench", "limn_session", "limn_commands", "limn_unit_tests"]  # they are of
COMPILED = ["core/gpu_scene/gpu_materials.cpp", "core/reference/surface.cpp"]  # which draw and trace: not linked
PRECOMPILED = ["fmt/format.h", "glm/glm.hpp", "gmock/gmock.h", "gtest/gtest.h", "nlohmann/json.hpp"]
LIBRARIES = ["gtest_main", "gtest", "gmock", "fmt", "spdlog", "tinygltf", "meshoptimizer", "tbb", "xxhash", "kissfft-float", "webp", "tomlplusplus", "dl"]


def add_scene_option():
    option = Addition(tree, "An option of a scene")
    row = option.block({"environment": "lamp"})
    option.after("core/question/scene_question.h", "double environmentRotation = 0, environmentScale = 1;\n",
                 "  double lampScale = 1;\n")
    option.before("core/question/question_fields.cpp", '    coefficient("sigma_a"', row)
    option.after("core/session/view.cpp", "scene.lights = view.file.lights;\n",
                 "  for (scene::LightSource& light : scene.lights) light.intensity *= static_cast<float>(question.lampScale);\n")
    option.before("docs/bench.md", "| `sigma_a`, `sigma_s` |", "| `lamp_scale` | 0 to 1e9 | 1 | As `--lamp-scale`. |\n")
    option.after("docs/bench.md", "`environment_rotation`, `environment_scale`, ", "`lamp_scale`, ")


def add_metric():
    metric = Addition(tree, "A metric")
    help_text = "largest absolute error of R, G and B"
    metric.before("core/image/metrics.h", "  std::size_t pixels = 0;", "  std::optional<double> worst;\n")
    metric.before("core/image/metrics.cpp", "    std::vector<float> errors, peaks;\n",
                  "    metrics.worst = 0;\n"
                  "    for (std::size_t i = 0; i < image_.size(); ++i)\n"
                  "      if (mask_[i / 3])\n"
                  "        metrics.worst = std::max(*metrics.worst, std::abs(static_cast<double>(image_[i]) - reference_[i]));\n")
    metric.before("core/image/metric_table.h", '    {"noise_floor",',
                  '    {"worst", "worst error", "worst", "", "{:.4g}", MetricKind::error, false, false, &Metrics::worst,\n'
                  f'     "{help_text}"}},\n')
    metric.before("docs/bench.md", "| `noise_floor` | noise floor |", f"| `worst` | worst error | {help_text} |\n")
    metric.before("docs/bench.md", "| `noise_floor` | | ", f"| `worst` | worst | {help_text} |\n")
    metric.replace("tests/unit/image/metric_table_test.cpp", '"masked_share":9.0,"pixels":10,"noise_floor":8.0',
                   '"masked_share":10.0,"pixels":11,"worst":8.0,"noise_floor":9.0')


def add_term():
    term = Addition(tree, "A term")
    phrase = "light that crystals of snow throw back"
    row = term.block({"caustic": "glint", "light that comes off mirrors and through glass": phrase, "nullptr": '"glints"', "4}": "9}"})
    term.replace("core/question/term.h", "  subsurface = 1024\n", "  subsurface = 1024,\n  glint = 2048\n")
    term.before("core/question/term.h", "};\n// clang-format on\n", row)
    rows = re.findall(r"^\| `surface` \|.*\n", (tree / "docs/architecture.md").read_text(), re.MULTILINE)
    check(len(rows) == 1, f"docs/architecture.md has {len(rows)} rows for the term `surface`, expected 1")
    term.after("docs/architecture.md", rows[0], f"| `glint` | {phrase} | L S+ D E | 0 |\n")
    term.after("docs/bench.md", "| `term` | `final`, `visibility`, `relief`, `direct`, `indirect`, `subsurface`, `caustic`, `media`, `specular`", ", `glint`")


def add_material_field():
    field = Addition(tree, "A field of a material")
    extension, loader = "KHR_materials_clearcoat", "core/scene_io/loader_material.cpp"
    field.after("core/scene/scene.h", "  float transmission = 0;\n", "  float clearcoat = 0;\n")
    field.before("core/scene_io/document_rules.cpp", '      number("materials[].extensions.KHR_materials_ior.ior"),\n',
                 f'      number("materials[].extensions.{extension}.clearcoatFactor"),\n')
    field.before("core/scene_io/loader_document.cpp", '    "KHR_materials_ior",\n', f'    "{extension}",\n')
    field.before(loader, '  if (const auto* e = extension(map, "KHR_materials_ior")) {\n',
                 f'  if (const auto* e = extension(map, "{extension}"))\n'
                 '    m.clearcoat = ranged(get(*e, "clearcoatFactor", 0), 0, 1, what + " clearcoatFactor");\n')
    field.replace("glsl/scene/blocks.glsl", "  uint unused_0;\n", "  float clearcoat;\n")
    field.after("core/gpu_scene/gpu_materials.cpp", "  out.transmission = m.transmission;\n", "  out.clearcoat = m.clearcoat;\n")
    field.before("core/reference/surface.cpp", "  values.metallic = ", "  values.base_colour *= 1.f - 0.04f * material.clearcoat;\n")
    field.before("core/reference/content_hash.cpp", "  for (const auto* texture :\n", "  if (m.clearcoat > 0) h.add(m.clearcoat);\n")


def flags():
    """What the build compiles these targets with, less optimisation and precompiled headers, and with the copy's folders."""
    chosen = []
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        words = shlex.split(entry["command"])
        if not any(f"CMakeFiles/{target}.dir/" in words[words.index("-o") + 1] for target in TARGETS):
            continue
        words = iter(words[1:])
        for word in words:
            pair = [word, next(words)] if word in ("-include", "-isystem", "-o", "-c") else [word]
            wanted = word == "-isystem" or re.match(r"-(D(?!.*_EXPORTS$)|I|W(?!invalid-pch)|f(?!PIE|pch)|std=)", word)
            if wanted and pair not in chosen:
                chosen.append(pair)
    moved = {f"-I{SOURCE}": f"-I{tree}"}
    # It takes sources that are compiled as one for headers.
    united = ["-Wno-subobject-linkage"] if re.search(r"(^|[/-])[cg]\+\+", options.compiler) else []
    return [*(moved.get(word, word) for pair in chosen for word in pair), *united, "-O0", "-fPIC", "-ffunction-sections",
            "-fdata-sections"]


def unite(sources):
    """The sources of each folder as one, which they may be (the test structure.unity), the longest first."""
    folders = {}
    for source in sources:
        folders.setdefault(source.parent, []).append(source)
    united = []
    for folder, files in sorted(folders.items(), key=lambda item: -len(item[1])):
        united.append(scratch / ("_".join(folder.relative_to(tree).parts) + ".cpp"))
        united[-1].write_text("".join(f'#include "{file}"\n' for file in files))
    return united


def compile_all(sources, words):
    """Compiles the sources, several at once, and gives their objects."""
    prelude = scratch / "precompiled.h"
    prelude.write_text("".join(f"#include <{header}>\n" for header in PRECOMPILED))
    run(options.compiler, *words, "-x", "c++-header", prelude, "-o", f"{prelude}.gch")

    def compile_one(source):
        target = objects / (source.stem + ".o")
        run(options.compiler, *words, "-include", prelude, "-c", source, "-o", target)
        return target

    objects.mkdir()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(compile_one, sources))


def build_check():
    """Compiles what shows the additions, and links the program."""
    paths = scratch / "paths.cpp"
    paths.write_text((tree / "tests/support/paths.cpp.in").read_text()
                     .replace("@PROJECT_SOURCE_DIR@", str(tree)).replace("@CMAKE_BINARY_DIR@", str(BUILD)))
    linked = [file for pattern in LINKED for file in sorted(tree.glob(pattern))]
    compiled = compile_all([*unite(linked), HERE / "check.cpp", paths, BUILD / "core/version.cpp",
                            *(tree / source for source in COMPILED)], flags())
    program = scratch / "bin/check"  # which finds scenes and suites as limn does: beside the folder it is in
    program.parent.mkdir()
    for folder in ("assets", "benchmarks"):
        (scratch / folder).symlink_to(BUILD / folder)
    (program.parent / "limn").symlink_to(BUILD / "lib/limn")  # what liblimn looks for beside itself
    run(options.compiler, "-Wl,--gc-sections", *compiled[:-len(COMPILED)], *(f"-l{library}" for library in LIBRARIES),
        "-o", program)
    print(f"{len(linked)} sources compiled and linked")
    return program


def check_shaders():
    """The material's field as GLSL has it, by the reference compiler where it is installed; and what structure tests say."""
    for name in ("lanes", "bindings"):
        run("python3", "-B", SOURCE / f"tests/structure/{name}.py", tree)
    compiler = cached("LIMN_GLSLANG")
    if not compiler:
        print("not checked: the material's field in GLSL (Debian package glslang-tools)")
        return
    shader = scratch / "field.comp"
    shader.write_text("""#version 450
#extension GL_GOOGLE_include_directive : require
#include "glsl/scene/blocks.glsl"
layout(local_size_x = 1) in;
layout(std430) buffer Materials { Material materials[]; };
layout(std430) buffer Coats { float coats[]; };
void main() { coats[gl_GlobalInvocationID.x] = materials[gl_GlobalInvocationID.x].clearcoat; }
""")
    run(compiler, "-l", f"-I{tree}", "-S", "comp", shader)


copy_sources(tree, "core", "glsl", "apps", "techniques", "docs/architecture.md", "docs/bench.md", "tests/unit", "tests/support")
for add in (add_scene_option, add_metric, add_term, add_material_field):
    add()
check_shaders()
print(run(build_check(), "--gtest_brief=1", cwd=scratch)[0])
