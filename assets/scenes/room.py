#!/usr/bin/env python3
"""Writes room.glb: a room with one of everything that a glTF file can say about surfaces and lights.

A floor with a repeated texture, a wall with a normal map, metal, rough plastic, a clear coat, a glass ball, a tinted
pane, a fence cut by a mask, a see-through curtain, a glowing sign, vertex colours, a mirrored copy; a sun, a lamp, a
spot light and a camera. Its pictures are drawn here, texel by texel. Every object has a UV1 of its own.
Needs nothing but Python 3: `python3 assets/scenes/room.py`.
"""
import json
import math
import pathlib
import struct
import zlib

FLOAT, UINT = 5126, 5125
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


def png(width, height, texel):
    """A PNG of 8 bits a channel, of what texel(column, row) says: three or four numbers from 0 to 255."""
    texels = [[texel(x, y) for x in range(width)] for y in range(height)]
    colour = 6 if len(texels[0][0]) == 4 else 2
    rows = b"".join(b"\0" + bytes(channel for t in row for channel in t) for row in texels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, colour, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


class Mesh:
    """Triangles with everything that a vertex may have."""

    def __init__(self):
        self.positions, self.normals, self.uv0, self.uv1, self.colours, self.indices = [], [], [], [], [], []

    def quad(self, corner, u, v, size=(1, 1), chart=(0, 0, 1, 1)):
        """From its top left corner along u to the right and v down, seen from the front. UV0 runs from (0, 0) at that
        corner to `size`; `chart` is its rectangle in UV1: left, top, right, bottom."""
        first, n = len(self.positions), unit(cross(v, u))
        for s, t in [(0, 0), (0, 1), (1, 1), (1, 0)]:
            self.positions.append([c + s * a + t * b for c, a, b in zip(corner, u, v)])
            self.normals.append(n)
            self.uv0.append([s * size[0], t * size[1]])
            self.uv1.append([chart[0] + s * (chart[2] - chart[0]), chart[1] + t * (chart[3] - chart[1])])
        self.indices += [first + i for i in (0, 1, 2, 0, 2, 3)]
        return self

    def colour(self, of_position):
        self.colours = [of_position(p) for p in self.positions]
        return self


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def box(low, high):
    """Six faces, their charts in a grid of 3 × 2."""
    (x, y, z), (X, Y, Z) = low, high
    w, h, d = X - x, Y - y, Z - z
    faces = [
        ([x, Y, Z], [w, 0, 0], [0, -h, 0]), ([X, Y, z], [-w, 0, 0], [0, -h, 0]),
        ([x, Y, z], [0, 0, d], [0, -h, 0]), ([X, Y, Z], [0, 0, -d], [0, -h, 0]),
        ([x, Y, z], [w, 0, 0], [0, 0, d]), ([x, y, Z], [w, 0, 0], [0, 0, -d]),
    ]
    mesh, margin = Mesh(), 0.02
    for face, (corner, u, v) in enumerate(faces):
        left, top = face % 3 / 3, face // 3 / 2
        mesh.quad(corner, u, v, chart=(left + margin, top + margin, left + 1 / 3 - margin, top + 1 / 2 - margin))
    return mesh


def ball(centre, radius, rings=32):
    """A sphere with smooth normals, by longitude and latitude."""
    mesh, around = Mesh(), 2 * rings
    for row in range(rings + 1):
        for column in range(around + 1):
            theta, phi = math.pi * row / rings, 2 * math.pi * column / around
            n = [math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi)]
            mesh.positions.append([c + radius * x for c, x in zip(centre, n)])
            mesh.normals.append(n)
            mesh.uv0.append([column / around, row / rings])
            mesh.uv1.append([column / around, row / rings])
    for row in range(rings):
        for column in range(around):
            a = row * (around + 1) + column
            b = a + around + 1
            # At a pole one of a cell's two triangles has no area.
            mesh.indices += [a, b, b + 1] if row < rings - 1 else []
            mesh.indices += [a, b + 1, a + 1] if row > 0 else []
    return mesh


