"""Puts style and script into the page and their hashes into its policy: assemble.py PAGE STYLE SCRIPT OUT.

The policy then lets exactly these two run, and whatever a row of results brings into the page does not (Content Security
Policy Level 3, section 6.7.2.3). What is left for limn are the marks {{data}} and {{pictures}}.
"""
import base64
import hashlib
import sys


def source(content):
    return f"'sha256-{base64.b64encode(hashlib.sha256(content.encode()).digest()).decode()}'"


def main():
    page, style, script = (open(path, encoding="utf-8").read() for path in sys.argv[1:4])
    for content, end in ((style, "</style"), (script, "</script"), (script, "<!--")):
        if end in content:
            sys.exit(f"{end} would end the element it is in")
    for mark, text in (("style-hash", source(style)), ("script-hash", source(script)), ("style", style), ("script", script)):
        if page.count("{{" + mark + "}}") != 1:
            sys.exit(f"{sys.argv[1]}: {{{{{mark}}}}} must be there once")
        page = page.replace("{{" + mark + "}}", text)
    with open(sys.argv[4], "w", encoding="utf-8") as file:
        file.write(page)


if __name__ == "__main__":
    main()
