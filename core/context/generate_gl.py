"""Writes the OpenGL function table from the Khronos registry: generate_gl.py GL_XML HEADER SOURCE.

The table holds the commands of the OpenGL 4.5 core profile and nothing else, because limn runs on what the
core profile alone offers. The header declares the types, the GL_ constants (as macros behind #ifndef, so that it
can be included before or after another OpenGL header) and `limn::gl::Functions`.
"""
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

VERSION = (4, 5)
# Bounded reads that Mesa 22's OSMesa does not export under their core names; limn reads through direct state
# access.
LEFT_OUT = {"glGetnCompressedTexImage", "glGetnTexImage", "glGetnUniformdv"}
NOTICE = "// Generated from the Khronos OpenGL registry by core/context/generate_gl.py. Do not edit.\n"


def core_interface(registry):
    """Names of the types, constants and commands of the core profile of VERSION."""
    names = {"type": set(), "enum": set(), "command": set()}
    features = [f for f in registry.iter("feature") if f.get("api") == "gl"]
    features.sort(key=lambda f: tuple(map(int, f.get("number").split("."))))
    for feature in features:
        if tuple(map(int, feature.get("number").split("."))) > VERSION:
            continue
        for change in feature:
            if change.get("profile", "core") != "core":
                continue
            for item in change:
                if item.tag not in names:
                    continue
                if change.tag == "require":
                    names[item.tag].add(item.get("name"))
                else:
                    names[item.tag].discard(item.get("name"))
    return names


def type_declarations(registry, wanted):
    """C declarations of the wanted types and of those they need, in the registry's order."""
    declarations = {}
    for node in registry.find("types"):
        name = node.get("name") or node.findtext("name")
        if node.get("api") not in (None, "gl"):
            continue
        declarations[name] = (node.get("requires"), "".join(node.itertext()).strip())
    needed = set()

    def need(name):
        if name in declarations and name not in needed:
            needed.add(name)
            need(declarations[name][0])
            for word in re.findall(r"\w+", declarations[name][1]):
                need(word)

    for name in wanted:
        need(name)
    return [text for name, (_, text) in declarations.items() if name in needed and text]


def constants(registry, wanted):
    """(name, value) of the wanted constants, in the registry's order."""
    found = {}
    for group in registry.iter("enums"):
        for node in group.iter("enum"):
            if node.get("name") in wanted and node.get("api") in (None, "gl"):
                suffix = node.get("type", "")  # "ull" for 64-bit constants
                found[node.get("name")] = node.get("value") + suffix
    return found.items()


def commands(registry, wanted):
    """(name without gl, return type, [parameter declaration], [type name]) of the wanted commands, sorted."""
    found = []
    for node in registry.find("commands").iter("command"):
        prototype = node.find("proto")
        name = prototype.findtext("name")
        if name not in wanted:
            continue
        result = "".join(prototype.itertext())[:-len(name)].strip()
        parameters = [" ".join("".join(p.itertext()).split()) for p in node.findall("param")]
        types = [t.text for t in node.iter("ptype")]
        found.append((name[2:], result, parameters, types))
    return sorted(found)


def header(types, values, functions):
    lines = [NOTICE + "#pragma once", "", "#include <functional>", "#include <string>", ""]
    lines += types + [""]
    for name, value in values:
        lines += [f"#ifndef {name}", f"#define {name} {value}", "#endif"]
    lines += ["", "namespace limn::gl {", "",
              "/// Finds a command by its full name; null when there is none.",
              "using GetProcAddress = std::function<void*(const char* name)>;", "",
              f"/// The commands of OpenGL {VERSION[0]}.{VERSION[1]} core, without the gl prefix.",
              "struct Functions {"]
    lines += [f"  {result} (*{name})({', '.join(parameters)}) = nullptr;"
              for name, result, parameters, _ in functions]
    lines += ["",
              "  /// Fills the table. False when a command is missing; `missing` then names the first one.",
              "  bool load(const GetProcAddress& getProcAddress, std::string& missing);",
              "};", "", "}  // namespace limn::gl", ""]
    return "\n".join(lines)


def source(functions):
    lines = [NOTICE + '#include "core/context/gl_functions.h"', "", "namespace limn::gl {", "namespace {", "",
             "template <class Command>",
             "bool find(const GetProcAddress& getProcAddress, const char* name, Command& command,"
             " std::string& missing) {",
             "  command = reinterpret_cast<Command>(getProcAddress(name));",
             "  if (command == nullptr) missing = name;",
             "  return command != nullptr;",
             "}", "", "}  // namespace", "",
             "bool Functions::load(const GetProcAddress& getProcAddress, std::string& missing) {"]
    lines.append("  return " + " &&\n         ".join(
        f'find(getProcAddress, "gl{name}", {name}, missing)' for name, _, _, _ in functions) + ";")
    lines += ["}", "", "}  // namespace limn::gl", ""]
    return "\n".join(lines)


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def main():
    registry_path, header_path, source_path = sys.argv[1:]
    registry = ElementTree.parse(registry_path).getroot()
    names = core_interface(registry)
    functions = commands(registry, names["command"] - LEFT_OUT)
    wanted_types = names["type"].union(*(types for _, _, _, types in functions))
    # Types that a command never names but that limn stores.
    wanted_types |= {"GLboolean", "GLfloat", "GLdouble", "GLDEBUGPROC"}
    write(header_path, header(type_declarations(registry, wanted_types), constants(registry, names["enum"]),
                              functions))
    write(source_path, source(functions))


if __name__ == "__main__":
    main()
