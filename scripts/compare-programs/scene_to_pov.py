#!/usr/bin/env python3
"""Converts a scene file to a scene of POV-Ray 3.7.

    scene_to_pov.py SCENE.toml [WIDTHxHEIGHT]      (to standard output)

Only the proportions of the size matter: the pixels and the samples are options of povray.
"""

import sys

from converter import convert
from geometry import frame, times


def vector(values):
    return "<" + ",".join(f"{v:.9g}" for v in values) + ">"


def scene_to_pov(parts, width, height):
    position, look_at, up, focal_length, screen_width = parts["camera"]
    background, max_reflections, _ = parts["render"]
    forward, right, up = frame(position, look_at, up)
    # POV-Ray's default would stop mirrored rays whose weight is below 1/255.
    yield f"""#version 3.7;
global_settings {{ assumed_gamma 1.0 ambient_light rgb 1 max_trace_level {max_reflections + 1} adc_bailout 0 }}
background {{ rgb {vector(background)} }}
camera {{
  perspective location {vector(position)} direction {vector(times(focal_length, forward))}
  right {vector(times(screen_width, right))} up {vector(times(screen_width * height / width, up))}
}}
"""
    for at, color, power in parts["lights"]:
        yield f"light_source {{ {vector(at)} color rgb {vector(times(power, color))} }}\n"
    for i, (color, ambient, diffuse, specular, shininess, k) in enumerate(parts["materials"]):
        # POV-Ray adds the mirrored colour; the image model blends it.
        reflection = f" reflection {{ {k:.9g} }}" if k > 0 else ""
        yield (f"#declare M{i} = texture {{ pigment {{ rgb {vector(color)} }} finish {{ "
               f"ambient {(1 - k) * ambient:.9g} diffuse {(1 - k) * diffuse:.9g} "
               f"phong {(1 - k) * specular:.9g} phong_size {shininess}{reflection} }} }}\n")
    for point, normal, m in parts["planes"]:
        # Translated: POV-Ray expects the distance from the origin.
        yield f"plane {{ {vector(normal)}, 0 texture {{ M{m} }} translate {vector(point)} }}\n"
    for center, radius, m in parts["spheres"]:
        yield f"sphere {{ {vector(center)}, {radius:.9g} texture {{ M{m} }} }}\n"
    for bottom, top, radius, m in parts["cylinders"]:
        yield f"cylinder {{ {vector(bottom)}, {vector(top)}, {radius:.9g} open texture {{ M{m} }} }}\n"
    # Many triangles become a mesh for each material, which POV-Ray stores and traverses best.
    by_material = {}
    for corners, m in parts["triangles"]:
        by_material.setdefault(m, []).append(corners)
    for m, triangles in by_material.items():
        if len(triangles) < 10:
            for a, b, c in triangles:
                yield f"triangle {{ {vector(a)}, {vector(b)}, {vector(c)} texture {{ M{m} }} }}\n"
            continue
        index = {}
        faces = [[index.setdefault(tuple(p), len(index)) for p in corners] for corners in triangles]
        yield f"mesh2 {{ vertex_vectors {{ {len(index)}"
        for p in index:
            yield ",\n" + vector(p)
        yield f" }} face_indices {{ {len(faces)}"
        for face in faces:
            yield ",\n" + vector(face)
        yield f" }} texture {{ M{m} }} }}\n"


if __name__ == "__main__":
    sys.exit(convert(sys.argv, __doc__, scene_to_pov))
