"""Resting states of parts: closed forms, what holds for every shape, drop heights, and MuJoCo beside the estimate."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.cell.shapes import Box, Capsule, Cylinder, Extrusion, Facets, Mesh, Shape, Sphere
from rpl.cell.stable import Drop, StableState, stable_states
from rpl.cell.stable.states import mass_properties
from rpl.emulator.rotations import quaternion_to_matrix
from rpl.errors import UsageError

L_BRACKET = Extrusion(((0.0, 0.0), (60.0, 0.0), (60.0, 8.0), (8.0, 8.0), (8.0, 40.0), (0.0, 40.0)), 20.0)
SHAPES = (Box((10.0, 20.0, 30.0)), Cylinder(20.0, 12.0), Sphere(8.0), Capsule(10.0, 20.0), L_BRACKET)


def turned(solid: Facets, quaternion: tuple[float, ...], shift: tuple[float, ...]) -> Mesh:
    unit = np.array(quaternion) / np.linalg.norm(quaternion)
    return Mesh(solid.vertices @ quaternion_to_matrix(unit).T + np.array(shift), solid.faces)


def tetrahedron(edge: float) -> Mesh:
    corners = np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]) * edge / math.sqrt(8.0)
    return Mesh(corners, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]))


def lowest(shape: Shape, state: StableState) -> float:
    """Of all corners, when the part stands as the state says."""
    solid = shape if isinstance(shape, Mesh) else shape.facets
    placed = solid.vertices @ quaternion_to_matrix(np.array(state.rotation)).T
    return float(placed[:, 2].min()) + state.height_mm


def chances(states: tuple[StableState, ...]) -> list[float]:
    return sorted(state.probability for state in states)


def heights(states: tuple[StableState, ...]) -> list[float]:
    return sorted(state.com_height_mm for state in states)


def test_a_cube_has_six_alike() -> None:
    states = stable_states(Box((10.0, 10.0, 10.0)))
    assert [state.probability for state in states] == pytest.approx([1.0 / 6.0] * 6)
    assert {state.height_mm for state in states} == {5.0}


def test_a_regular_tetrahedron_has_four_alike() -> None:
    states = stable_states(tetrahedron(30.0))
    assert [state.probability for state in states] == pytest.approx([0.25] * 4)
    # The centre of a regular tetrahedron lies edge * sqrt(6) / 12 above each face.
    assert [state.com_height_mm for state in states] == pytest.approx([30.0 * math.sqrt(6.0) / 12.0] * 4)


@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (Sphere(8.0), [4.0]),
        (Capsule(10.0, 20.0), [5.0]),
        (Cylinder(20.0, 12.0), [10.0, 6.0, 6.0]),
        (Cylinder(10.0, 60.0), [5.0, 30.0, 30.0]),
    ],
)
def test_curved_faces_are_one_state(shape: Shape, expected: list[float]) -> None:
    assert [state.height_mm for state in stable_states(shape)] == pytest.approx(expected)


@pytest.mark.parametrize("shape", [Sphere(8.0), Capsule(10.0, 20.0), Cylinder(20.0, 12.0), Cylinder(60.0, 2.0)])
def test_a_mesh_of_a_curved_form_says_the_same_as_the_form(shape: Shape) -> None:
    exact, faceted = stable_states(shape), stable_states(Mesh(shape.facets.vertices, shape.facets.faces))
    assert [one.probability for one in faceted] == pytest.approx([one.probability for one in exact], abs=0.005)
    assert [one.height_mm for one in faceted] == pytest.approx([one.height_mm for one in exact], rel=0.011)


@pytest.mark.parametrize(("sides", "states"), [(6, 8), (8, 10), (12, 14), (16, 3), (24, 3), (200, 3)])
def test_a_bar_of_many_sides_is_round(sides: int, states: int) -> None:
    turns = [2.0 * math.pi * number / sides for number in range(sides)]
    outline = tuple((10.0 * math.cos(turn), 10.0 * math.sin(turn)) for turn in turns)
    assert len(stable_states(Extrusion(outline, 15.0))) == states


def test_a_sheet_can_stand_on_its_edge_but_hardly_does() -> None:
    states = stable_states(Box((100.0, 100.0, 1.0)))
    assert len(states) == 6
    assert sum(state.probability for state in states[:2]) > 0.999
    assert all(0.0 < state.probability < 1e-4 for state in states[2:])


def test_a_leaning_prism_falls_off_its_end() -> None:
    """The middle of an oblique prism stands beside its end faces when it leans by more than half of them."""
    corners = np.array(
        [[x + lean, y, z] for z, lean in ((0.0, 0.0), (40.0, 30.0)) for x in (0.0, 10.0) for y in (0.0, 10.0)]
    )
    faces = Box((1.0, 1.0, 1.0)).facets.faces
    # The corners of a box of the package go around; these are in rows.
    order = np.array([0, 2, 3, 1, 4, 6, 7, 5])
    states = stable_states(Mesh(corners[order], faces))
    assert all(abs(state.normal[2]) < 0.99 for state in states)


def test_the_hull_of_a_bracket_rests_across_its_opening() -> None:
    """Not convex: it lies on both arms, on its two flat sides, and on the line from tip to tip."""
    states = stable_states(L_BRACKET)
    normals = [state.normal for state in states]
    slanted = math.hypot(60.0 - 8.0, 40.0 - 8.0)
    assert any(normal == pytest.approx((32.0 / slanted, 52.0 / slanted, 0.0), abs=0.1) for normal in normals)
    assert states[0].height_mm == states[1].height_mm == 10.0


@settings(max_examples=40, deadline=None)
@given(
    st.sampled_from(SHAPES),
    st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
    st.tuples(*[st.floats(-500.0, 500.0)] * 3),
)
def test_what_holds_for_every_shape_however_it_is_drawn(shape, quaternion, shift) -> None:
    """Probabilities add to 1, the rotation points the normal down, the part stands on the support, and turning or
    shifting the drawing changes neither chances nor the heights of the centre of mass."""
    mesh = turned(shape.facets, quaternion, shift)
    states = stable_states(mesh)
    plain = stable_states(Mesh(shape.facets.vertices, shape.facets.faces))
    assert sum(state.probability for state in states) == pytest.approx(1.0)
    for state in states:
        down = quaternion_to_matrix(np.array(state.rotation)) @ np.array(state.normal)
        assert down == pytest.approx([0.0, 0.0, -1.0], abs=1e-9)
        assert lowest(mesh, state) == pytest.approx(0.0, abs=1e-6)
    assert sorted(one.probability for one in states) == pytest.approx(
        sorted(one.probability for one in plain), abs=1e-6
    )
    assert sorted(one.com_height_mm for one in states) == pytest.approx(
        sorted(one.com_height_mm for one in plain), rel=1e-6
    )


@given(st.lists(st.tuples(*[st.floats(-50.0, 50.0)] * 3), min_size=5, max_size=30))
@settings(max_examples=60, deadline=None)
def test_any_cloud_of_corners_has_states_or_is_refused(corners: list[tuple[float, float, float]]) -> None:
    """Of hulls of points, each state's centre of mass stands above the facet that it lies on."""
    from scipy.spatial import ConvexHull, QhullError

    points = np.array(corners)
    try:
        hull = ConvexHull(points)
    except QhullError:
        return
    if hull.volume < 1.0:
        return
    outwards = np.einsum(
        "ij,ij->i",
        np.cross(
            points[hull.simplices[:, 1]] - points[hull.simplices[:, 0]],
            points[hull.simplices[:, 2]] - points[hull.simplices[:, 0]],
        ),
        hull.equations[:, :3],
    )
    faces = np.where(outwards[:, None] > 0.0, hull.simplices, hull.simplices[:, ::-1])
    mesh = Mesh(points, faces.astype(np.int64))
    states = stable_states(mesh)
    assert sum(state.probability for state in states) == pytest.approx(1.0)
    centre = mass_properties(mesh)[0]
    for state in states:
        down = np.array(state.normal)
        touching = points[points @ down > (points @ down).max() - 1e-6]
        off = touching - centre
        across = off - np.outer(off @ down, down)
        # Inside the support polygon: no direction has all touching corners on one side.
        for turn in np.linspace(0.0, 2.0 * math.pi, 73):
            side = np.cross(down, [0.36, 0.48, 0.8])
            side = side / np.linalg.norm(side)
            direction = math.cos(turn) * side + math.sin(turn) * np.cross(down, side)
            assert (across @ direction).max() > -1e-6


