#!/usr/bin/env python3
"""Writes furnished.glb: a furnished room as people build them, for looking at lightmaps. No object has UVs.

A floor of tiles of two sizes that touch, walls of slabs that touch and overlap at the corners, a window left open
between four of them, boards of 2 cm with books, thin legs, a rug of 1 cm, curved things with smooth normals, a bowl of
one sheet, and the usual carelessness: a box sunk into the floor, a picture half inside the wall, boards sunk into each
other. A sun, a glowing lamp and a camera; the sky is for the command that bakes it.
Needs nothing but Python 3: `python3 assets/scenes/furnished.py`.
"""
import math
import pathlib

from room import Glb, Mesh, ball, box, cross, looking, pbr, unit

TURN = 2 * math.pi


class Bare(Glb):
    """A file whose meshes have positions and normals, and nothing to lay a texture out by."""

    def __init__(self):
        super().__init__()
        self.json["asset"]["generator"] = "bevy_kiln assets/scenes/furnished.py"

    def mesh(self, name, mesh, material):
        attributes = {"POSITION": self.accessor(mesh.positions, bounds=True), "NORMAL": self.accessor(mesh.normals)}
        indices = self.accessor([[i] for i in mesh.indices], 5125)
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        return self.add("meshes", {"name": name, "primitives": [primitive]})


def surface(point, rows, columns, closed_rows=False, closed_columns=False):
    """A smooth sheet through point(u, v), both from 0 to 1. Its front is where u turned towards v winds to the left.
    Closed directions share the vertices of their ends."""
    mesh, eps = Mesh(), 1e-4
    high, wide = rows + (not closed_rows), columns + (not closed_columns)

    def normal(u, v):
        # Where a row shrinks to a point, the slope is that of a place nearby.
        u, v = min(max(u, 4 * eps), 1 - 4 * eps), min(max(v, 4 * eps), 1 - 4 * eps)
        a = [p - q for p, q in zip(point(u + eps, v), point(u - eps, v))]
        b = [p - q for p, q in zip(point(u, v + eps), point(u, v - eps))]
        return unit(cross(a, b))

    for i in range(high):
        for j in range(wide):
            mesh.positions.append(point(i / rows, j / columns))
            mesh.normals.append(normal(i / rows, j / columns))
    for i in range(rows):
        for j in range(columns):
            i2, j2 = (i + 1) % high, (j + 1) % wide
            a, b, c, d = i * wide + j, i2 * wide + j, i2 * wide + j2, i * wide + j2
            mesh.indices += [k for t in ((a, b, c), (a, c, d)) if has_area(mesh, t) for k in t]
    return mesh


def has_area(mesh, triangle):
    a, b, c = [mesh.positions[i] for i in triangle]
    n = cross([p - q for p, q in zip(b, a)], [p - q for p, q in zip(c, a)])
    return sum(x * x for x in n) > 1e-16


def lathe(centre, profile, rows, columns):
    """profile(u) says radius and height, from below to above on the outside."""
    def point(u, v):
        radius, height = profile(u)
        phi = TURN * v
        return [centre[0] + radius * math.cos(phi), centre[1] + height, centre[2] + radius * math.sin(phi)]
    return surface(point, rows, columns, closed_columns=True)


def sweep(path, section, rows, columns, closed=False):
    """path(v) says a place and two directions, section(u, v) how far to go along each."""
    def point(u, v):
        place, right, up = path(v)
        a, b = section(u, v)
        return [p + a * x + b * y for p, x, y in zip(place, right, up)]
    return surface(point, rows, columns, closed_rows=True, closed_columns=closed)


def capsule(centre, radius, height):
    arc, straight = math.pi / 2 * radius, height - 2 * radius
    length = 2 * arc + straight

    def profile(u):
        s = u * length
        if s < arc:
            return radius * math.sin(s / radius), radius - radius * math.cos(s / radius)
        if s > arc + straight:
            s = (length - s) / radius
            return radius * math.sin(s), height - radius + radius * math.cos(s)
        return radius, radius + s - arc
    return lathe(centre, profile, 24, 32)


def vase(centre):
    def profile(u):
        foot = min(1, u / 0.06)
        return foot * (0.055 + 0.035 * math.sin(TURN * 0.95 * u)), 0.26 * max(0, u - 0.06) / 0.94
    return lathe(centre, profile, 32, 32)


def bowl(centre):
    return lathe(centre, lambda u: (0.15 * math.sin(1.45 * u), 0.09 * (1 - math.cos(1.45 * u)) + 0.002), 16, 40)


def torus(centre, radius, thick):
    def path(v):
        c, s = math.cos(TURN * v), math.sin(TURN * v)
        return [centre[0] + radius * c, centre[1], centre[2] + radius * s], [c, 0, s], [0, 1, 0]
    return sweep(path, lambda u, _: (thick * math.cos(TURN * u), thick * math.sin(TURN * u)), 20, 48, closed=True)


