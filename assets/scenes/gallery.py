#!/usr/bin/env python3
"""Writes gallery.glb: a small museum, for what baked light is good at. No object has UVs for a lightmap.

A hall of 9 m by 6 m with two tall windows to the sun, and a cabinet beside it that only a doorway joins to the hall and
that has a lamp of its own. Panes of coloured glass stand in the sun and colour the floor; a glass ball, a golden knot
and a steel ball; a plant whose leaves are cut out by a mask; pictures in frames; one wall is red and shines on all that
is near. A sun, a lamp and a camera; the sky and the two rectangular lights at the ceiling, for which glTF has no words,
come from the example that shows it.
Needs nothing but Python 3: `python3 assets/scenes/gallery.py`.
"""
import math
import pathlib

from furnished import Bare, TURN, bowl, lathe, sweep
from room import FLOAT, Mesh, ball, box, looking, pbr, png, transmission, unit

HEIGHT = 3.6


class Textured(Bare):
    """Bare, but for UVs where there is a picture to lay out."""

    def __init__(self):
        super().__init__()
        self.json["asset"]["generator"] = "bevy_kiln assets/scenes/gallery.py"

    def object(self, name, mesh, material, **fields):
        index = self.mesh(name, mesh, material)
        if "baseColorTexture" in self.json["materials"][material]["pbrMetallicRoughness"]:
            self.json["meshes"][index]["primitives"][0]["attributes"]["TEXCOORD_0"] = self.accessor(mesh.uv0, FLOAT)
        self.place(name, mesh=index, **fields)


# The pictures.

