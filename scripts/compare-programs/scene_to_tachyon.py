#!/usr/bin/env python3
"""Converts a scene file to a scene of tachyon 0.99.

    scene_to_tachyon.py SCENE.toml [WIDTHxHEIGHT]      (to standard output)

The number of samples is an option of tachyon. Its camera is left-handed: z changes its sign.
"""

import sys

from converter import convert
from geometry import frame, times


def point(values):
    x, y, z = values
    return f"{x:.9g} {y:.9g} {-z:.9g}"


def row(values):
    return " ".join(f"{v:.9g}" for v in values)


def scene_to_tachyon(parts, width, height):
    position, look_at, up, focal_length, screen_width = parts["camera"]
    background, max_reflections, _ = parts["render"]
    forward, _, up = frame(position, look_at, up)
    # The screen at distance 1: left, right, bottom, top. Tachyon's rays go through the corners of
    # pixels, so the screen is shifted half a pixel to the left and down.
    pixel = screen_width / width / focal_length
    sides = [pixel * (v - 0.5) for v in (-width / 2, width / 2, -height / 2, height / 2)]
    yield f"""BEGIN_SCENE
RESOLUTION {width} {height}
CAMERA
ZOOM 1 ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH {max_reflections + 1}
CENTER {point(position)}
VIEWDIR {point(forward)}
UPDIR {point(up)}
FRUSTUM {row(sides)}
END_CAMERA
BACKGROUND {row(background)}
"""
    for at, light, power in parts["lights"]:
        yield f"LIGHT CENTER {point(at)} RAD 0.001 COLOR {row(times(power, light))}\n"
    for i, (own, ambient, diffuse, specular, shininess, k) in enumerate(parts["materials"]):
        # SPECULAR is tachyon's mirror. It adds the mirrored colour; the image model blends it.
        yield (f"TEXDEF M{i} AMBIENT {(1 - k) * ambient:.9g} DIFFUSE {(1 - k) * diffuse:.9g} SPECULAR {k:.9g} "
               f"OPACITY 1 PHONG PLASTIC {(1 - k) * specular:.9g} PHONG_SIZE {shininess} "
               f"COLOR {row(own)} TEXFUNC 0\n")
    for at, normal, m in parts["planes"]:
        yield f"PLANE CENTER {point(at)} NORMAL {point(normal)} M{m}\n"
    for center, radius, m in parts["spheres"]:
        yield f"SPHERE CENTER {point(center)} RAD {radius:.9g} M{m}\n"
    for (a, b, c), m in parts["triangles"]:
        yield f"TRI V0 {point(a)} V1 {point(b)} V2 {point(c)} M{m}\n"
    for bottom, top, radius, m in parts["cylinders"]:
        yield f"FCYLINDER BASE {point(bottom)} APEX {point(top)} RAD {radius:.9g} M{m}\n"
    yield "END_SCENE\n"


if __name__ == "__main__":
    sys.exit(convert(sys.argv, __doc__, scene_to_tachyon))
