"""Writes a manual page for limn, for each of its commands and for the programs with a window, from what their --help says:
manual.py HELP2MAN FOLDER LIMN [PROGRAM...]."""
import pathlib
import re
import subprocess
import sys

help2man, folder = sys.argv[1], pathlib.Path(sys.argv[2])
limn, *programs = map(pathlib.Path, sys.argv[3:])
folder.mkdir(parents=True, exist_ok=True)


def said(program, *arguments):
    return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout


def page(program, command, description):
    called = " ".join([program.name, *command])
    name = "-".join([program.name, *command])
    # help2man hands its last argument to a shell, to which a folder's name may mean something else.
    text = subprocess.run([help2man, "--no-info", f"--name={description[0].lower()}{description[1:]}",
                           f"--version-string={version}", "--include=/dev/stdin", f"./{called}"],
                          check=True, capture_output=True, text=True, cwd=program.parent,
                          input=f"[see also]\n{', '.join(f'{other}(1)' for other in pages if other != name)}\n").stdout
    # It takes the words of the call for the page's name; that has no space, or whatis and apropos read none.
    text = re.sub(r'^\.TH .*? "1"', f'.TH {name.upper()} "1"', text, count=1, flags=re.MULTILINE)
    text = text.replace(f"\n{called} \\- ", f"\n{name} \\- ", 1)
    (folder / f"{name}.1").write_text(text)


version = said(limn, "--version").split()[-1]
# Subcommands stand in the help after their heading, a name and a description a line, which goes on further to the right.
listed = said(limn, "--help").split("Subcommands:\n")[1]
commands = dict(re.findall(r"^  (\S+) +(.+)$", listed, re.MULTILINE))
del commands["view"]  # the program limn-view
pages = ["limn", *(f"limn-{command}" for command in commands), *(program.name for program in programs)]
page(limn, [], "real-time shadows and global illumination, with their error and their cost")
for command, description in commands.items():
    page(limn, [command], description)
for program in programs:
    page(program, [], said(program, "--help").splitlines()[0])
