"""What documents point to is there: documents.py LIMN SOURCE.

Links within the repository lead to a file, and to a heading or a named place in it; files in backticks exist where the first part
of their path is a folder of the repository's; each `limn COMMAND` takes the options that stand behind it; and settings like
TECHNIQUE.PARAMETER=VALUE name parameters that there are, in the chapters' programs and in scripts as well (not in results, which
are of their day).
"""
import functools
import json
import pathlib
import re
import subprocess
import sys

limn, source = sys.argv[1], pathlib.Path(sys.argv[2])
FOLDERS = ("apps", "assets", "benchmarks", "cmake", "core", "docs", "glsl", "scripts", "techniques", "tests")
PATH = re.compile(r"`((?:" + "|".join(FOLDERS) + r")/[\w./-]*\w\.(?:cpp|frag|glsl|h|js|md|py|toml|txt|vert))`")
CALL = re.compile(r"\blimn ([a-z][a-z-]*(?: (?:info|simulate|fit)\b)?)((?:\\\n|[^\n`|#]|(?<!\s)#)*)")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
SETTING = re.compile(r"\b([a-z]\w*)\.([a-z]\w*)=")
problems = []


def without_code(text):
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE))


@functools.cache
def places(document):
    """The anchors of a document: GitHub's of its headings, and those that are named."""
    text = document.read_text(encoding="utf-8")
    found = set(re.findall(r'<a id="([^"]+)">', text))
    for heading in re.findall(r"^#+ +(.*)$", re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE), re.MULTILINE):
        name = re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)", "", heading).lower()).strip().replace(" ", "-")
        number = 0
        while (anchor := f"{name}-{number}" if number else name) in found:
            number += 1
        found.add(anchor)
    return found


@functools.cache
def options(command):
    """The options of a command, by its help; None where there is no such command."""
    asked = subprocess.run([limn, *command.split(), "--help"], capture_output=True, text=True)
    return set(OPTION.findall(asked.stdout)) if asked.returncode == 0 else None


def check_links(document, text):
    for target in re.findall(r"\]\(([^)\s]+)\)", without_code(text)):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (document.parent / path).resolve() if path else document
        if not file.exists():
            problems.append(f"{document}: {target} leads to no file")
        elif anchor and file.suffix == ".md" and anchor not in places(file):
            problems.append(f"{document}: {target} leads to no heading")


def check_paths(document, text):
    problems.extend(f"{document}: there is no {path}" for path in PATH.findall(text)
                    if not (source / path).exists() and not (document.parent / path).exists())


def check_calls(document, text):
    for command, rest in CALL.findall(text):
        known = options(command)
        for option in OPTION.findall(rest) if known is not None else ():
            if option not in known:
                problems.append(f"{document}: limn {command} has no option {option}")


def check_settings(file, text):
    problems.extend(f"{file}: {technique} has no parameter {name}" for technique, name in SETTING.findall(text)
                    if technique in parameters and name not in parameters[technique])


listed = subprocess.run([limn, "list", "--json"], check=True, capture_output=True, text=True).stdout
parameters = {technique["name"]: {parameter["name"] for parameter in technique["parameters"]}
              for technique in json.loads(listed)["techniques"]}
documents = [path for path in source.glob("*.md") if path.name != "CHANGELOG.md"]
documents += [path for folder in FOLDERS for path in sorted((source / folder).rglob("*.md"))]
for document in documents:
    text = document.read_text(encoding="utf-8")
    check_links(document, text)
    check_paths(document, text)
    check_calls(document, text)
    if not document.is_relative_to(source / "docs/results"):
        check_settings(document, text)
for file in [*sorted((source / "apps/chapters").glob("*.cpp")), *sorted((source / "scripts").glob("*"))]:
    if file.is_file():
        check_settings(file, file.read_text(encoding="utf-8"))
print("\n".join(problems))
sys.exit(1 if problems or not documents or not parameters or not options("render") else 0)
