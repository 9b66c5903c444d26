#!/usr/bin/env python3
"""Turns a scene file (TOML) into bare words and numbers, for programs without a TOML library.

    scene_to_text.py SCENE.toml [OUT.txt]      (without OUT.txt: to standard output)

The text is a list of sections, always all of them and in this order. A section is a keyword and
its values; a list starts with the number of its rows. Missing keys have got their defaults, and a
material is the number of its row, from 0.

    image      width height
    camera     position.xyz look_at.xyz up.xyz focal_length screen_width
    render     background.rgb max_reflections antialiasing
    lights N   position.xyz color.rgb power
    materials N  color.rgb ambient diffuse specular shininess reflection
    planes N   point.xyz normal.xyz material
    spheres N  center.xyz radius material
    triangles N  a.xyz b.xyz c.xyz material
    cylinders N  bottom.xyz top.y radius material

Meshes are refused. What a value may be is not checked here beyond the names of keys: the program
that draws the scene files proper does that, with line numbers.
"""

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
TABLES = ["image", "camera", "render", "light", "material", *PRIMITIVES]


class SceneError(Exception):
    pass


def filled(table, keys, where):
    """The values of `keys` in order, from the table or by default."""
    if unknown := [key for key in table if key not in keys]:
        raise SceneError(f"{where}: unknown key {unknown[0]}")
    values = []
    for key, default in keys.items():
        value = table.get(key, default)
        if value is REQUIRED:
            raise SceneError(f"{where}: {key} is missing")
        values.append(value)
    return values


def numbers(value):
    """The numbers of a value, nested lists flattened, as text that reads back to the same number."""
    if isinstance(value, list):
        return [text for item in value for text in numbers(item)]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise SceneError(f"expected a number, got {value!r}")
    return [repr(value)]


def scene_to_text(scene):
    if "mesh" in scene:
        raise SceneError("meshes are not supported")
    if unknown := [key for key in scene if key not in TABLES]:
        raise SceneError(f"unknown key {unknown[0]}")
    if "camera" not in scene:
        raise SceneError("camera is missing")

    lines = []
    for name, keys in [("image", IMAGE), ("camera", CAMERA), ("render", RENDER)]:
        lines.append(" ".join([name, *numbers(filled(scene.get(name, {}), keys, name))]))

    lights = [filled(light, LIGHT, f"light {i}") for i, light in enumerate(scene.get("light", []), 1)]
    materials = scene.get("material", {})
    rows = [filled(material, MATERIAL, f"material {name}") for name, material in materials.items()]
    for name, values in [("lights", lights), ("materials", rows)]:
        lines.append(f"{name} {len(values)}")
        lines.extend(" ".join(numbers(row)) for row in values)

    index = {name: i for i, name in enumerate(materials)}
    for kind, keys in PRIMITIVES.items():
        tables = scene.get(kind, [])
        lines.append(f"{kind}s {len(tables)}")
        for i, table in enumerate(tables, 1):
            *shape, material = filled(table, dict.fromkeys(keys, REQUIRED), f"{kind} {i}")
            if material not in index:
                raise SceneError(f"{kind} {i}: no material {material}")
            if kind == "cylinder":
                shape[1] = shape[1][1]
            lines.append(" ".join([*numbers(shape), str(index[material])]))
    return "\n".join(lines) + "\n"


def main(arguments):
    if not 1 <= len(arguments) <= 2 or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        with open(arguments[0], "rb") as file:
            text = scene_to_text(tomllib.load(file))
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