def test_mass_properties_of_a_box_are_those_of_the_books() -> None:
    centre, inertia = mass_properties(turned(Box((10.0, 20.0, 30.0)).facets, (1.0, 0.0, 0.0, 0.0), (5.0, 6.0, 7.0)))
    assert centre == pytest.approx([5.0, 6.0, 7.0])
    assert inertia == pytest.approx(np.diag([400.0 + 900.0, 100.0 + 900.0, 100.0 + 400.0]) / 12.0)


def test_a_heavy_side_comes_down_more_often() -> None:
    states = stable_states(Box((10.0, 10.0, 10.0)), com=(0.0, 0.0, -3.0))
    assert states[0].normal == pytest.approx((0.0, 0.0, -1.0))
    assert states[0].probability > 0.5
    assert states[0].com_height_mm == pytest.approx(2.0)


def test_from_no_height_a_part_stays_and_from_its_length_it_has_forgotten() -> None:
    box = Box((10.0, 20.0, 30.0))
    full = {one.normal: one.probability for one in stable_states(box)}
    held = (0.0, 1.0, 0.0)
    stays = {one.normal: one.probability for one in stable_states(box, drop_height_mm=0.0, down=held)}
    assert [normal for normal, chance in stays.items() if chance == 1.0] == [held]
    for height in (30.0, 31.0, 500.0):
        assert {one.normal: one.probability for one in stable_states(box, drop_height_mm=height, down=held)} == full
    half = {one.normal: one.probability for one in stable_states(box, drop_height_mm=15.0, down=held)}
    assert half == pytest.approx({one: 0.5 * full[one] + 0.5 * (one == held) for one in full})


