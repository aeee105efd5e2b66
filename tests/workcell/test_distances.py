"""Distances of solids are those of closed forms and of searches written here."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.cell.shapes import Box, Capsule, Cylinder, Extrusion, Mesh, Shape, Sphere, moved
from rpl.emulator.rotations import FloatArray, pose_matrix, zyx_to_matrix
from rpl.workcell.sweeping.solids import solids_of
from rpl.workcell.sweeping.sweep import Meter
from rpl.workcell.sweeping.tracks import STILL, Piece

lengths = st.floats(20.0, 300.0)
places = st.tuples(*[st.floats(-500.0, 500.0)] * 3, *[st.floats(-180.0, 180.0)] * 3)


def pose(six: tuple[float, ...]) -> FloatArray:
    return pose_matrix(np.array(six[:3]), zyx_to_matrix(np.array(six[3:])))


def distance(first: Shape, at: FloatArray, second: Shape, there: FloatArray) -> float:
    pieces = [
        [Piece(0, solid, STILL, 0, solid.at, 0.0, 1.0) for solid in solids_of(shape, place)]
        for shape, place in ((first, at), (second, there))
    ]
    meter = Meter(())
    return min(meter.at(one, other, 0.0) for one in pieces[0] for other in pieces[1])


def ends(capsule: Capsule, at: FloatArray) -> tuple[FloatArray, FloatArray]:
    half = at[:3, 2] * capsule.length / 2.0
    return at[:3, 3] - half, at[:3, 3] + half


def least(value: object, low: float = 0.0, high: float = 1.0) -> float:
    """The least value of a convex function of one number, by thirds."""
    for _ in range(100):
        first, second = low + (high - low) / 3.0, high - (high - low) / 3.0
        if value(first) <= value(second):  # type: ignore[operator]
            high = second
        else:
            low = first
    return float(value((low + high) / 2.0))  # type: ignore[operator]


def from_point_to_way(point: FloatArray, start: FloatArray, end: FloatArray) -> float:
    way = end - start
    share = np.clip((point - start) @ way / (way @ way), 0.0, 1.0)
    return float(np.linalg.norm(point - start - share * way))


@given(places, places, lengths, lengths, lengths)
@settings(max_examples=60, deadline=None)
def test_capsules_are_apart_by_their_middle_lines_less_the_radii(
    first: tuple[float, ...], second: tuple[float, ...], long: float, wide: float, other: float
) -> None:
    one, two = Capsule(wide, long), Capsule(other, 150.0)
    (a, b), (c, d) = ends(one, pose(first)), ends(two, pose(second))
    lines = least(lambda share: from_point_to_way(a + share * (b - a), c, d))
    if lines > 1.0:  # lines that cross are deeper than this closed form says
        assert distance(one, pose(first), two, pose(second)) == pytest.approx(lines - (wide + other) / 2.0, abs=1e-4)


@given(places, places, lengths, lengths)
@settings(max_examples=60, deadline=None)
def test_a_capsule_is_apart_from_a_box_by_its_middle_line(
    first: tuple[float, ...], second: tuple[float, ...], long: float, wide: float
) -> None:
    capsule, box = Capsule(wide, long), Box((200.0, 120.0, 60.0))
    a, b = (moved(point[None], np.linalg.inv(pose(second)))[0] for point in ends(capsule, pose(first)))
    half = np.array(box.size) / 2.0

    def off(share: float) -> float:
        point = a + share * (b - a)
        return float(np.linalg.norm(point - np.clip(point, -half, half)))

    apart = least(off)
    if apart > 1.0:
        assert distance(capsule, pose(first), box, pose(second)) == pytest.approx(apart - wide / 2.0, abs=1e-3)


@given(places, places)
@settings(max_examples=40, deadline=None)
def test_a_ball_is_as_deep_in_a_cylinder_as_its_surface_says(
    first: tuple[float, ...], second: tuple[float, ...]
) -> None:
    cylinder = Cylinder(300.0, 400.0)
    centre = moved(np.array([pose(first)[:3, 3]]), np.linalg.inv(pose(second)))[0]
    surface, normal = cylinder.on_surface(centre)
    signed = float((centre - surface) @ normal)
    found = distance(Sphere(50.0), pose(first), cylinder, pose(second))
    # Deep inside, the expanding polytope of coal takes a way out that is up to 2 % longer than the shortest.
    assert found == pytest.approx(signed - 25.0, abs=1e-2, rel=0.02 if signed < -5.0 else 0.0)


U_SHAPE = ((0, 0), (300, 0), (300, 200), (200, 200), (200, 50), (100, 50), (100, 200), (0, 200))


def test_an_extrusion_is_open_where_its_outline_is() -> None:
    shape = Extrusion(tuple((float(x), float(y)) for x, y in U_SHAPE), 80.0)
    solids = solids_of(shape, np.eye(4))
    assert 2 <= len(solids) <= 4
    # Its frame is in the middle of its box: the gap is 100 wide about x = 0, above y = -50.
    assert distance(Sphere(60.0), pose((0, 50, 0, 0, 0, 0)), shape, np.eye(4)) == pytest.approx(20.0, abs=1e-6)
    assert distance(Sphere(60.0), pose((100, 0, 0, 0, 0, 0)), shape, np.eye(4)) < -30.0


def test_a_mesh_that_is_not_convex_keeps_its_hollow() -> None:
    facets = Extrusion(tuple((float(x), float(y)) for x, y in U_SHAPE), 80.0).facets
    mesh = Mesh(facets.vertices, facets.faces)
    assert distance(Sphere(60.0), pose((0, 50, 0, 0, 0, 0)), mesh, np.eye(4)) == pytest.approx(20.0, abs=1e-6)
    assert distance(Sphere(60.0), pose((0, -25, 0, 0, 0, 0)), mesh, np.eye(4)) < 0.0


def test_a_convex_mesh_is_solid() -> None:
    facets = Box((100.0, 100.0, 100.0)).facets
    mesh = Mesh(facets.vertices, facets.faces)
    assert distance(Sphere(10.0), np.eye(4), mesh, np.eye(4)) == pytest.approx(-55.0, abs=1e-6)
