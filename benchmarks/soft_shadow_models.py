#!/usr/bin/env python3
"""Measures soft shadows on models that are not limn's: each stands on a floor under a lamp of .3 of its radius.

LIMN_MODELS names the folder of .glb files; without it nothing is measured, which is said.
"""
import argparse
import json
import math
import os
import pathlib
import struct
import subprocess
import sys

MODELS = ("bunny_69k", "armadillo_86k", "buddha_100k", "dragon_202k")
# Lamp and camera from the middle of the model's box, in radii of it.
LAMP, CAMERA = (1.3, 2.4, 1.1), (-0.9, 1.2, 3.2)
LAMP_SIDE = 0.3
FLOOR = 3  # half the floor's side
FITS = '["scene", "view"]'
TECHNIQUES = [  # technique, parameters
    ("hard_shadow_map", ""),
    ("vssm", f"shadow_map_fit = {FITS}"),
    *((name, f"shadow_map_fit = {FITS}, views = [1, 2]") for name in ("vssm", "pcss", "backprojection")),
    *((name, f'shadow_map_fit = "{fit}", views = {views}') for name in ("cssm", "savsm", "moment_soft_shadow_map")
      for fit, views in (("scene", 1), ("view", 2))),
    ("bitmask_soft_shadows", f"shadow_map_fit = {FITS}"),
    ("sampled_area_light", "samples = [16, 64], shadow_map_size = 1024"),
    ("ray_traced_area_light", "rays = [4, 16]"),
]


def read_glb(path):
    """Returns the JSON and the buffer of a .glb file."""
    data = path.read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20:20 + length]), bytearray(data[28 + length:])


def write_glb(path, gltf, buffer):
    """Writes both as a .glb file."""
    buffer += bytes(-len(buffer) % 4)
    gltf["buffers"] = [{"byteLength": len(buffer)}]
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    with path.open("wb") as file:
        file.write(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(buffer)))
        file.write(struct.pack("<II", len(text), 0x4E4F534A) + text)
        file.write(struct.pack("<II", len(buffer), 0x004E4942) + buffer)


def looking(at, target):
    """Returns translation and rotation of a node whose -Z axis points from `at` to `target`."""
    z = [a - b for a, b in zip(at, target)]
    length = math.hypot(*z)
    yaw = math.atan2(z[0], z[2])
    pitch = -math.asin(z[1] / length)
    cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    return {"translation": at, "rotation": [cy * sp, sy * cp, -sy * sp, cy * cp]}


def bounds(gltf):
    """Returns the box of a model of one mesh whose nodes do not move it."""
    if any(key in node for node in gltf["nodes"] for key in ("matrix", "translation", "rotation", "scale")):
        raise SystemExit("models with transformed nodes are not measured")
    boxes = [gltf["accessors"][p["attributes"]["POSITION"]] for m in gltf["meshes"] for p in m["primitives"]]
    return [min(b["min"][i] for b in boxes) for i in range(3)], [max(b["max"][i] for b in boxes) for i in range(3)]


def add_floor(gltf, buffer, middle, height, half):
    """Adds a square of 2 `half` metres a side and returns its node."""
    corners = [(middle[0] + x * half, height, middle[2] + z * half) for x, z in ((-1, -1), (-1, 1), (1, 1), (1, -1))]
    buffer += bytes(-len(buffer) % 4)
    start = len(buffer)
    for corner in corners:
        buffer += struct.pack("<3f", *corner)
    buffer += struct.pack("<12f", *(0, 1, 0) * 4) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    views, accessors = gltf["bufferViews"], gltf["accessors"]
    for offset, size in ((0, 48), (48, 48), (96, 12)):
        views.append({"buffer": 0, "byteOffset": start + offset, "byteLength": size})
    accessors.append({"bufferView": len(views) - 3, "componentType": 5126, "count": 4, "type": "VEC3",
                      "min": list(corners[0]), "max": list(corners[2])})
    accessors.append({"bufferView": len(views) - 2, "componentType": 5126, "count": 4, "type": "VEC3"})
    accessors.append({"bufferView": len(views) - 1, "componentType": 5123, "count": 6, "type": "SCALAR"})
    first = len(accessors) - 3
    gltf["meshes"].append({"primitives": [{"attributes": {"POSITION": first, "NORMAL": first + 1}, "indices": first + 2}]})
    return {"mesh": len(gltf["meshes"]) - 1, "name": "floor"}


def stand(model, scene):
    """Writes `scene`: the model on a floor, lamp and camera."""
    gltf, buffer = read_glb(model)
    low, high = bounds(gltf)
    middle = [0.5 * (a + b) for a, b in zip(low, high)]
    radius = 0.5 * math.dist(low, high)
    side = LAMP_SIDE * radius
    gltf["extensionsUsed"] = ["KHR_lights_punctual"]
    gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 40 * radius * radius}]}}
    gltf["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01 * radius}}]
    place = [[m + radius * x for m, x in zip(middle, offset)] for offset in (LAMP, CAMERA)]
    nodes = gltf["nodes"]
    first = len(nodes)
    nodes += [add_floor(gltf, buffer, middle, low[1], FLOOR * radius),
              looking(place[0], middle) | {"name": "key", "extras": {"limn_area": [side, side]},
                                           "extensions": {"KHR_lights_punctual": {"light": 0}}},
              looking(place[1], [middle[0], middle[1] - 0.3 * radius, middle[2]]) | {"name": "main", "camera": 0}]
    gltf["scenes"][0]["nodes"] += range(first, first + 3)
    write_glb(scene, gltf, buffer)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limn", default="build/bin/limn", help="the program")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for scenes, suite and results")
    options = parser.parse_args()
    folder = os.environ.get("LIMN_MODELS")
    models = [pathlib.Path(folder, name + ".glb") for name in MODELS] if folder else []
    there = [model for model in models if model.exists()]
    if not there:
        print("skipped: LIMN_MODELS names no folder with", ", ".join(name + ".glb" for name in MODELS))
        return 0
    for model in models:
        if model not in there:
            print(f"skipped: there is no {model.name}")
    options.out.mkdir(parents=True, exist_ok=True)
    suite = ('name = "soft_shadow_models"\nsizes = ["256x192"]\nframes = 1\nturns = 2\nwarmup = 1\nterm = "visibility"\n'
             'reference = {spp = 256}\n')
    for model in there:
        scene = (options.out / model.name).resolve()
        stand(model, scene)
        suite += f'[[scenes]]\nscene = "{scene}"\nlights = ["key"]\nmax_masked_share = 0.05\n'
    file = options.out / "soft_shadow_models.toml"
    for name, parameters in TECHNIQUES:
        suite += f'[[techniques]]\ntechnique = "{name}"\nparameters = {{{parameters}}}\n'
    file.write_text(suite)
    return subprocess.run([options.limn, "bench", file, "--out", options.out / "results"], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