def bent_pipe(start, up, along, bend, radius):
    """Up from the floor, round a bend and along the wall in +X."""
    arc = math.pi / 2 * bend
    length = up + arc + along

    def path(v):
        s = v * length
        x, y, z = start
        if s < up:
            return [x, y + s, z], [1, 0, 0], [0, 0, -1]
        angle = min((s - up) / bend, math.pi / 2)
        c, sine = math.cos(angle), math.sin(angle)
        rest = max(0, s - up - arc)
        place = [x + bend * (1 - c) + rest, y + up + bend * sine, z]
        return place, [c, -sine, 0], [0, 0, -1]
    return sweep(path, lambda u, _: (radius * math.cos(TURN * u), radius * math.sin(TURN * u)), 16, 48)


def power(x, e):
    return math.copysign(abs(x) ** e, x)


def tub(centre, radius, thick, height, facing):
    """The round back of an armchair: an upright oval, swept half around and rounded at both ends."""
    def path(v):
        angle = facing + math.pi * (0.5 - 0.5 * math.cos(math.pi * v)) - math.pi / 2
        c, s = math.cos(angle), math.sin(angle)
        return [centre[0] + radius * c, centre[1] + height, centre[2] + radius * s], [c, 0, s], [0, 1, 0]

    def section(u, v):
        end = min(1, math.sin(math.pi * v) / 0.35)
        end = math.sqrt(max(0, 1 - (1 - end) ** 2))
        c, s = math.cos(TURN * u), math.sin(TURN * u)
        return end * thick * power(c, 0.7), end * height * power(s, 0.7)
    return sweep(path, section, 32, 40)


def cushion(centre, size):
    """A ball on its way to a box."""
    def point(u, v):
        theta, phi = math.pi * (u - 0.5), TURN * v
        c = power(math.cos(theta), 0.5)
        p = [c * power(math.cos(phi), 0.5), power(math.sin(theta), 0.5), c * power(math.sin(phi), 0.5)]
        return [a + b * x for a, b, x in zip(centre, size, p)]
    return surface(point, 24, 40, closed_columns=True)


def build_shell(glb, plaster, paint, pale, dark):
    """Floor, walls and ceiling; the room itself is 6 m by 4 m and 2.8 m high."""
    large, small = [[glb.mesh(f"{size} m tile {n}", box([0, -0.1, 0], [size, 0, size]), look)
                     for n, look in enumerate((pale, dark))] for size in (1, 0.5)]
    for column in range(4):
        for row in range(4):
            glb.place(f"tile {column}.{row}", mesh=large[(column + row) % 2], translation=[column - 3, 0, row - 2])
    for column in range(4):
        for row in range(8):
            place = [1 + column / 2, 0, row / 2 - 2]
            glb.place(f"small tile {column}.{row}", mesh=small[(column + row) % 2], translation=place)
    # Slabs of 10 cm. Those along X run through at the corners, and so do those along Z.
    for name, z, look, cuts in [("back", -2.1, plaster, [-3.1, -1.3, 0.2, 1.7, 3.1]),
                                ("front", 2, plaster, [-3.1, -1, 1, 3.1])]:
        for n, (a, b) in enumerate(zip(cuts, cuts[1:])):
            glb.object(f"{name} wall {n}", box([a, -0.1, z], [b, 2.8, z + 0.1]), look)
    for n, (a, b) in enumerate([(-2.1, -0.7), (-0.7, 0.7), (0.7, 2.1)]):
        glb.object(f"right wall {n}", box([3, -0.1, a], [3.1, 2.8, b]), paint)
    around = [("sill", (-2.1, 2.1), (-0.1, 0.9)), ("lintel", (-2.1, 2.1), (2.3, 2.8)),
              ("left of window", (-2.1, -0.9), (0.9, 2.3)), ("right of window", (0.7, 2.1), (0.9, 2.3))]
    for name, (a, b), (y, Y) in around:
        glb.object(f"window wall {name}", box([-3.1, y, a], [-3, Y, b]), plaster)
    glb.object("ceiling", box([-3.1, 2.8, -2.1], [3.1, 2.9, 2.1]), plaster)


def build_shelves(glb, wood, covers):
    """Boards of 2 cm against the back wall, some only touching the sides, some sunk into them."""
    left, right = 0.5, 1.8
    for name, x in [("left", left), ("right", right - 0.02)]:
        glb.object(f"shelf side {name}", box([x, 0, -2], [x + 0.02, 1.9, -1.7]), wood)
    book = [glb.mesh(f"book {n}", box([0, 0, 0], [1, 1, 1]), cover) for n, cover in enumerate(covers)]
    drawn = 7
    for row in range(5):
        y, sunk = 0.08 + 0.43 * row, 0.01 * (row % 2)
        behind = 0.02 if row == 3 else 0  # One board goes 2 cm into the wall.
        board = box([left + 0.02 - sunk, y, -2 - behind], [right - 0.02 + sunk, y + 0.02, -1.7])
        glb.object(f"shelf {row}", board, wood)
        x = left + 0.02
        while row < 4 and x < left + 0.3 + 0.2 * row:
            drawn = (drawn * 1103515245 + 12345) % 2**31
            thick, high, deep = [low + (drawn >> shift & 15) / 15 * more
                                 for shift, low, more in ((8, 0.02, 0.04), (12, 0.2, 0.14), (16, 0.14, 0.1))]
            glb.place(f"book {row} at {x:.2f}", mesh=book[drawn >> 20 & 3], translation=[x, y + 0.02, -1.98],
                      scale=[thick, high, deep])
            x += thick


