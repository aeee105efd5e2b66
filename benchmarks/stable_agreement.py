"""How far the fast estimate of stable states is from drops in MuJoCo, over 32 shapes.

python benchmarks/stable_agreement.py [--drops 500]

The rms of a shape is over its states; that of a set over its shapes. The second set was put together when the estimator
was finished. The table is the one of docs/stable.md.
"""

from __future__ import annotations

import argparse
import math

import numpy as np
import trimesh

from rpl.cell.meshes import mesh_of
from rpl.cell.shapes import Box, Cylinder, Extrusion, Mesh, Shape
from rpl.cell.stable import stable_states


def outline(sides: int, radius: float, turn: float = 2.0 * math.pi) -> tuple[tuple[float, float], ...]:
    turns = [turn * number / sides for number in range(sides if turn > 6.0 else sides + 1)]
    return tuple((radius * math.cos(one), radius * math.sin(one)) for one in turns)


def taken(*parts: trimesh.Trimesh) -> Mesh:
    whole = trimesh.util.concatenate(parts)
    return mesh_of(np.asarray(whole.vertices), np.asarray(whole.faces))


def hull(points: object) -> Mesh:
    return taken(trimesh.Trimesh(vertices=np.asarray(points, dtype=float)).convex_hull)


def rod(radius: float, low: float, high: float) -> trimesh.Trimesh:
    shift = trimesh.transformations.translation_matrix([0.0, 0.0, (low + high) / 2.0])
    return trimesh.creation.cylinder(radius=radius, height=high - low, sections=48, transform=shift)


def ring(inner: float, outer: float, height: float) -> Mesh:
    return taken(trimesh.creation.annulus(inner, outer, height, sections=48))


def rounded(x: float, y: float, z: float) -> Mesh:
    """A cuboid whose edges have a radius of 3."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=3).vertices
    corners = [(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]
    return hull(np.concatenate([ball + np.array(one) * (np.array((x, y, z)) / 2.0 - 3.0) for one in corners]))


def ellipsoid(x: float, y: float, z: float) -> Mesh:
    return taken(trimesh.creation.icosphere(subdivisions=4, radius=10).apply_scale([x, y, z]))


def first() -> dict[str, Shape]:
    ball = trimesh.creation.icosphere(subdivisions=3, radius=10).vertices
    return {
        "cube": Box((10.0, 10.0, 10.0)),
        "cuboid 10, 12, 14": Box((10.0, 12.0, 14.0)),
        "cuboid 10, 15, 25": Box((10.0, 15.0, 25.0)),
        "cuboid 10, 20, 30": Box((10.0, 20.0, 30.0)),
        "cuboid 10, 30, 30": Box((10.0, 30.0, 30.0)),
        "cuboid 10, 10, 30": Box((10.0, 10.0, 30.0)),
        "coin, 1/4 of its diameter": Cylinder(20.0, 5.0),
        "coin, 1/2 of its diameter": Cylinder(20.0, 10.0),
        "cylinder as high as wide": Cylinder(20.0, 20.0),
        "cylinder, 3/2 of its diameter": Cylinder(20.0, 30.0),
        "hexagonal plate": Extrusion(outline(6, 10.0), 8.0),
        "hexagonal bar": Extrusion(outline(6, 10.0), 20.0),
        "triangular bar": Extrusion(((0.0, 0.0), (20.0, 0.0), (10.0, 17.32)), 15.0),
        "half-round bar": Extrusion(outline(32, 10.0, math.pi), 15.0),
        "L bracket": Extrusion(((0.0, 0.0), (60.0, 0.0), (60.0, 8.0), (8.0, 8.0), (8.0, 40.0), (0.0, 40.0)), 20.0),
        "T bracket": Extrusion(
            ((0.0, 0), (30, 0), (30, 8), (19, 8), (19, 30), (11, 30), (11, 8), (0, 8)),
            10.0,
        ),
        "cone": taken(trimesh.creation.cone(10, 20, sections=48)),
        "tetrahedron": hull([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]),
        "skew octahedron": hull([(12, 0, 0), (-9, 0, 0), (0, 10, 0), (0, -14, 0), (0, 0, 8), (0, 0, -11)]),
        "half a ball": hull(ball[ball[:, 2] < 1e-9]),
    }


def second() -> dict[str, Shape]:
    zed = ((0.0, 0), (30, 0), (30, 6), (18, 6), (18, 30), (42, 30), (42, 36), (12, 36), (12, 6), (0, 6))
    return {
        "rounded cuboid 20, 30, 50": rounded(20.0, 30.0, 50.0),
        "rounded cube 20": rounded(20.0, 20.0, 20.0),
        "bolt": taken(rod(8.0, -4.0, 4.0), rod(4.0, 4.0, 34.0)),
        "stepped shaft": taken(rod(10.0, -10.0, 10.0), rod(5.0, 10.0, 50.0)),
        "washer": ring(5.0, 12.0, 3.0),
        "thick ring": ring(5.0, 12.0, 14.0),
        "tube": ring(5.0, 8.0, 30.0),
        "flat cone": taken(trimesh.creation.cone(20, 10, sections=64)),
        "long ellipsoid": ellipsoid(1.0, 1.0, 1.4),
        "flat ellipsoid": ellipsoid(1.0, 1.0, 0.5),
        "ellipsoid of three axes": ellipsoid(1.0, 0.7, 0.5),
        "Z bracket": Extrusion(zed, 12.0),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--drops", type=int, default=500)
    drops = parser.parse_args().drops
    print("| shape | states | rms | farthest: estimate, drops |\n|---|---|---|---|")
    for title, shapes in (("first set", first()), ("second set", second())):
        squares = []
        for name, shape in shapes.items():
            counted = {one.normal: one.probability for one in stable_states(shape, method="dynamic", drops=drops)}
            pairs = [(one.probability, counted[one.normal]) for one in stable_states(shape)]
            squares.append(sum((a - b) ** 2 for a, b in pairs) / len(pairs))
            far = max(pairs, key=lambda pair: abs(pair[0] - pair[1]))
            print(f"| {name} | {len(pairs)} | {math.sqrt(squares[-1]):.3f} | {far[0]:.2f}, {far[1]:.2f} |", flush=True)
        print(f"| **{title}** | | **{math.sqrt(sum(squares) / len(squares)):.3f}** | |", flush=True)


if __name__ == "__main__":
    main()
