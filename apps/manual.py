"""Writes a manual page for limn and for each of its commands, from what their --help says: manual.py HELP2MAN LIMN FOLDER."""
import pathlib
import re
import subprocess
import sys

help2man, limn, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
folder.mkdir(parents=True, exist_ok=True)


def said(*arguments):
    return subprocess.run([limn, *arguments], check=True, capture_output=True, text=True).stdout


def page(command, description):
    name = " ".join(["limn", *command])
    text = subprocess.run([help2man, "--no-info", f"--name={description}", f"--version-string={version}",
                           "--include=/dev/stdin", " ".join([str(limn), *command])],
                          check=True, capture_output=True, text=True,
                          input=f"[see also]\n{', '.join(also(command))}\n").stdout
    text = text.replace(str(limn), "limn")
    (folder / (name.replace(" ", "-") + ".1")).write_text(text)


def also(command):
    pages = ["limn", *(f"limn-{other}" for other in commands if other != "view")]
    return [f"{page}(1)" for page in pages if page != "-".join(["limn", *command])]


version = said("--version").split()[-1]
# Subcommands stand in the help after their heading, a name and a description a line, which goes on further to the right.
listed = said("--help").split("Subcommands:\n")[1]
commands = dict(re.findall(r"^  (\S+) +(.+)$", listed, re.MULTILINE))
page([], "real-time shadows and global illumination, with their error and their cost")
for command, description in commands.items():
    if command != "view":  # whose options are another program's
        page([command], description[0].lower() + description[1:])
