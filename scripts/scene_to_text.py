#!/usr/bin/env python3
"""Converts a scene file (TOML) to plain words and numbers, for programs without a TOML library.

    scene_to_text.py SCENE.toml [OUT.txt]      (without OUT.txt: to standard output)

The text has all of these sections, in this order. A section is a keyword and its values; a list
starts with its number of rows. Missing keys have their defaults. A material is the number of its
row, from 0.

    image      width height
    camera     position.xyz look_at.xyz up.xyz focal_length screen_width
    render     background.rgb max_reflections antialiasing
    lights N   position.xyz color.rgb power
    materials N  color.rgb ambient diffuse specular shininess reflection
    planes N   point.xyz normal.xyz material
    spheres N  center.xyz radius material
    triangles N  a.xyz b.xyz c.xyz material
    cylinders N  bottom.xyz top.y radius material

The triangles of meshes follow the scene's own. Only the names of keys are checked here; rayweave
checks the values, with line numbers.
"""

import os
import sys
import tomllib

REQUIRED = object()
IMAGE = {"width": 500, "height": 500}
CAMERA = dict.fromkeys(["position", "look_at", "up", "focal_length", "screen_width"], REQUIRED)
RENDER = {"background": [0.0, 0.0, 0.0], "max_reflections": 4, "antialiasing": 2}
LIGHT = {"position": REQUIRED, "color": [1.0, 1.0, 1.0], "power": 1.0}
MATERIAL = {
    "color": REQUIRED,
    "ambient": 0.1,
    "diffuse": 0.6,
    "specular": 0.4,
    "shininess": 2,
    "reflection": 0.0,
}
PRIMITIVES = {
    "plane": ["point", "normal", "material"],
    "sphere": ["center", "radius", "material"],
    "triangle": ["vertices", "material"],
    "cylinder": ["bottom", "top", "radius", "material"],
}
MESH = dict.fromkeys(["path", "material"], REQUIRED)
TABLES = ["image", "camera", "render", "light", "material", "mesh", *PRIMITIVES]


class SceneError(Exception):
    pass


def filled(table, keys, where):
    """Returns the values of `keys` in order, from the table or by default."""
    if unknown := [key for key in table if key not in keys]:
        raise SceneError(f"{where}: unknown key {unknown[0]}")
    values = []
    for key, default in keys.items():
        value = table.get(key, default)
        if value is REQUIRED:
            raise SceneError(f"{where}: {key} is missing")
        values.append(value)
    return values


def obj_triangles(path):
    """Returns the triangles of a Wavefront OBJ file, polygons as fans, without those of no area."""
    vertices, triangles = [], []
    with open(path, encoding="utf-8", errors="replace") as file:
        for line, text in enumerate(file, 1):
            words = text.partition("#")[0].split()
            try:
                if words[:1] == ["v"]:
                    x, y, z = words[1:4]
                    vertices.append((float(x), float(y), float(z)))
                elif words[:1] == ["f"]:
                    numbers = [int(word.partition("/")[0]) for word in words[1:]]
                    if len(numbers) < 3 or not all(1 <= abs(n) <= len(vertices) for n in numbers):
                        raise ValueError
                    first, *rest = [vertices[n - 1 if n > 0 else n] for n in numbers]
                    triangles.extend(fan for b, c in zip(rest, rest[1:]) if has_area(fan := (first, b, c)))
            except ValueError:
                raise SceneError(f"{path}:{line}: {text.strip()}: neither a vertex nor a face of vertices above it") from None
    if not triangles:
        raise SceneError(f"{path}: no triangle")
    return triangles


def has_area(triangle):
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = triangle
    ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
    return uy * vz != uz * vy or uz * vx != ux * vz or ux * vy != uy * vx


def sections(scene, folder="."):
    """Returns the sections by name: values or rows, with materials as numbers and meshes read."""
    if unknown := [key for key in scene if key not in TABLES]:
        raise SceneError(f"unknown key {unknown[0]}")
    if "camera" not in scene:
        raise SceneError("camera is missing")

    parts = {}
    for name, keys in [("image", IMAGE), ("camera", CAMERA), ("render", RENDER)]:
        parts[name] = filled(scene.get(name, {}), keys, name)
    parts["lights"] = [filled(light, LIGHT, f"light {i}") for i, light in enumerate(scene.get("light", []), 1)]
    materials = scene.get("material", {})
    parts["materials"] = [filled(material, MATERIAL, f"material {name}") for name, material in materials.items()]

    index = {name: i for i, name in enumerate(materials)}

    def rows(kind, keys):
        for i, table in enumerate(scene.get(kind, []), 1):
            *shape, material = filled(table, keys, f"{kind} {i}")
            if material not in index:
                raise SceneError(f"{kind} {i}: no material {material}")
            yield [*shape, index[material]]

    for kind, keys in PRIMITIVES.items():
        parts[f"{kind}s"] = list(rows(kind, dict.fromkeys(keys, REQUIRED)))
    for path, material in rows("mesh", MESH):
        triangles = obj_triangles(os.path.join(folder, path))
        parts["triangles"].extend([triangle, material] for triangle in triangles)
    return parts


def read_scene(path):
    with open(path, "rb") as file:
        return sections(tomllib.load(file), os.path.dirname(path))


def numbers(value):
    """Returns the numbers of a value, nested lists flattened, as text that reads back unchanged."""
    if isinstance(value, (list, tuple)):
        return [text for item in value for text in numbers(item)]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise SceneError(f"expected a number, got {value!r}")
    return [repr(value)]


def scene_to_text(parts):
    lines = []
    for name, values in parts.items():
        if name in ("image", "camera", "render"):
            lines.append(" ".join([name, *numbers(values)]))
            continue
        lines.append(f"{name} {len(values)}")
        if name == "cylinders":
            values = [[bottom, top[1], radius, material] for bottom, top, radius, material in values]
        lines.extend(" ".join(numbers(row)) for row in values)
    return "\n".join(lines) + "\n"


def main(arguments):
    if not 1 <= len(arguments) <= 2 or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        text = scene_to_text(read_scene(arguments[0]))
        if len(arguments) == 2:
            with open(arguments[1], "w", encoding="ascii") as out:
                out.write(text)
        else:
            sys.stdout.write(text)
    except (OSError, SceneError, tomllib.TOMLDecodeError) as error:
        print(f"scene_to_text.py: {arguments[0]}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