class Glb:
    """A glTF file in the making."""

    def __init__(self):
        self.data, self.used = bytearray(), set()
        self.json = {
            "asset": {"version": "2.0", "generator": "bevy_kiln assets/scenes/room.py"}, "scene": 0,
            "scenes": [{"nodes": []}], "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": [],
            "images": [], "textures": [], "samplers": [{"magFilter": 9729, "minFilter": 9987}], "cameras": [],
        }

    def add(self, what, thing):
        self.json[what].append(thing)
        return len(self.json[what]) - 1

    def view(self, data):
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        self.data += data
        return self.add("bufferViews", view)

    def accessor(self, rows, component=FLOAT, bounds=False):
        flat = [x for row in rows for x in row]
        data = struct.pack(f"<{len(flat)}{'f' if component == FLOAT else 'I'}", *flat)
        accessor = {"bufferView": self.view(data), "componentType": component, "count": len(rows)}
        accessor["type"] = KINDS[len(rows[0])]
        if bounds:
            single = [struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows]
            accessor["min"], accessor["max"] = [[f(c) for c in zip(*single)] for f in (min, max)]
        return self.add("accessors", accessor)

    def texture(self, name, data):
        image = self.add("images", {"name": name, "mimeType": "image/png", "bufferView": self.view(data)})
        return self.add("textures", {"sampler": 0, "source": image})

    def material(self, name, **fields):
        self.used.update(fields.get("extensions", {}))
        fields.setdefault("pbrMetallicRoughness", {"metallicFactor": 0})
        return self.add("materials", {"name": name, **fields})

    def mesh(self, name, mesh, material):
        attributes = {"POSITION": self.accessor(mesh.positions, bounds=True), "NORMAL": self.accessor(mesh.normals)}
        attributes["TEXCOORD_0"], attributes["TEXCOORD_1"] = self.accessor(mesh.uv0), self.accessor(mesh.uv1)
        if mesh.colours:
            attributes["COLOR_0"] = self.accessor(mesh.colours)
        indices = self.accessor([[i] for i in mesh.indices], UINT)
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def place(self, name, **fields):
        self.json["scenes"][0]["nodes"].append(self.add("nodes", {"name": name, **fields}))

    def object(self, name, mesh, material, **fields):
        self.place(name, mesh=self.mesh(name, mesh, material), **fields)

    def light(self, name, translation, target, **fields):
        """A light that shines along its -Z, towards the target."""
        self.used.add("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append({"name": name, **fields})
        extensions = {"KHR_lights_punctual": {"light": len(lights) - 1}}
        self.place(name, translation=translation, rotation=looking(translation, target), extensions=extensions)

    def write(self, path):
        self.data += b"\0" * (-len(self.data) % 4)
        self.json["buffers"] = [{"byteLength": len(self.data)}]
        self.json["extensionsUsed"] = sorted(self.used)
        used = {key: value for key, value in self.json.items() if value != []}
        text = json.dumps(used, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.data))
        chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(self.data), b"BIN\0")
        pathlib.Path(path).write_bytes(head + chunks + self.data)


def looking(eye, target):
    """The rotation (x, y, z, w) that turns -Z from the eye to the target, +Y staying up: yaw, then pitch."""
    x, y, z = unit([b - a for a, b in zip(eye, target)])
    yaw, pitch = math.atan2(-x, -z) / 2, math.asin(y) / 2
    (sy, cy), (sp, cp) = [(math.sin(a), math.cos(a)) for a in (yaw, pitch)]
    return [cy * sp, sy * cp, -sy * sp, cy * cp]


# The pictures.

GLYPHS = {  # Seven rows of five, a letter's rows joined.
    "K": "10001100101010011000101001001010001", "I": "01110001000010000100001000010001110",
    "L": "10000100001000010000100001000011111", "N": "10001110011010110011100011000110001",
}


