"""A scratch copy of limn's sources, and additions to it as CONTRIBUTING.md describes them, in the files it names and no others."""
import pathlib
import re
import shutil

from common import SOURCE, check

DOCUMENT = (SOURCE / "CONTRIBUTING.md").read_text()


def copy_sources(folder, *parts):
    """Copies files and folders of the source tree to the same places below `folder`."""
    for part in parts:
        source, target = SOURCE / part, folder / part
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns("results", "__pycache__"))
        else:
            shutil.copyfile(source, target)


class Addition:
    """One kind of addition: what CONTRIBUTING.md says between its bold name and the next one, carried out in a scratch copy."""

    def __init__(self, folder, name):
        found = re.search(r"^\*\*" + re.escape(name) + r"\*\*.*?(?=^\*\*)", DOCUMENT, re.DOTALL | re.MULTILINE)
        check(found, f"CONTRIBUTING.md says nothing of **{name}**")
        self.folder, self.name, self.text = folder, name, found[0]

    def block(self, replaced):
        """The paragraph's block of C++, with other words in the place of some of its own."""
        found = re.search(r"```cpp\n(.*?)```", self.text, re.DOTALL)
        check(found, f"CONTRIBUTING.md has no block of C++ for **{self.name}**")
        block = found[1]
        for old, new in replaced.items():
            check(old in block, f"CONTRIBUTING.md's block for **{self.name}** lacks '{old}'")
            block = block.replace(old, new)
        return block

    def _named(self, path):
        """Whether the paragraph names the file, by its path or by its name, or the folder that a new file is put into."""
        place = pathlib.PurePath(path)
        new = not (self.folder / path).exists()
        return path in self.text or f"`{place.name}`" in self.text or (new and f"`{place.parent}/`" in self.text)

    def _file(self, path):
        check(self._named(path), f"{path} must change, and CONTRIBUTING.md does not name it for **{self.name}**")
        return self.folder / path

    def create(self, path, text):
        self._file(path).write_text(text)

    def replace(self, path, anchor, text):
        """Puts `text` in the place of `anchor`, which stands in the file once."""
        file = self._file(path)
        content = file.read_text()
        check(content.count(anchor) == 1, f"{path} has {content.count(anchor)} times what the addition of **{self.name}** to it "
              f"goes by, and should have it once:\n{anchor}")
        file.write_text(content.replace(anchor, text))

    def before(self, path, anchor, text):
        self.replace(path, anchor, text + anchor)

    def after(self, path, anchor, text):
        self.replace(path, anchor, anchor + text)
