"""Writes interface_hash.h: a hash of the public headers. interface_hash.py OUT ROOT FILE..."""
import hashlib
import os
import sys


def main():
    out, root, files = sys.argv[1], sys.argv[2], sorted(sys.argv[3:])
    digest = hashlib.sha256()
    for path in files:
        digest.update(os.path.relpath(path, root).encode() + b"\0")
        with open(path, "rb") as file:
            digest.update(file.read() + b"\0")
    text = "#pragma once\n#define LIMN_INTERFACE_HASH \"" + digest.hexdigest()[:32] + "\"\n"
    if os.path.exists(out):
        with open(out, encoding="utf-8") as file:
            if file.read() == text:
                return
    os.makedirs(os.path.dirname(out), exist_ok=True)
    with open(out, "w", encoding="utf-8") as file:
        file.write(text)


if __name__ == "__main__":
    main()