def sign(x, y):
    letter, column, row = x // 8, x % 8 - 2, y - 3
    lit = 0 <= column < 5 and 0 <= row < 7 and letter < 4 and GLYPHS["KILN"[letter]][5 * row + column] == "1"
    return (255, 150, 40) if lit else (20, 4, 0)


def tiles(x, y):
    """Four tiles, no two alike, with joints."""
    if x % 32 in (0, 31) or y % 32 in (0, 31):
        return (90, 85, 80)
    grain = (x * 7 + y * 13 + x * y) % 9
    base = [(205, 190, 170), (120, 85, 65), (120, 85, 65), (165, 130, 100)][x // 32 + 2 * (y // 32)]
    return tuple(channel + grain for channel in base)


def bricks(x, y):
    """The normals of rounded bricks, two courses: +X to the right and +Y up in the picture."""
    row = y // 16
    s, t = (x + 16 * (row % 2)) % 32, y % 16
    tilt_x = -0.8 if s < 3 else 0.8 if s > 28 else 0
    tilt_y = 0.8 if t < 3 else -0.8 if t > 12 else 0
    return tuple(round(127.5 + 127.5 * c) for c in unit([tilt_x, tilt_y, 1]))


def fence(x, y):
    """Diamonds of wire on nothing."""
    wire = (x + y) % 16 < 3 or (x - y) % 16 < 3
    return (60, 70, 60, 255 if wire else 0)


def pbr(colour, metallic=0.0, roughness=0.9, **more):
    colour = [*colour, 1][:4]
    return {"baseColorFactor": colour, "metallicFactor": metallic, "roughnessFactor": roughness, **more}


def transmission(**volume):
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.5}}
    return {**extensions, "KHR_materials_volume": volume} if volume else extensions


