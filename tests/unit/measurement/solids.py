"""Solids with known measures."""

import numpy as np


def tube(*, radius: float, height: float, sides: int = 256, rings: int = 9):
    """A closed cylinder about y from y = 0, with caps."""
    return lathe(np.full(rings, radius), np.linspace(0.0, height, rings), sides=sides)


def lathe(radii, heights, *, sides: int = 256):
    """A closed surface of revolution about y, counter-clockwise seen from outside."""
    angle = 2 * np.pi * np.arange(sides) / sides
    circle = np.stack([np.sin(angle), np.zeros(sides), np.cos(angle)], axis=1)
    rings = [
        radius * circle + [0.0, height, 0.0] for radius, height in zip(radii, heights, strict=True)
    ]
    return _closed_stack(rings)


def prism(outline, *, heights):
    """A closed prism over an outline in (x, z), counter-clockwise seen from above (y)."""
    outline = np.asarray(outline, dtype=float)
    rings = [np.insert(outline, 1, height, axis=1) for height in heights]
    return _closed_stack(rings)


def sphere(*, radius: float, rings: int = 200, sides: int = 400):
    angle = np.linspace(0.0, np.pi, rings + 2)[1:-1]
    return lathe(radius * np.sin(angle), -radius * np.cos(angle), sides=sides)


def _closed_stack(rings):
    sides = len(rings[0])
    bottom, top = rings[0].mean(axis=0), rings[-1].mean(axis=0)
    vertices = np.concatenate([*rings, [bottom, top]])
    side = np.arange(sides)
    after = (side + 1) % sides
    triangles = []
    for row in range(len(rings) - 1):
        a, b = row * sides + side, row * sides + after
        triangles += [np.stack([a, b, b + sides], 1), np.stack([a, b + sides, a + sides], 1)]
    last = (len(rings) - 1) * sides
    low, high = len(vertices) - 2, len(vertices) - 1
    triangles.append(np.stack([np.full(sides, low), after, side], 1))
    triangles.append(np.stack([np.full(sides, high), last + side, last + after], 1))
    return vertices, np.concatenate(triangles).astype(np.int32)
