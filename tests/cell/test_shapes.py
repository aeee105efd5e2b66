"""Forms: their facets against closed forms, their exact surfaces against distances."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpl.cell.shapes import Box, Capsule, Cylinder, Extrusion, Sphere

L = Extrusion(((0.0, 0.0), (30.0, 0.0), (30.0, 10.0), (10.0, 10.0), (10.0, 40.0), (0.0, 40.0)), 20.0)
FORMS = [
    (Box((10.0, 20.0, 30.0)), 6000.0),
    (Cylinder(20.0, 30.0), math.pi * 100.0 * 30.0),
    (Sphere(20.0), 4.0 / 3.0 * math.pi * 1000.0),
    (Capsule(20.0, 30.0), 4.0 / 3.0 * math.pi * 1000.0 + math.pi * 100.0 * 30.0),
    (L, 600.0 * 20.0),
]
coordinates = st.floats(-60.0, 60.0, allow_nan=False)


@pytest.mark.parametrize(("form", "volume"), FORMS)
def test_facets_enclose_the_volume_of_the_form(form, volume):
    """Facets of curved faces lie inside: at most 2.5 % are missing."""
    assert volume * 0.975 <= form.facets.volume <= volume * (1 + 1e-9)
    middle = form.facets.bounds.mean(axis=0)
    assert np.allclose(middle, 0.0, atol=1e-9)


def test_centre_of_mass_of_an_angle():
    """Two rectangles, 30 by 10 and 10 by 30, whose centres are weighed by their areas."""
    first, second = np.array([15.0, 5.0]), np.array([5.0, 25.0])
    centre = (first * 300.0 + second * 300.0) / 600.0 - np.array([15.0, 20.0])
    assert np.allclose(L.facets.centre, [*centre, 0.0], atol=1e-9)


@given(st.sampled_from([form for form, _ in FORMS]), st.tuples(coordinates, coordinates, coordinates))
def test_a_point_of_the_surface_is_its_own_nearest(form, point):
    there, normal = form.on_surface(np.array(point))
    again, _ = form.on_surface(there)
    assert np.allclose(again, there, atol=1e-6)
    assert math.isclose(float(np.linalg.norm(normal)), 1.0, abs_tol=1e-9)


@given(st.tuples(coordinates, coordinates, coordinates))
def test_exact_surface_is_as_near_as_the_facets_allow(point):
    """No facet of the faceted twin is nearer to a point outside than the true surface, which lies around it."""
    here = np.array(point)
    for form in (Cylinder(20.0, 30.0), Sphere(20.0), Capsule(20.0, 30.0)):
        there, _ = form.on_surface(here)
        faceted, _ = form.facets.on_surface(here)
        assert abs(np.linalg.norm(there - here) - np.linalg.norm(faceted - here)) < 0.25


def test_a_ray_meets_the_first_face():
    box = Box((10.0, 20.0, 30.0)).facets
    away, face = box.pierced(np.array([1.0, 2.0, 50.0]), np.array([0.0, 0.0, -1.0]))
    assert away == pytest.approx(35.0)
    assert box.normals[face] == pytest.approx([0.0, 0.0, 1.0])
    assert box.pierced(np.array([11.0, 2.0, 50.0]), np.array([0.0, 0.0, -1.0])) is None


def test_an_outline_that_crosses_itself_is_refused():
    with pytest.raises(ValueError, match="crosses itself"):
        Extrusion(((0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0), (-5.0, 5.0)), 5.0).facets  # noqa: B018