def main():
    glb = Glb()

    def plain(name, *looks, **fields):
        return glb.material(name, pbrMetallicRoughness=pbr(*looks), **fields)

    glb.used.add("KHR_texture_transform")
    repeated = {"KHR_texture_transform": {"scale": [4, 3.2]}}
    tiled = {"index": glb.texture("tiles", png(64, 64, tiles)), "extensions": repeated}
    floor = glb.material("tiles", pbrMetallicRoughness=pbr((1, 1, 1), 0, 0.5, baseColorTexture=tiled))
    relief = {"index": glb.texture("bricks", png(32, 32, bricks))}
    brick = plain("bricks", (0.7, 0.36, 0.26), 0, 0.8, normalTexture=relief)
    plaster = plain("plaster", (0.75, 0.73, 0.7))
    glowing = {"index": glb.texture("sign", png(32, 13, sign))}
    strength = {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}
    neon = plain("neon", (0.02, 0.02, 0.02), emissiveFactor=[1, 1, 1], emissiveTexture=glowing, extensions=strength)
    wire = {"index": glb.texture("fence", png(64, 32, fence))}
    mesh_wire = glb.material("wire", pbrMetallicRoughness=pbr((1, 1, 1), 0, 0.7, baseColorTexture=wire),
                             alphaMode="MASK", alphaCutoff=0.5, doubleSided=True)
    voile = plain("voile", (0.8, 0.25, 0.3, 0.55), alphaMode="BLEND", doubleSided=True)
    body = transmission(thicknessFactor=0.6, attenuationColor=[0.6, 0.9, 0.7], attenuationDistance=0.6)
    glass = plain("glass", (1, 1, 1), 0, 0.0, extensions=body)
    pane = plain("tinted pane", (0.6, 0.8, 1), 0, 0.0, extensions=transmission())
    lacquer = plain("lacquer", (0.6, 0.03, 0.03), 0, 0.7, extensions={
        "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.03}})
    gold, steel = plain("gold", (1, 0.71, 0.29), 1, 0.15), plain("brushed steel", (0.7, 0.7, 0.72), 1, 0.45)
    plastic, paint = plain("rough plastic", (0.1, 0.25, 0.6), 0, 0.6), plain("vertex colours", (1, 1, 1))

    # The room: 5 m by 4 m and 2.8 m high, with a window in its left wall.
    glb.object("floor", Mesh().quad([-2.5, 0, -2], [5, 0, 0], [0, 0, 4]), floor)
    glb.object("ceiling", Mesh().quad([-2.5, 2.8, 2], [5, 0, 0], [0, 0, -4]), plaster)
    glb.object("back wall", Mesh().quad([-2.5, 2.8, -2], [5, 0, 0], [0, -2.8, 0], (10, 11.2)), brick)
    glb.object("front wall", Mesh().quad([2.5, 2.8, 2], [-5, 0, 0], [0, -2.8, 0]), plaster)
    glb.object("right wall", Mesh().quad([2.5, 2.8, -2], [0, 0, 4], [0, -2.8, 0]), plaster)
    left = Mesh()  # Around a hole: z from -0.8 to 1, y from 0.8 to 2.4.
    for z, y, depth, height in [(2, 2.8, 4, 0.4), (2, 0.8, 4, 0.8), (2, 2.4, 1, 1.6), (-0.8, 2.4, 1.2, 1.6)]:
        a, b = (2 - z) / 4, (2.8 - y) / 2.8
        left.quad([-2.5, y, z], [0, 0, -depth], [0, -height, 0], chart=(a, b, a + depth / 4, b + height / 2.8))
    glb.object("left wall", left, plaster)
    glb.object("pane", Mesh().quad([-2.5, 2.4, 1], [0, 0, -1.8], [0, -1.6, 0]), pane)
    glb.object("curtain", Mesh().quad([-2.4, 2.5, -0.1], [0, 0, -0.9], [0, -2.3, 0]), voile)

    glb.object("sign", Mesh().quad([-1.0, 2.35, -1.98], [2.0, 0, 0], [0, -0.8, 0]), neon)
    glb.object("fence", Mesh().quad([1.1, 0.9, -0.6], [1.3, 0, -0.5], [0, -0.9, 0]), mesh_wire)
    glb.object("glass ball", ball([0.3, 0.35, 0.55], 0.35), glass)
    glb.object("gold ball", ball([-0.55, 0.4, -0.4], 0.4), gold)
    glb.object("steel box", box([-1.9, 0, -1.6], [-1.2, 1.1, -0.9]), steel)
    glb.object("lacquered ball", ball([1.25, 0.3, 0.1], 0.3), lacquer)
    glb.object("plastic box", box([0.2, 0, -1.3], [0.9, 0.7, -0.7]), plastic)
    wedge = box([-0.3, 0, -0.15], [0.3, 0.3, 0.15]).colour(lambda p: [0.5 + p[0] / 0.7, 0.2, 0.5 - p[0] / 0.7, 1])
    wedge = glb.mesh("painted brick", wedge, paint)
    glb.place("painted brick", mesh=wedge, translation=[-1.35, 0, 0.5], rotation=looking([0, 0, 0], [-0.5, 0, -1]))
    glb.place("mirrored brick", mesh=wedge, translation=[-1.3, 0.3, 0.5], scale=[-0.8, 1, 1])

    glb.light("sun", [-6, 6, 2], [-1.2, 0, -0.2], type="directional", color=[1, 0.95, 0.85], intensity=12000)
    glb.light("lamp", [0.9, 2.6, 0.3], [0.9, 0, 0.3], type="point", color=[1, 0.93, 0.8], intensity=1500)
    spot = {"innerConeAngle": 0.15, "outerConeAngle": 0.35}
    glb.light("spot", [-0.2, 2.7, 1.2], [-0.55, 0.4, -0.4], type="spot", color=[1, 1, 1], intensity=4000, spot=spot)
    perspective = {"yfov": 1.2, "znear": 0.1, "aspectRatio": 4 / 3}
    camera = glb.add("cameras", {"type": "perspective", "perspective": perspective})
    eye = [0.4, 1.6, 1.97]
    glb.place("camera", camera=camera, translation=eye, rotation=looking(eye, [-0.05, 0.85, -1]))
    glb.write(pathlib.Path(__file__).with_name("room.glb"))


if __name__ == "__main__":
    main()
