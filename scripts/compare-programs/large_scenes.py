#!/usr/bin/env python3
"""Writes scenes of many primitives, 800 x 600, one ray a pixel. The bytes are always the same.

    large_scenes.py FOLDER [KIND[=N] ...]     (default: flake cloud=100000 bumpy=100000)

    flake[=DEPTH]    spheres on spheres over a mirror floor, 2 lights, 4 reflections; 937 at depth 4
    cloud=N          N matte spheres in a cube, 1 light; they fill the image equally for every N
    bumpy=N          a bumpy sphere of about N triangles, read from an OBJ file beside it, 1 light

A file's name is its kind and number: cloud-1000.toml, bumpy-1000.toml with bumpy-1000.obj.
"""

import math
import os
import random
import sys

DEFAULT = {"flake": 4, "cloud": 100_000, "bumpy": 100_000}

HEAD = """\
# {comment}
# Written by large_scenes.py.

[image]
width = 800
height = 600

[camera]
position = {position}
look_at = {look_at}
up = [0.0, 1.0, 0.0]
focal_length = 1.0
screen_width = {screen_width}

[render]
background = {background}
max_reflections = {reflections}
antialiasing = 0
"""

MATERIAL = """
[material.{name}]
color = {color}
ambient = 0.1
diffuse = {diffuse}
specular = {specular}
shininess = {shininess}
reflection = {reflection}
"""


def vector(values):
    """Formats a vector with few digits, so that every program reads the same scene."""
    return "[" + ", ".join(repr(round(float(v), 7) + 0.0) for v in values) + "]"


def light(position, power):
    return f"\n[[light]]\nposition = {vector(position)}\npower = {power}\n"


def sphere(center, radius, material):
    return f'\n[[sphere]]\ncenter = {vector(center)}\nradius = {round(radius, 7)!r}\nmaterial = "{material}"\n'


def flake(path, depth):
    """Each sphere carries six of 0.4 its radius on the axes, except where it touches its parent."""
    parts = []

    def grow(center, radius, level, back):
        parts.append(sphere(center, radius, f"level{level % 5}"))
        if level == depth:
            return
        for axis in range(3):
            for sign in (1, -1):
                if (axis, sign) != back:
                    child = list(center)
                    child[axis] += sign * 1.4 * radius
                    grow(child, 0.4 * radius, level + 1, (axis, -sign))

    grow((0.0, 0.0, 0.0), 1.0, 0, None)
    with open(path + ".toml", "w", encoding="ascii", newline="\n") as out:
        out.write(HEAD.format(
            comment=f"Sphere flake of {len(parts)} spheres over a mirroring floor.",
            position=vector((-9, 8, 17)), look_at=vector((0, -0.15, 0)), screen_width=0.32,
            background=vector((0.1, 0.1, 0.15)), reflections=4))
        out.write(light((-50, 68, 50), 0.9) + light((40, 40, 30), 0.6))
        out.write(MATERIAL.format(name="floor", color=vector((0.3, 0.5, 0.7)), diffuse=0.8, specular=0.2,
                                  shininess=80, reflection=0.3))
        colors = [(0.85, 0.85, 0.9), (0.9, 0.7, 0.3), (0.8, 0.3, 0.2), (0.3, 0.7, 0.3), (0.3, 0.4, 0.9)]
        for level, color in enumerate(colors):
            out.write(MATERIAL.format(name=f"level{level}", color=vector(color), diffuse=0.7, specular=0.5,
                                      shininess=50, reflection=0.4))
        out.write('\n[[plane]]\npoint = [0.0, -2.3, 0.0]\nnormal = [0.0, 1.0, 0.0]\nmaterial = "floor"\n')
        out.writelines(parts)


