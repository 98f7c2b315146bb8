"""Writes a C++ file that says which headers a library was compiled from: interface_hash.py OUT FUNCTION ROOT... -- FILE...

The file defines `const char* FUNCTION()`: a hash of the FILEs and of everything that they include by quoted names,
looked up under the ROOTs. Names are relative to the root, so that a source tree and an installed one agree. What a
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
        sys.exit(f"interface_hash.py: {path} is under none of {', '.join(roots)}")
    return os.path.relpath(path, max(inside, key=len))


def found(name, includer, roots):
    """The file that a quoted include names: beside the includer, or under a root."""
    for folder in (os.path.dirname(includer), *roots):
        path = os.path.normpath(os.path.join(folder, name))
        if os.path.isfile(path):
            return path
    sys.exit(f'interface_hash.py: {includer} includes "{name}", which is not under {", ".join(roots)}')


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


def main():
    out, function, *rest = sys.argv[1:]
    split = rest.index("--")
    roots, files = [[os.path.abspath(path) for path in part] for part in (rest[:split], rest[split + 1:])]
    if not files:
        sys.exit(f"interface_hash.py: no headers under {', '.join(roots)}")
    digest = hashlib.sha256()
    for name, content in sorted(closure(files, roots).items()):
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


if __name__ == "__main__":
    main()