def planks(x, y):
    """Four boards across, each with its own colour and its grain along v."""
    board, across = x // 16, x % 16
    if across == 0 or (y + 29 * board) % 64 == 0:
        return (62, 44, 30)
    tone = [0, 14, -9, 6][board] + [0, 5, -6][(7 * board + (y + 29 * board) // 64) % 3]
    grain = (across * across * 5 + 3 * board + y // 11) % 7 - 3
    return tuple(channel + tone + grain for channel in (156, 112, 74))


def leaf(x, y):
    """A pointed leaf on nothing, its tip up."""
    u, v = (x + 0.5) / 32 * 2 - 1, (y + 0.5) / 64
    wide = math.sin(math.pi * v) ** 0.8 * (0.55 + 0.35 * v)
    rib = abs(u) < 0.05 or abs(math.sin(9 * v + 2.2 * abs(u))) < 0.09
    return (86, 138, 60, 255 if abs(u) < wide else 0) if not rib else (120, 164, 82, 255 if abs(u) < wide else 0)


def mondrian(x, y):
    """Fields between black bars."""
    if any(bar <= x < bar + 2 for bar in (14, 47)) or any(bar <= y < bar + 2 for bar in (20, 41)):
        return (24, 24, 26)
    column, row = (x > 14) + (x > 47), (y > 20) + (y > 41)
    return {(1, 0): (186, 34, 28), (0, 2): (28, 58, 140), (2, 1): (226, 178, 30)}.get((column, row), (222, 216, 202))


def dusk(x, y):
    """A low sun over hills."""
    if (x - 40) ** 2 + (y - 24) ** 2 < 49:
        return (250, 214, 130)
    hills = [(34 + 4 * math.sin(x / 9), (92, 70, 96)), (42 + 5 * math.sin(x / 6 + 2), (58, 48, 74)),
             (51 + 3 * math.sin(x / 4 + 1), (34, 32, 52))]
    for height, colour in reversed(hills):
        if y > height:
            return colour
    t = y / 36
    return tuple(round(a + t * (b - a)) for a, b in zip((70, 92, 150), (232, 140, 96)))


def rings(x, y):
    """Circles about one another."""
    r = math.hypot(x - 31.5, y - 31.5)
    return [(226, 220, 204), (30, 92, 98), (224, 132, 52), (142, 30, 44)][int(r // 7) % 4]


# The shapes.

def wall_with_holes(span, depth, holes, along):
    """Boxes around holes in a wall from span[0] to span[1], `along` "x" or "z"; holes are (from, to, sill, lintel)."""
    parts, at = [], span[0]
    for a, b, sill, lintel in holes:
        parts += [(at, a, 0, HEIGHT), (a, b, 0, sill), (a, b, lintel, HEIGHT)]
        at = b
    parts.append((at, span[1], 0, HEIGHT))
    for a, b, low, high in parts:
        if b > a and high > low:
            yield box([a, low, depth[0]], [b, high, depth[1]]) if along == "x" else box([depth[0], low, a], [depth[1], high, b])


def knot(centre, size, thick):
    """A torus knot: twice around while it goes three times through."""
    def place(t):
        r = 1 + 0.42 * math.cos(3 * t)
        return [r * math.cos(2 * t), 0.5 * math.sin(3 * t), r * math.sin(2 * t)]

    def path(v):
        t = TURN * v
        here, ahead, behind = place(t), place(t + 1e-3), place(t - 1e-3)
        along = unit([a - b for a, b in zip(ahead, behind)])
        out = unit([here[0], 0, here[2]])
        dot = sum(a * b for a, b in zip(out, along))
        right = unit([a - dot * b for a, b in zip(out, along)])
        up = [along[1] * right[2] - along[2] * right[1], along[2] * right[0] - along[0] * right[2],
              along[0] * right[1] - along[1] * right[0]]
        # Upright, as it stands.
        turned = lambda a: [a[0], a[2], -a[1]]
        return [c + size * x for c, x in zip(centre, turned(here))], turned(right), turned([-x for x in up])

    def ring(u, _):
        return thick * math.cos(TURN * u), thick * math.sin(TURN * u)
    return sweep(path, ring, 14, 160, closed=True)


def pot(centre):
    """From inside the rim out and down to the foot, and over the earth."""
    profile = [(0.0, 0.0), (0.15, 0.0), (0.17, 0.03), (0.21, 0.36), (0.235, 0.38), (0.235, 0.42), (0.2, 0.42), (0.2, 0.37), (0.0, 0.36)]

    def at(u):
        s = u * (len(profile) - 1)
        i = min(int(s), len(profile) - 2)
        return [a + (s - i) * (b - a) for a, b in zip(profile[i], profile[i + 1])]
    return lathe(centre, at, 32, 32)


def leaves(centre, count):
    """Each two quads that follow a bent stalk, outwards and then down."""
    mesh, drawn = Mesh(), 11

    def random():
        nonlocal drawn
        drawn = (drawn * 1103515245 + 12345) % 2**31
        return (drawn >> 8 & 0xffff) / 0x10000
    for n in range(count):
        phi, steep = TURN * (n * 0.381966 + 0.05 * random()), 0.5 + 0.9 * n / count
        long, wide = 0.55 + 0.35 * random(), 0.09 + 0.04 * random()
        out, side = [math.cos(phi), 0, math.sin(phi)], [-math.sin(phi), 0, math.cos(phi)]
        spine = []
        for step in range(4):
            # From upright, ever more to the side.
            t = step / 3
            lean = (math.pi / 2 - steep) + 1.0 * t
            x = long * t * math.sin(lean) + 0.03
            y = 0.38 + long * (1.35 - 0.5 * n / count) * t * math.cos(0.75 * lean)
            spine.append([c + x * o + (y if axis == 1 else 0) for axis, (c, o) in enumerate(zip(centre, out))])
        for step in range(3):
            a, b = spine[step], spine[step + 1]
            v0, v1 = 1 - step / 3, 1 - (step + 1) / 3
            first = len(mesh.positions)
            for p, e, (u, v) in [(b, -1, (0, v1)), (a, -1, (0, v0)), (a, 1, (1, v0)), (b, 1, (1, v1))]:
                mesh.positions.append([q + e * wide * s for q, s in zip(p, side)])
                mesh.uv0.append([u, v])
            along = unit([p - q for p, q in zip(b, a)])
            normal = [side[1] * along[2] - side[2] * along[1], side[2] * along[0] - side[0] * along[2],
                      side[0] * along[1] - side[1] * along[0]]
            normal = [-x for x in normal] if normal[1] < 0 else normal
            mesh.normals += [normal] * 4
            mesh.indices += [first + i for i in (0, 1, 2, 0, 2, 3)]
    return mesh


def build_shell(glb, plaster, red, floor, stone):
    for name, low, high, look in [("hall floor", [-4.5, -3], [4.5, 3], floor), ("cabinet floor", [4.5, -1.8], [7.7, 1.8], stone)]:
        slab = Mesh().quad([low[0], 0, low[1]], [high[0] - low[0], 0, 0], [0, 0, high[1] - low[1]])
        glb.object(name, slab, look)
    glb.object("ceiling", box([-4.7, HEIGHT, -3.2], [7.9, HEIGHT + 0.2, 3.2]), plaster)
    glb.object("red wall", box([-4.7, 0, -3.2], [4.7, HEIGHT, -3]), red)
    glb.object("front wall", box([-4.7, 0, 3], [4.7, HEIGHT, 3.2]), plaster)
    windows = [(-2.2, -0.7, 0.5, 3.1), (0.7, 2.2, 0.5, 3.1)]
    for n, part in enumerate(wall_with_holes((-3, 3), (-4.7, -4.5), windows, "z")):
        glb.object(f"window wall {n}", part, plaster)
    for n, part in enumerate(wall_with_holes((-3, 3), (4.5, 4.7), [(-0.65, 0.65, 0, 2.3)], "z")):
        glb.object(f"door wall {n}", part, plaster)
    for name, low, high in [("back", [4.7, 0, -2], [7.9, HEIGHT, -1.8]), ("front", [4.7, 0, 1.8], [7.9, HEIGHT, 2]),
                            ("far", [7.7, 0, -1.8], [7.9, HEIGHT, 1.8])]:
        glb.object(f"cabinet wall {name}", box(low, high), plaster)


def main():
    glb = Textured()

    def plain(name, colour, metallic=0.0, roughness=0.9, **fields):
        return glb.material(name, pbrMetallicRoughness=pbr(colour, metallic, roughness), **fields)

    def picture(name, draw, size, roughness=0.8, **fields):
        extra = fields.pop("texture", {})
        texture = {"index": glb.texture(name, png(*size, draw)), **extra}
        look = pbr((1, 1, 1), 0, roughness, baseColorTexture=texture)
        return glb.material(name, pbrMetallicRoughness=look, **fields)

    glb.used.add("KHR_texture_transform")
    repeated = {"extensions": {"KHR_texture_transform": {"scale": [12, 3]}}}
    floor = picture("planks", planks, (64, 128), 0.55, texture=repeated)
    plaster, red = plain("plaster", (0.76, 0.74, 0.7)), plain("red paint", (0.5, 0.15, 0.12))
    stone, white = plain("stone", (0.42, 0.42, 0.4)), plain("white", (0.8, 0.8, 0.78))
    black, wood = plain("black frame", (0.04, 0.04, 0.04), 0, 0.5), plain("oak", (0.36, 0.22, 0.12), 0, 0.6)
    enamel, clay = plain("enamel", (0.7, 0.7, 0.68), 0, 0.5), plain("clay", (0.5, 0.26, 0.17))
    gold, steel = plain("gold", (1, 0.71, 0.29), 1, 0.28), plain("steel", (0.66, 0.66, 0.68), 1, 0.35)
    body = transmission(thicknessFactor=0.5, attenuationColor=[0.75, 0.92, 0.85], attenuationDistance=0.7)
    glass = plain("glass", (1, 1, 1), 0, 0.0, extensions=body)
    foliage = picture("leaf", leaf, (32, 64), 0.7, alphaMode="MASK", alphaCutoff=0.5, doubleSided=True)

    build_shell(glb, plaster, red, floor, stone)
    for n, z in enumerate((-1.45, 1.45)):
        for m, y in enumerate((1.35, 2.2)):
            glb.object(f"transom {n}.{m}", box([-4.62, y, z - 0.75], [-4.58, y + 0.05, z + 0.75]), enamel)
        glb.object(f"mullion {n}", box([-4.62, 0.5, z - 0.02], [-4.58, 3.1, z + 0.02]), enamel)
        glb.object(f"window board {n}", box([-4.52, 0.46, z - 0.85], [-4.3, 0.5, z + 0.85]), white)

    # Coloured panes on a low base, across the sun's way.
    glb.object("pane base", box([-2.55, 0, -0.25], [-2.25, 0.12, 1.95]), black)
    panes = [("red", (0.95, 0.12, 0.1)), ("amber", (1, 0.62, 0.08)), ("blue", (0.12, 0.32, 0.95))]
    for n, (name, colour) in enumerate(panes):
        look = plain(f"{name} glass", colour, 0, 0.0, doubleSided=True, extensions=transmission())
        z = -0.2 + 0.72 * n
        glb.object(f"{name} pane", Mesh().quad([-2.4, 1.72 - 0.25 * n, z], [0, 0, 0.66], [0, -1.6 + 0.25 * n, 0]), look)

    # Plinths and what they carry.
    for name, x, z, half, high in [("knot", 0.6, -1.5, 0.28, 0.95), ("glass", 2.6, -1.2, 0.24, 1.05),
                                   ("steel", -3.5, 2.3, 0.24, 0.8), ("bowl", 6.4, 0.0, 0.28, 0.95)]:
        glb.object(f"{name} plinth", box([x - half, 0, z - half], [x + half, high, z + half]), white)
    glb.object("golden knot", knot([0.6, 1.38, -1.5], 0.25, 0.06), gold)
    glb.object("glass ball", ball([2.6, 1.05 + 0.2, -1.2], 0.2, 24), glass)
    glb.object("steel ball", ball([-3.5, 1.0, 2.3], 0.2, 24), steel)
    glb.object("bowl", bowl([6.4, 0.95, 0.0]), plain("china", (0.25, 0.42, 0.6), 0, 0.4, doubleSided=True))

    # A bench, a plant.
    glb.object("bench seat", box([-0.9, 0.4, 0.75], [1.3, 0.48, 1.25]), wood)
    for n, x in enumerate((-0.8, 1.14)):
        glb.object(f"bench leg {n}", box([x, 0, 0.8], [x + 0.06, 0.4, 1.2]), black)
    plant = [-3.7, 0, -2.35]
    glb.object("pot", pot(plant), clay)
    glb.object("leaves", leaves(plant, 34), foliage)

    # Pictures: a frame and a canvas 1 cm before it.
    for name, draw, x, wide, high in [("mondrian", mondrian, -2.3, 1.3, 1.3), ("dusk", dusk, 0.6, 1.8, 1.2), ("rings", rings, 3.2, 1.1, 1.1)]:
        glb.object(f"frame of {name}", box([x - wide / 2 - 0.05, 1.75 - high / 2 - 0.05, -3.01],
                                           [x + wide / 2 + 0.05, 1.75 + high / 2 + 0.05, -2.96]), black)
        canvas = Mesh().quad([x - wide / 2, 1.75 + high / 2, -2.95], [wide, 0, 0], [0, -high, 0])
        glb.object(name, canvas, picture(name, draw, (64, 64)))

    # Above the two lights of the hall.
    for n, x in enumerate((-1.5, 2.0)):
        glb.object(f"light housing {n}", box([x - 0.95, HEIGHT - 0.1, -0.25], [x + 0.95, HEIGHT, 0.25]), black)

    glb.light("sun", [-7.5, 4.5, 2.4], [-0.5, 0, 0.2], type="directional", color=[1, 0.94, 0.84], intensity=36000)
    glb.light("cabinet lamp", [6.4, 2.6, 0.0], [6.4, 0, 0], type="point", color=[1, 0.72, 0.42], intensity=1200)
    perspective = {"yfov": 0.96, "znear": 0.05, "aspectRatio": 16 / 9}
    camera = glb.add("cameras", {"type": "perspective", "perspective": perspective})
    eye = [4.1, 1.72, 2.7]
    glb.place("camera", camera=camera, translation=eye, rotation=looking(eye, [-0.9, 1.15, -1.6]))
    glb.write(pathlib.Path(__file__).with_name("gallery.glb"))


if __name__ == "__main__":
    main()
