"""The vector arithmetic that the converters need."""

import math


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def times(factor, a):
    return [factor * x for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return times(1 / math.hypot(*a), a)


def frame(position, look_at, up):
    """Returns forward, right and up of the image model's camera."""
    forward = unit(minus(look_at, position))
    right = unit(cross(forward, up))
    return forward, right, cross(right, forward)