def build_table(glb, wood, china, metal):
    x, z = -0.9, 0.1
    glb.object("table top", box([x - 0.7, 0.72, z - 0.4], [x + 0.7, 0.75, z + 0.4]), wood)
    leg = glb.mesh("leg", box([-0.02, 0, -0.02], [0.02, 0.72, 0.02]), wood)
    for n, (a, b) in enumerate([(-0.66, -0.36), (0.66, -0.36), (-0.66, 0.36), (0.66, 0.36)]):
        glb.place(f"leg {n}", mesh=leg, translation=[x + a, -0.01 if n == 1 else 0, z + b])
    glb.object("ball", ball([x - 0.3, 0.85, z - 0.1], 0.1, 16), metal)
    glb.object("vase", vase([x + 0.45, 0.75, z - 0.15]), china)
    glb.object("bowl", bowl([x + 0.1, 0.75, z + 0.12]), china)


def main():
    glb = Bare()

    def plain(name, *colour, **fields):
        return glb.material(name, pbrMetallicRoughness=pbr(colour), **fields)

    plaster, paint = plain("plaster", 0.78, 0.76, 0.72), plain("paint", 0.42, 0.55, 0.6)
    pale, dark = plain("pale tile", 0.66, 0.6, 0.52), plain("dark tile", 0.45, 0.36, 0.3)
    wood, leather = plain("wood", 0.5, 0.33, 0.2), plain("leather", 0.55, 0.2, 0.14)
    wool, enamel = plain("wool", 0.3, 0.38, 0.5), plain("enamel", 0.72, 0.72, 0.68)
    china = plain("china", 0.7, 0.72, 0.75, doubleSided=True)
    covers = [plain(f"cover {n}", *c) for n, c in
              enumerate([(0.5, 0.16, 0.12), (0.15, 0.28, 0.4), (0.62, 0.55, 0.35), (0.2, 0.36, 0.22)])]
    strength = {"KHR_materials_emissive_strength": {"emissiveStrength": 3}}
    glow = plain("shade", 0.6, 0.6, 0.6, emissiveFactor=[1, 0.82, 0.6], extensions=strength)

    build_shell(glb, plaster, paint, pale, dark)
    build_shelves(glb, wood, covers)
    build_table(glb, wood, china, enamel)
    glb.object("rug", box([-1.9, 0, -0.7], [0.1, 0.01, 0.9]), wool)
    for name, low, high in [("mullion", [-3.07, 0.9, -0.12], [-3.03, 2.3, -0.08]),
                            ("transom", [-3.07, 1.58, -0.9], [-3.03, 1.62, 0.7])]:
        glb.object(name, box(low, high), enamel)
    glb.object("window board", box([-3.02, 0.88, -1.0], [-2.8, 0.9, 0.8]), wood)

    glb.object("column", lathe([-2.4, -0.02, -1.45], lambda u: (0.14, 2.84 * u), 24, 32), plaster)
    glb.object("pipe", bent_pipe([-2.9, -0.01, -1.88], 2.2, 3.0, 0.25, 0.04), enamel)
    glb.object("torus", torus([0.45, 0.08, 1.0], 0.26, 0.08), leather)
    glb.object("capsule", capsule([0.15, 0, -1.3], 0.16, 0.9), wool)
    glb.object("armchair back", tub([1.75, 0, 0.1], 0.42, 0.09, 0.38, 0.0), leather)
    glb.object("armchair seat", cushion([1.7, 0.24, 0.1], [0.36, 0.2, 0.36]), leather)
    glb.object("sunk box", box([-0.55, -0.03, -1.5], [-0.15, 0.37, -1.1]), enamel)
    glb.object("picture", box([-0.9, 1.25, -2.02], [-0.1, 1.85, -1.98]), covers[2])
    glb.object("chest", box([2.35, 0, -1.6], [3.02, 0.8, -0.5]), wood)
    glb.object("cord", lathe([-0.9, 2.0, 0.1], lambda u: (0.008, 0.82 * u), 2, 12), enamel)
    glb.object("lamp", ball([-0.9, 1.95, 0.1], 0.12, 12), glow)

    glb.light("sun", [-7, 5.4, 1.6], [-1.6, 0, 0.2], type="directional", color=[1, 0.95, 0.86], intensity=15000)
    perspective = {"yfov": 1.05, "znear": 0.05, "aspectRatio": 16 / 9}
    camera = glb.add("cameras", {"type": "perspective", "perspective": perspective})
    eye = [2.6, 1.75, 1.85]
    glb.place("camera", camera=camera, translation=eye, rotation=looking(eye, [-0.75, 0.75, -0.9]))
    glb.write(pathlib.Path(__file__).with_name("furnished.glb"))


if __name__ == "__main__":
    main()
