"""Includes keep to the table of docs/architecture.md: layers.py SOURCE BUILD.

Every folder that holds C++ has one row; its files include their own folder and those of the row; rows name only rows
above them, so that there is no circle. Headers in private/ are included from their own folder (and from tests) alone.
Techniques include of core what module_headers.txt offers, and nine in ten of the headers offered are used by one.
Folders of glsl/ include each other without a circle.
"""
import pathlib
import re
import subprocess
import sys

source, build = (pathlib.Path(argument) for argument in sys.argv[1:])
INCLUDE = re.compile(r'^\s*#\s*include\s*"((?:core|glsl|apps|techniques|assets|benchmarks|tests)/[^"]+)"', re.MULTILINE)
problems = []


def table():
    """Folder -> the folders its row names, in the order of the rows."""
    rows = {}
    text = (source / "docs/architecture.md").read_text()
    for line in text[text.index("| folder | library |"):].split("\n\n")[0].splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        folder = re.fullmatch(r"`([a-z_/]+)`", cells[0])
        if folder:
            names = [name.strip() for name in cells[3].split(",") if name.strip()]
            rows[folder[1]] = [name if "/" in name or name == "glsl" else "core/" + name for name in names]
    return rows


def folder_of(path, rows):
    """The row that a file belongs to: its longest prefix."""
    inside = [folder for folder in rows if path.startswith(folder + "/")]
    return max(inside, key=len, default=None)


def sources(folder, *suffixes):
    return (path for path in sorted((source / folder).rglob("*")) if path.suffix in suffixes)


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def check_includes(rows):
    for top in ("core", "techniques", "apps", "assets", "benchmarks"):
        for path in sources(top, ".cpp", ".h"):
            name = str(path.relative_to(source))
            own = folder_of(name, rows)
            if own is None:
                problems.append(f"{name}: its folder has no row in docs/architecture.md")
                continue
            for included in includes(path):
                other = folder_of(included, rows)
                if other not in (own, None) and other not in rows[own]:
                    problems.append(f"{name} includes {included}, but {own} may not include {other}")
                if "/private/" in included and other != own:
                    problems.append(f"{name} includes {included}, which is private to {other}")


def check_order(rows):
    known = set()
    for folder, names in rows.items():
        problems.extend(f"the row of {folder} names {name}, which is not above it" for name in names if name not in known)
        known.add(folder)


def check_module_headers():
    roots = [source, build / "generated"]
    offered = set(subprocess.run([sys.executable, "-B", source / "cmake/module_headers.py", "list", *roots], check=True,
                                 capture_output=True, text=True).stdout.split())
    waiting = list(sources("techniques", ".cpp", ".h")) + [source / "core/technique/technique.h"]
    used = {"core/technique/technique.h"}
    while waiting:
        path = waiting.pop()
        for included in includes(path):
            if included.startswith("core/") and included not in offered:
                problems.append(f"{path.relative_to(source)} includes {included}, which module_headers.txt does not offer")
            if included not in used:
                used.add(included)
                waiting += [root / included for root in roots if (root / included).is_file()]
    headers = {name for name in offered if name.startswith("core/")}
    unused = sorted(headers - used)
    if len(unused) > 0.1 * len(headers):
        problems.append(f"module_headers.txt offers {len(headers)} headers, {len(unused)} of them without need: {unused}")


def check_glsl():
    below = {}
    for path in sources("glsl", ".glsl"):
        own = path.relative_to(source).parts[1]
        others = {included.split("/")[1] for included in includes(path) if included.startswith("glsl/")} - {own}
        below.setdefault(own, set()).update(others)
    while below:
        bottom = [folder for folder, others in below.items() if not others & below.keys()]
        if not bottom:
            problems.append(f"folders of glsl/ include each other in a circle: {', '.join(sorted(below))}")
            return
        for folder in bottom:
            del below[folder]


layers = table()
check_order(layers)
check_includes(layers)
check_module_headers()
check_glsl()
print("\n".join(problems))
sys.exit(1 if problems or not layers else 0)
