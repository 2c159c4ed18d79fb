#!/usr/bin/env python3
"""Writes cornell_box.glb: the Cornell box in metres, with a UV1 of its own for every object.

Geometry: Cornell University Program of Computer Graphics, "Cornell Box Data" (measured; 1 unit = 1 cm here). Colours:
linear Rec. 709, rounded. The lamp's emission is in nits. Needs nothing but Python 3:
`python3 assets/scenes/cornell_box.py`.
"""
import json
import math
import pathlib
import struct

WHITE, RED, GREEN, LAMP = range(4)
MARGIN = 0.02  # Empty border of each chart of a block, in shares of the unit square.
UNIT = [[0, 1], [1, 1], [1, 0], [0, 0]]


def normal(a, b, c):
    u, v = ([x - y for x, y in zip(p, a)] for p in (b, c))
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(x * x for x in n))
    return [x / length for x in n]


class Mesh:
    def __init__(self):
        self.positions, self.normals, self.uv1, self.indices = [], [], [], []

    def quad(self, corners, uv):
        """Corners counter-clockwise seen from the front, each with its UV1 (or None for a mesh without one)."""
        first = len(self.positions)
        n, m = normal(*corners[:3]), normal(corners[0], corners[2], corners[3])
        # The red wall's corners lie in no plane: it is two triangles with a normal each.
        flat = sum(abs(x - y) for x, y in zip(n, m)) < 1e-9
        for place, index in enumerate([0, 1, 2, 3] if flat else [0, 1, 2, 0, 2, 3]):
            self.positions.append([x / 100 for x in corners[index]])
            self.normals.append(n if flat or place < 3 else m)
            if uv:
                self.uv1.append(uv[index])
        self.indices += [first + i for i in ([0, 1, 2, 0, 2, 3] if flat else range(6))]
        return self


def chart(cell):
    """The four corners of a cell of a 3 × 2 grid over the unit square, less its margin."""
    u, v = cell % 3 / 3, cell // 3 / 2
    low_u, high_u, low_v, high_v = u + MARGIN, u + 1 / 3 - MARGIN, v + MARGIN, v + 1 / 2 - MARGIN
    return [[low_u, high_v], [high_u, high_v], [high_u, low_v], [low_u, low_v]]


def block(base, height):
    """A block without a bottom, from the corners of its base, counter-clockwise seen from above."""
    mesh = Mesh().quad([[x, height, z] for x, z in base], chart(0))
    for side in range(4):
        (x0, z0), (x1, z1) = base[side], base[(side + 1) % 4]
        mesh.quad([[x0, 0, z0], [x1, 0, z1], [x1, height, z1], [x0, height, z0]], chart(side + 1))
    return mesh


def ceiling():
    """A frame around the lamp; its UV1 is its plan."""
    mesh, xs, zs = Mesh(), [0, 213, 343, 556], [0, 227, 332, 559.2]
    for i in range(3):
        for j in range(3):
            if (i, j) != (1, 1):
                plan = [(xs[i], zs[j]), (xs[i + 1], zs[j]), (xs[i + 1], zs[j + 1]), (xs[i], zs[j + 1])]
                mesh.quad([[x, 548.8, z] for x, z in plan], [[x / 556, z / 559.2] for x, z in plan])
    return mesh


OBJECTS = [
    ("floor", WHITE, Mesh().quad([[552.8, 0, 0], [0, 0, 0], [0, 0, 559.2], [549.6, 0, 559.2]], UNIT)),
    ("ceiling", WHITE, ceiling()),
    ("back_wall", WHITE, Mesh().quad([[549.6, 0, 559.2], [0, 0, 559.2], [0, 548.8, 559.2], [556, 548.8, 559.2]], UNIT)),
    ("green_wall", GREEN, Mesh().quad([[0, 0, 559.2], [0, 0, 0], [0, 548.8, 0], [0, 548.8, 559.2]], UNIT)),
    ("red_wall", RED, Mesh().quad([[552.8, 0, 0], [549.6, 0, 559.2], [556, 548.8, 559.2], [556, 548.8, 0]], UNIT)),
    ("short_block", WHITE, block([(130, 65), (82, 225), (240, 272), (290, 114)], 165)),
    ("tall_block", WHITE, block([(423, 247), (265, 296), (314, 456), (472, 406)], 330)),
    ("lamp", LAMP, Mesh().quad([[213, 548.8, 227], [343, 548.8, 227], [343, 548.8, 332], [213, 548.8, 332]], None)),
]


