#!/usr/bin/env python3
"""Writes flag.gltf and cape.gltf, the two cloths that tests import as an artist would export them."""

import base64
import json
import math
import pathlib
import struct
import sys

FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT = 5126, 5121, 5123
CODES = {FLOAT: "f", UNSIGNED_BYTE: "B", UNSIGNED_SHORT: "H"}
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


class File:
    """A glTF file with one buffer."""

    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def add(self, rows, component=FLOAT):
        """Adds an accessor of rows of numbers and returns its index."""
        data = b"".join(struct.pack("<" + CODES[component] * len(row), *row) for row in rows)
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)}
        self.bytes += data + bytes(-len(data) % 4)
        accessor = {
            "bufferView": len(self.views),
            "componentType": component,
            "count": len(rows),
            "type": KINDS[len(rows[0])],
        }
        if len(rows[0]) == 3:
            accessor["min"] = [min(row[axis] for row in rows) for axis in range(3)]
            accessor["max"] = [max(row[axis] for row in rows) for axis in range(3)]
        self.views.append(view)
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def write(self, name, content, indent=1):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        whole = {
            "asset": {"version": "2.0", "generator": "assets/cloths/" + pathlib.Path(sys.argv[0]).name},
            "scene": 0,
            **content,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.bytes), "uri": uri}],
        }
        path = pathlib.Path(__file__).parent / name
        path.write_text(json.dumps(whole, indent=indent) + "\n")


def f32(value):
    """The value as a 32-bit float, so that the bounds are those of the buffer."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def sheet(columns, rows, place):
    """Positions and texture coordinates of a sheet, row by row from the top left, and its triangles."""
    uv = [(i / (columns - 1), j / (rows - 1)) for j in range(rows) for i in range(columns)]
    positions = [tuple(f32(value) for value in place(u, v)) for u, v in uv]
    triangles = []
    for j in range(rows - 1):
        for i in range(columns - 1):
            a, b = j * columns + i, (j + 1) * columns + i
            triangles += [(a,), (b,), (a + 1,), (a + 1,), (b,), (b + 1,)]
    return positions, uv, triangles


def flag():
    """A flag of 1.5 m × 1 m; the alpha channel of its vertex colours is 0 where it is pinned."""
    file = File()
    positions, uv, triangles = sheet(17, 11, lambda u, v: (1.5 * u, -v, 0.0))
    colors = [(1.0, 1.0, 1.0, 0.0 if u == 0.0 else 1.0) for u, _ in uv]
    attributes = {
        "POSITION": file.add(positions),
        "NORMAL": file.add([(0.0, 0.0, 1.0)] * len(positions)),
        "TEXCOORD_0": file.add(uv),
        "COLOR_0": file.add(colors),
    }
    primitive = {"attributes": attributes, "indices": file.add(triangles, UNSIGNED_SHORT), "material": 0}
    paint = {"paint": {"Color": "Alpha"}, "free": 1.0, "pinned": 0.0}
    cloth = [
        {"ClothFromMesh": {"weights": paint}},
        {"ClothMaterial": {"area_density": 0.25}},
        {"Attachment": {"target": "Halyard", "vertices": "Rigid"}},
    ]
    wind = {"velocity": [5.0, 0.0, 2.0]}
    file.write("flag.gltf", {
        "scenes": [{"nodes": [0, 2, 3], "extras": {"skein": [{"ClothSettings": {"air_density": 1.1}}]}}],
        "nodes": [
            {"name": "Pole", "children": [1]},
            {"name": "Halyard", "translation": [0.0, 3.0, 0.0]},
            {"name": "Flag", "mesh": 0},
            {"name": "Wind", "extras": {"skein": [{"WindField": wind}]}},
        ],
        "meshes": [{"name": "FlagCloth", "primitives": [primitive], "extras": {"skein": cloth}}],
        "materials": [{
            "name": "Red",
            "doubleSided": True,
            "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.05, 0.05, 1.0], "metallicFactor": 0.0},
        }],
    })


def cape():
    """A cape on a skeleton: `_PIN` is 1 at the collar, `_PLAY` grows towards the hem."""
    file = File()

    def place(u, v):
        angle, radius = math.pi * (u - 0.5), 0.22 + 0.2 * v
        return radius * math.sin(angle), 1.5 - 1.1 * v, -radius * math.cos(angle)

    def normal(u, _):
        angle = math.pi * (u - 0.5)
        return math.sin(angle), 0.0, -math.cos(angle)

    positions, uv, triangles = sheet(13, 17, place)
    # The outside is the front.
    triangles = [corner for i in range(0, len(triangles), 3) for corner in reversed(triangles[i:i + 3])]
    # The pose of the chest is 1.2 m above that of the root, which is the origin.
    inverse = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -height, 0, 1] for height in (0.0, 1.2)]
    attributes = {
        "POSITION": file.add(positions),
        "NORMAL": file.add([normal(u, v) for u, v in uv]),
        "TEXCOORD_0": file.add(uv),
        "JOINTS_0": file.add([(0, 1, 0, 0)] * len(uv), UNSIGNED_BYTE),
        "WEIGHTS_0": file.add([(f32(0.5 * v), 1.0 - f32(0.5 * v), 0.0, 0.0) for _, v in uv]),
        "_PIN": file.add([(1.0 if v == 0.0 else 0.0,) for _, v in uv]),
        "_PLAY": file.add([(f32(v),) for _, v in uv]),
    }
    primitive = {"attributes": attributes, "indices": file.add(triangles, UNSIGNED_SHORT), "material": 0}
    weights = {"paint": {"Attribute": "Pin"}, "free": 0.5, "pinned": 0.5}
    distance = {"paint": {"Attribute": "Play"}, "at_zero": 0.01, "at_one": 0.5}
    cloth = [
        {"ClothFromMesh": {"weights": weights, "max_distance": distance}},
        {"ClothMaterial": {"area_density": 0.3, "bend_stiffness": 2e-5}},
    ]
    back = {"shape": {"Capsule": {"segment": {"a": [0.0, -0.3, 0.0], "b": [0.0, 0.3, 0.0]}, "radius": 0.15}}}
    file.write("cape.gltf", {
        "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {"name": "Root", "children": [1]},
            {
                "name": "Chest",
                "translation": [0.0, 1.2, 0.0],
                "extras": {"skein": [{"bevy_bunting::ClothCollider": back}]},
            },
            {"name": "Cape", "mesh": 0, "skin": 0},
        ],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": file.add(inverse)}],
        "meshes": [{"name": "CapeCloth", "primitives": [primitive], "extras": {"skein": cloth}}],
        "materials": [{
            "name": "Wool",
            "doubleSided": True,
            "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.15, 0.4, 1.0], "metallicFactor": 0.0},
        }],
    })


if __name__ == "__main__":
    flag()
    cape()