def cloud(path, count):
    """The radius falls as the number grows, so a ray meets equally many spheres in every cloud."""
    generator = random.Random(count)
    mean = 0.1 * math.sqrt(100_000 / count)
    with open(path + ".toml", "w", encoding="ascii", newline="\n") as out:
        out.write(HEAD.format(
            comment=f"A cloud of {count} matte spheres in a cube.",
            position=vector((0, 0, 26)), look_at=vector((0, 0, 0)), screen_width=1.2,
            background=vector((0, 0, 0)), reflections=0))
        out.write(light((20, 30, 30), 1.0))
        for i in range(8):
            color = [generator.uniform(0.3, 0.9) for _ in range(3)]
            out.write(MATERIAL.format(name=f"m{i}", color=vector(color), diffuse=0.8, specular=0.4, shininess=32,
                                      reflection=0.0))
        for _ in range(count):
            center = [generator.uniform(-10, 10) for _ in range(3)]
            out.write(sphere(center, mean * generator.uniform(0.5, 1.5), f"m{generator.randrange(8)}"))


def bumpy(path, count):
    """Rings of quadrilaterals of two triangles each, and of single triangles at the poles."""
    rings = max(3, round(math.sqrt(count / 4)))
    around = max(3, round(count / (2 * (rings - 1))))
    with open(path + ".obj", "w", encoding="ascii", newline="\n") as out:
        out.write(f"# A bumpy sphere of {2 * around * (rings - 1)} triangles. Written by large_scenes.py.\nv 0 1 0\n")
        for ring in range(1, rings):
            theta = math.pi * ring / rings
            for i in range(around):
                phi = 2 * math.pi * i / around
                r = 1 + 0.1 * math.sin(8 * theta) * math.sin(8 * phi)
                at = (r * math.sin(theta) * math.cos(phi), r * math.cos(theta), -r * math.sin(theta) * math.sin(phi))
                out.write("v " + " ".join(f"{round(c, 6) + 0.0:.6f}" for c in at) + "\n")
        out.write("v 0 -1 0\n")

        def vertex(ring, i):
            return 2 + (ring - 1) * around + i % around

        last = 2 + (rings - 1) * around
        for i in range(around):
            out.write(f"f 1 {vertex(1, i)} {vertex(1, i + 1)}\n")
            for ring in range(1, rings - 1):
                a, b = vertex(ring, i), vertex(ring, i + 1)
                c, d = vertex(ring + 1, i), vertex(ring + 1, i + 1)
                out.write(f"f {a} {c} {d}\nf {a} {d} {b}\n")
            out.write(f"f {vertex(rings - 1, i)} {last} {vertex(rings - 1, i + 1)}\n")
    with open(path + ".toml", "w", encoding="ascii", newline="\n") as out:
        out.write(HEAD.format(
            comment=f"A bumpy sphere of {2 * around * (rings - 1)} triangles with flat normals.",
            position=vector((0, 0.8, 3.2)), look_at=vector((0, 0, 0)), screen_width=1.0666667,
            background=vector((0, 0, 0)), reflections=0))
        out.write(light((4, 6, 8), 1.0))
        out.write(MATERIAL.format(name="clay", color=vector((0.8, 0.6, 0.4)), diffuse=0.8, specular=0.4, shininess=32,
                                  reflection=0.0))
        out.write(f'\n[[mesh]]\npath = "{os.path.basename(path)}.obj"\nmaterial = "clay"\n')


def main(arguments):
    if not arguments or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    folder, *wanted = arguments
    os.makedirs(folder, exist_ok=True)
    for name in wanted or DEFAULT:
        kind, _, number = name.partition("=")
        if kind not in DEFAULT or not (number or "1").isdigit():
            print(f"large_scenes.py: {name}: expected flake, cloud or bumpy, and =N", file=sys.stderr)
            return 2
        number = int(number) if number else DEFAULT[kind]
        if number < 1:
            print(f"large_scenes.py: {name}: one or more", file=sys.stderr)
            return 2
        path = os.path.join(folder, f"{kind}-{number}")
        {"flake": flake, "cloud": cloud, "bumpy": bumpy}[kind](path, number)
        print(path + ".toml")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