def test_a_part_held_askew_rolls_into_the_state_below() -> None:
    states = stable_states(Box((10.0, 20.0, 30.0)), drop_height_mm=0.0, down=(0.2, 0.0, -1.0))
    assert states[0].normal == pytest.approx((0.0, 0.0, -1.0))


@pytest.mark.parametrize(
    ("shape", "more", "words"),
    [
        (Box((10.0, 20.0, 30.0)), {"com": (0.0, 0.0, 40.0)}, "outside"),
        (Mesh(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]])), {}, "no volume"),
        (Box((10.0, 20.0, 30.0)), {"method": "magic"}, "fast and dynamic"),
        (Box((10.0, 20.0, 30.0)), {"drop_height_mm": -1.0}, "below 0"),
        (Box((10.0, 20.0, 30.0)), {"drop_height_mm": 1.0, "down": (0.0, 0.0, 0.0)}, "nowhere"),
    ],
)
def test_what_has_no_answer_is_said(shape: Shape, more: dict, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        stable_states(shape, **more)


def test_drops_with_one_seed_are_the_same_and_add_to_one() -> None:
    box = Box((10.0, 12.0, 15.0))
    first = stable_states(box, method="dynamic", drops=40, seed=7)
    assert first == stable_states(box, method="dynamic", drops=40, seed=7)
    assert first != stable_states(box, method="dynamic", drops=40, seed=8)
    assert sum(state.probability for state in first) == pytest.approx(1.0)
    for state in first:
        assert state.interval is not None
        assert state.interval[0] <= state.probability <= state.interval[1]


def test_size_does_not_matter_to_drops() -> None:
    small, large = (stable_states(Box((x, 1.2 * x, 2.0 * x)), method="dynamic", drops=20) for x in (1.0, 1000.0))
    assert [one.probability for one in small] == [one.probability for one in large]


HEXAGON = tuple((10.0 * math.cos(turn), 10.0 * math.sin(turn)) for turn in np.arange(6) * math.pi / 3.0)
COMPARED = (
    Box((10.0, 10.0, 10.0)),
    Box((10.0, 12.0, 14.0)),
    Box((10.0, 15.0, 25.0)),
    Box((10.0, 30.0, 30.0)),
    Cylinder(20.0, 5.0),
    Cylinder(20.0, 10.0),
    Extrusion(HEXAGON, 8.0),
    L_BRACKET,
)


def apart(shape: Shape, drops: int) -> float:
    """Mean square of the difference between counts and estimate."""
    fast = {one.normal: one.probability for one in stable_states(shape)}
    counted = stable_states(shape, method="dynamic", drops=drops)
    return sum((fast[one.normal] - one.probability) ** 2 for one in counted) / len(counted)


def test_drops_and_the_estimate_agree() -> None:
    assert math.sqrt(sum(apart(shape, 100) for shape in COMPARED) / len(COMPARED)) < 0.05


@pytest.mark.slow
def test_a_cube_dropped_often_is_fair() -> None:
    states = stable_states(Box((10.0, 10.0, 10.0)), method="dynamic", drops=1500, drop=Drop(restitution=0.3))
    # Chi-squared of six sides with five degrees of freedom: 20.5 is passed once in a thousand.
    assert sum((one.probability * 6.0 - 1.0) ** 2 for one in states) * 1500 / 6.0 < 20.5
