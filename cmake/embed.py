"""Writes a C++ file that holds text files as string literals: embed.py OUT FUNCTION ROOT FILE...

The file defines `std::span<const limn::gpu::EmbeddedSource> FUNCTION()`; names are relative to ROOT.
"""
import os
import sys

LITERAL_LIMIT = 8000  # characters in one literal; longer ones upset some compilers


def literal(text):
    pieces = [text[i:i + LITERAL_LIMIT] for i in range(0, len(text), LITERAL_LIMIT)] or [""]
    return "\n".join('R"LIMN(' + piece + ')LIMN"' for piece in pieces)


def main():
    out, function, root, files = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
    namespace, _, name = function.rpartition("::")
    lines = ['#include <span>', '#include "core/gpu/shader_source.h"', f"namespace {namespace} {{",
             "namespace {", "constexpr limn::gpu::EmbeddedSource sources[] = {"]
    for path in files:
        with open(path, encoding="utf-8") as file:
            lines.append(f'{{"{os.path.relpath(path, root)}", {literal(file.read())}}},')
    lines += ["{nullptr, nullptr}};", "}  // namespace",
              f"std::span<const limn::gpu::EmbeddedSource> {name}() "
              "{ return {sources, sizeof(sources) / sizeof(sources[0]) - 1}; }",
              f"}}  // namespace {namespace}", ""]
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


if __name__ == "__main__":
    main()