def material(name, colour, emission=None):
    entry = {
        "name": name,
        "pbrMetallicRoughness": {"baseColorFactor": colour + [1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}},
    }
    if emission:
        entry["emissiveFactor"] = [x / max(emission) for x in emission]
        entry["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": max(emission)}
    return entry


class Gltf:
    def __init__(self):
        self.buffer, self.views, self.accessors = b"", [], []

    def accessor(self, rows, kind):
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[kind]
        flat = [x for row in rows for x in (row if width > 1 else [row])]
        code, component, target = ("H", 5123, 34963) if width == 1 else ("f", 5126, 34962)
        data = struct.pack("<%d%s" % (len(flat), code), *flat)
        self.views.append({"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data), "target": target})
        entry = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows), "type": kind}
        if kind == "VEC3":
            columns = list(zip(*(struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows)))
            entry.update(min=[min(c) for c in columns], max=[max(c) for c in columns])
        self.accessors.append(entry)
        self.buffer += data + b"\0" * (-len(data) % 4)
        return len(self.accessors) - 1


def main():
    gltf, meshes, nodes = Gltf(), [], []
    for name, material_index, mesh in OBJECTS:
        attributes = {"POSITION": gltf.accessor(mesh.positions, "VEC3"), "NORMAL": gltf.accessor(mesh.normals, "VEC3")}
        if mesh.uv1:
            # Set 1 may not stand alone.
            attributes["TEXCOORD_0"] = attributes["TEXCOORD_1"] = gltf.accessor(mesh.uv1, "VEC2")
        primitive = {"attributes": attributes, "indices": gltf.accessor(mesh.indices, "SCALAR"), "material": material_index}
        meshes.append({"name": name, "primitives": [primitive]})
        nodes.append({"name": name, "mesh": len(meshes) - 1})
    # The published view: from (278, 273, −800) along +z, focal length 35 mm, film 25 mm high.
    nodes.append({"name": "camera", "camera": 0, "translation": [2.78, 2.73, -8.0], "rotation": [0, 1, 0, 0]})
    perspective = {"yfov": 2 * math.atan(0.0125 / 0.035), "znear": 0.1, "zfar": 100.0, "aspectRatio": 1.0}
    text = json.dumps(
        {
            "asset": {"version": "2.0", "generator": "cornell_box.py"},
            "extensionsUsed": ["KHR_materials_specular", "KHR_materials_emissive_strength"],
            "scene": 0,
            "scenes": [{"name": "cornell_box", "nodes": list(range(len(nodes)))}],
            "nodes": nodes,
            "meshes": meshes,
            "cameras": [{"name": "camera", "type": "perspective", "perspective": perspective}],
            "materials": [
                material("white", [0.73, 0.73, 0.73]),
                material("red", [0.65, 0.05, 0.05]),
                material("green", [0.12, 0.45, 0.15]),
                material("lamp", [0.0, 0.0, 0.0], [17.0, 12.0, 4.0]),
            ],
            "accessors": gltf.accessors,
            "bufferViews": gltf.views,
            "buffers": [{"byteLength": len(gltf.buffer)}],
        },
        separators=(",", ":"),
    ).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    chunks += struct.pack("<II", len(gltf.buffer), 0x004E4942) + gltf.buffer
    header = struct.pack("<III", 0x46546C67, 2, 12 + len(chunks))
    pathlib.Path(__file__).with_suffix(".glb").write_bytes(header + chunks)


main()
