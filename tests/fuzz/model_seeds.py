#!/usr/bin/env python3
"""Seeds with the structure of real models: every list of a binary glTF kept, what the lists point at cut short.

Usage: model_seeds.py OUT MODEL..., each MODEL a .glb file or a folder looked through for them. A seed holds the first
elements of each accessor, packed; two animations of six channels; a picture of 2 x 2 texels in place of each image.
"""

import json
import pathlib
import struct
import sys
import zlib

ELEMENTS = 6  # of an accessor
CHANNELS = 6
ANIMATIONS = 2
PRIMITIVES = 4
LONGEST = 16384  # bytes of a seed
SIZES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
INTEGERS = {5121: "B", 5123: "H", 5125: "I"}


def picture():
    """A PNG of 2 x 2 grey RGB texels."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = (b"\0" + b"\x80" * 6) * 2
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2, 2, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Packer:
    """The cut copy of a document's accessors, numbered in the order in which they are asked for."""

    def __init__(self, root, binary):
        self.accessors, self.views = root.get("accessors", []), root.get("bufferViews", [])
        self.source, self.binary = binary, bytearray()
        self.known, self.new_accessors, self.new_views = {}, [], []

    def view(self, data):
        self.binary += b"\0" * (-len(self.binary) % 4)
        self.new_views.append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data
        return len(self.new_views) - 1

    def accessor(self, index, count, below=None):
        """The number of the cut copy of accessor `index`; its integers are below `below` where that is given."""
        if index in self.known:
            return self.known[index]
        old = dict(self.accessors[index])
        old.pop("sparse", None)
        count = min(count, old["count"])
        size = SIZES[old["componentType"]] * COMPONENTS[old["type"]]
        data = bytes(size * count)
        if "bufferView" in old:
            view = self.views[old["bufferView"]]
            start = view.get("byteOffset", 0) + old.get("byteOffset", 0)
            stride = view.get("byteStride", size)
            data = b"".join(self.source[start + i * stride:start + i * stride + size] for i in range(count))
        if below is not None:
            kind = INTEGERS[old["componentType"]]
            values = struct.unpack(f"<{len(data) // struct.calcsize(kind)}{kind}", data)
            data = struct.pack(f"<{len(values)}{kind}", *(value % below for value in values))
        old.update(count=count, bufferView=self.view(data))
        old.pop("byteOffset", None)
        self.new_accessors.append(old)
        self.known[index] = len(self.new_accessors) - 1
        return self.known[index]


def cut_primitive(primitive, packer, joints):
    for name, index in primitive["attributes"].items():
        primitive["attributes"][name] = packer.accessor(index, ELEMENTS, joints if name.startswith("JOINTS") else None)
    for target in primitive.get("targets", []):
        for name, index in target.items():
            target[name] = packer.accessor(index, ELEMENTS)
    if "indices" in primitive:
        vertices = packer.new_accessors[primitive["attributes"]["POSITION"]]["count"]
        primitive["indices"] = packer.accessor(primitive["indices"], ELEMENTS, vertices)


def cut_animation(animation, packer):
    channels = animation["channels"][:CHANNELS]
    used = sorted({channel["sampler"] for channel in channels})
    samplers = [animation["samplers"][s] for s in used]
    for channel in channels:
        channel["sampler"] = used.index(channel["sampler"])
    for sampler in samplers:
        times = packer.accessors[sampler["input"]]["count"]
        each = packer.accessors[sampler["output"]]["count"] // times
        sampler["input"] = packer.accessor(sampler["input"], 3)
        sampler["output"] = packer.accessor(sampler["output"], min(3, times) * each)
    animation.update(channels=channels, samplers=samplers)


def seed(model):
    """The cut copy of the binary glTF `model`, as bytes."""
    data = pathlib.Path(model).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    root = json.loads(data[20:20 + length])
    packer = Packer(root, data[28 + length:])
    joints = min((len(skin["joints"]) for skin in root.get("skins", [])), default=1)
    for mesh in root.get("meshes", []):
        mesh["primitives"] = mesh["primitives"][:PRIMITIVES]
        for primitive in mesh["primitives"]:
            cut_primitive(primitive, packer, joints)
    for skin in root.get("skins", []):
        if "inverseBindMatrices" in skin:
            skin["inverseBindMatrices"] = packer.accessor(skin["inverseBindMatrices"], len(skin["joints"]))
    for node in root.get("nodes", []):
        attributes = node.get("extensions", {}).get("EXT_mesh_gpu_instancing", {}).get("attributes", {})
        for name, index in attributes.items():
            attributes[name] = packer.accessor(index, ELEMENTS)
    if "animations" in root:
        root["animations"] = root["animations"][:ANIMATIONS]
        for animation in root["animations"]:
            cut_animation(animation, packer)
    if "images" in root:
        view = packer.view(picture())
        root["images"] = [{"bufferView": view, "mimeType": "image/png"} for _ in root["images"]]
    if packer.new_accessors:
        root["accessors"] = packer.new_accessors
    if packer.new_views:
        root["bufferViews"] = packer.new_views
        root["buffers"] = [{"byteLength": len(packer.binary)}]
    text = json.dumps(root, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary = bytes(packer.binary) + b"\0" * (-len(packer.binary) % 4)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A) + text +
            struct.pack("<II", len(binary), 0x004E4942) + binary)


def main(out, *models):
    pathlib.Path(out).mkdir(parents=True, exist_ok=True)
    written = 0
    for model in map(pathlib.Path, models):
        for file in sorted(model.rglob("*.glb")) if model.is_dir() else [model]:
            cut = seed(file)
            if len(cut) <= LONGEST:
                pathlib.Path(out, f"model_{file.stem}.glb").write_bytes(cut)
                written += 1
    print(f"{written} seeds of models in {out}")


if __name__ == "__main__":
    main(*sys.argv[1:])
