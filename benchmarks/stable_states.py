"""How long stable states take: the estimate for meshes of more and more facets, and drops in MuJoCo.

python benchmarks/stable_states.py [--drops 200]

Balls with dents that their hull covers (many facets, a round hull), balls (every facet is one of the hull), and
cuboids. The table is the one of docs/stable.md.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from rpl.cell.shapes import Box, Cylinder, Extrusion, Mesh, Shape
from rpl.cell.stable import stable_states

FACETS = (1_000, 10_000, 100_000)
REPETITIONS = 5


def ball(facets: int, dents: bool) -> Mesh:
    """A mesh of about this many facets, slightly longer in x, with every second ring drawn in for dents."""
    rings = max(4, round(np.sqrt(facets / 4.0)))
    around = 2 * rings
    turns, heights = np.arange(around) * 2.0 * np.pi / around, np.linspace(-0.99, 0.99, rings)
    rows = []
    for number, height in enumerate(heights):
        radius = np.sqrt(1.0 - height * height) * (0.9 if dents and number % 2 else 1.0)
        rows.append(
            np.stack([11.0 * radius * np.cos(turns), 10.0 * radius * np.sin(turns), 10.0 * height + 0.0 * turns], 1)
        )
    vertices = np.concatenate([[[0.0, 0.0, -10.0]], *rows, [[0.0, 0.0, 10.0]]])
    place, after = np.arange(around), (np.arange(around) + 1) % around
    faces = [np.stack([0 * place, 1 + after, 1 + place], 1)]
    for ring in range(rings - 1):
        low, high = 1 + ring * around, 1 + (ring + 1) * around
        faces += [
            np.stack([low + place, low + after, high + after], 1),
            np.stack([low + place, high + after, high + place], 1),
        ]
    top = 1 + (rings - 1) * around
    faces.append(np.stack([top + place, top + after, 0 * place + len(vertices) - 1], 1))
    return Mesh(vertices, np.concatenate(faces).astype(np.int64))


def fastest_ms(shape: Shape) -> tuple[float, int]:
    times, states = [], 0
    for _ in range(REPETITIONS):
        started = time.perf_counter()
        states = len(stable_states(shape))
        times.append(time.perf_counter() - started)
    return 1000.0 * min(times), states


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--drops", type=int, default=200)
    drops = parser.parse_args().drops
    print("| shape | facets | states | fast, ms |\n|---|---|---|---|")
    shapes: list[tuple[str, Shape]] = [("cuboid", Box((10.0, 20.0, 30.0)))]
    shapes += [("ball with dents", ball(facets, True)) for facets in FACETS]
    shapes += [("ball", ball(facets, False)) for facets in FACETS]
    for name, shape in shapes:
        taken, states = fastest_ms(shape)
        faces = shape.faces if isinstance(shape, Mesh) else shape.facets.faces
        print(f"| {name} | {len(faces):,} | {states} | {taken:.1f} |")
    bracket = Extrusion(((0.0, 0.0), (60.0, 0.0), (60.0, 8.0), (8.0, 8.0), (8.0, 40.0), (0.0, 40.0)), 20.0)
    print("\n| shape | dynamic, ms a drop |\n|---|---|")
    for name, shape in (("cuboid", Box((10.0, 20.0, 30.0))), ("coin", Cylinder(20.0, 10.0)), ("bracket", bracket)):
        started = time.perf_counter()
        stable_states(shape, method="dynamic", drops=drops)
        print(f"| {name} | {1000.0 * (time.perf_counter() - started) / drops:.1f} |")


if __name__ == "__main__":
    main()
