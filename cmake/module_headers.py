"""The headers that modules compile from limn: those of module_headers.txt, what they include by quoted names, all GLSL.

module_headers.py hash OUT FUNCTION ROOT...     writes a C++ file that defines `const char* FUNCTION()`, their hash
module_headers.py install FOLDER ROOT...        copies them to FOLDER and prints their names
module_headers.py list ROOT...                  prints their names

Names are looked up under the ROOTs and are relative to them, so that a source tree and an installed one agree. What a
quoted include names must exist: a header that the hash does not cover cannot be part of the interface.
"""
import hashlib
import os
import re
import sys

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.MULTILINE)


def named(path, roots):
    """The name of a file under the deepest root that holds it."""
    inside = [root for root in roots if path.startswith(root + os.sep)]
    if not inside:
        sys.exit(f"module_headers.py: {path} is under none of {', '.join(roots)}")
    return os.path.relpath(path, max(inside, key=len))


def found(name, includer, roots):
    """The file that a quoted include names: beside the includer, or under a root."""
    for folder in (os.path.dirname(includer), *roots):
        path = os.path.normpath(os.path.join(folder, name))
        if os.path.isfile(path):
            return path
    sys.exit(f'module_headers.py: {includer} includes "{name}", which is not under {", ".join(roots)}')


def closure(files, roots):
    """Name and content of every file and of all that they include."""
    contents, waiting = {}, list(files)
    while waiting:
        path = waiting.pop()
        name = named(path, roots)
        if name in contents:
            continue
        with open(path, "rb") as file:
            contents[name] = file.read()
        text = contents[name].decode("utf-8")
        waiting += [found(included, path, roots) for included in INCLUDE.findall(text)]
    return contents


def interface(roots):
    """Name and content of every file of the interface."""
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "module_headers.txt"), encoding="utf-8") as file:
        listed = [line.strip() for line in file if line.strip() and not line.startswith("#")]
    entries = [found(name, os.path.join(roots[0], ""), roots) for name in listed]  # as a file in the root names them
    for root in roots:
        for folder, _, names in os.walk(os.path.join(root, "glsl")):
            entries += [os.path.join(folder, name) for name in names if name.endswith(".glsl")]
    return closure(entries, roots)


def write_hash(out, function, headers):
    digest = hashlib.sha256()
    for name, content in sorted(headers.items()):
        digest.update(name.encode() + b"\0" + str(len(content)).encode() + b"\0" + content)
    namespace, _, name = function.rpartition("::")
    text = (f"namespace {namespace} {{\nconst char* {name}();\n"
            f"const char* {name}() {{ return \"{digest.hexdigest()[:32]}\"; }}\n}}  // namespace {namespace}\n")
    if os.path.exists(out):
        with open(out, encoding="utf-8") as file:
            if file.read() == text:
                return  # nothing that depends on it is built again
    with open(out, "w", encoding="utf-8") as file:
        file.write(text)


def install(folder, headers):
    for name, content in headers.items():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(content)


def main():
    command, *rest = sys.argv[1:]
    given = {"hash": 2, "install": 1, "list": 0}[command]
    headers = interface([os.path.abspath(path) for path in rest[given:]])
    if command == "hash":
        write_hash(*rest[:2], headers)
        return
    if command == "install":
        install(rest[0], headers)
    print("\n".join(sorted(headers)))


if __name__ == "__main__":
    main()
