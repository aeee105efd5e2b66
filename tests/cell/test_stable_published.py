"""The fast estimator against published throws of cuboids, beside what plainer rules make of the same figures."""

import math
from collections.abc import Callable

import pytest

from rpl.cell.shapes import Box, Cylinder
from rpl.cell.stable import stable_states

# Height over side of a square cuboid, how often a square face was up, throws. F. Budden, Throwing Non-Cubical Dice, The
# Mathematical Gazette 64 (1980), as reprinted in Table 1 of note 97.16, Probability Analysis for Rolls of a Square
# Cuboidal Die, The Mathematical Gazette, March 2013. Seen in the text of the note; the article of 1980 was not seen:
# its author, title and volume are from memory.
BUDDEN = (
    (0.47, 0.916, 332),
    (0.63, 0.738, 840),
    (0.75, 0.548, 799),
    (0.81, 0.496, 740),
    (0.93, 0.399, 516),
    (0.97, 0.385, 530),
    (1.16, 0.148, 1011),
    (1.23, 0.154, 532),
    (1.44, 0.052, 654),
    (1.55, 0.040, 606),
    (1.60, 0.017, 702),
    (1.71, 0.031, 609),
    (1.87, 0.009, 680),
    (2.12, 0.007, 275),
    (2.65, 0.006, 503),
)


def rms(errors: list[float]) -> float:
    return math.sqrt(sum(one * one for one in errors) / len(errors))


def square_faces(ratio: float) -> float:
    states = stable_states(Box((10.0, 10.0, 10.0 * ratio)))
    return sum(state.probability for state in states if abs(state.normal[2]) > 0.9)


def angle(a: float, b: float, distance: float) -> float:
    """Solid angle of a rectangle with these sides seen from above its middle."""
    return 4.0 * math.atan(a * b / (4.0 * distance) / math.sqrt((a * a + b * b) / 4.0 + distance**2))


def by_angle(ratio: float) -> float:
    square, other = 2.0 * angle(1.0, 1.0, ratio / 2.0), 4.0 * angle(1.0, ratio, 0.5)
    return square / (square + other)


def by_angle_over_height(ratio: float) -> float:
    """Ngoi and others, Analyzing the Natural Resting Aspects of a Component by Its Centroid Solid Angle, Journal of
    Electronics Manufacturing 5 (1995), seen in its abstract: as the solid angle over the height of the centroid."""
    square, other = 2.0 * angle(1.0, 1.0, ratio / 2.0) / ratio, 4.0 * angle(1.0, ratio, 0.5)
    return square / (square + other)


def by_angle_and_lowest_barrier(ratio: float) -> float:
    slant, corner = math.hypot(ratio, 1.0) / 2.0, math.sqrt(0.5)
    square = 2.0 * angle(1.0, 1.0, ratio / 2.0) * (slant - ratio / 2.0)
    other = 4.0 * angle(1.0, ratio, 0.5) * (min(slant, corner) - 0.5)
    return square / (square + other)


RULES = (
    (by_angle, 0.147),
    (by_angle_over_height, 0.081),
    (by_angle_and_lowest_barrier, 0.074),
    (square_faces, 0.036),
)


@pytest.mark.parametrize(("rule", "expected"), RULES)
def test_rms_against_published_throws(rule: Callable[[float], float], expected: float) -> None:
    assert rms([rule(ratio) - found for ratio, found, _ in BUDDEN]) == pytest.approx(expected, abs=0.0006)


def test_a_die_that_is_a_little_flat_shows_its_large_faces_more_often() -> None:
    """Experimentally Obtained Statistics of Dice Rolls, 6th Experimental Chaos Conference, 2001 (its abstract seen, at
    dicephysics.info): the distance of two faces is 3 % shorter, they come up 6 % more often."""
    assert square_faces(0.97) * 3.0 == pytest.approx(1.06, abs=0.03)


@pytest.mark.parametrize("ratio", [1.2, 1.6, 2.0, 3.0])
def test_a_long_bar_follows_the_rule_for_two_dimensions(ratio: float) -> None:
    """Pender and Uhrin, Predicting Non-Square 2D Dice Probabilities, arXiv:1407.6307 (2014), seen in its abstract: the
    probabilities of the two kinds of sides are as their angles times their energy barriers."""
    short, long = 1.0, ratio
    states = stable_states(Box((10.0 * short, 10.0 * long, 100_000.0)))
    on_long = sum(state.probability for state in states if abs(state.normal[0]) > 0.9)
    on_short = sum(state.probability for state in states if abs(state.normal[1]) > 0.9)
    slant = math.hypot(short, long)
    expected = (slant - short) / (slant - long) * math.atan(long / short) / math.atan(short / long)
    assert on_long / on_short == pytest.approx(expected, rel=1e-3)


def test_a_coin_with_three_fair_sides_is_as_thick_as_others_find() -> None:
    """Without bounce a fair coin is between 1 / (2 sqrt 2) and 1 / sqrt 3 of its diameter thick, as it is not spun or
    spun fast: E. H. Yong and L. Mahadevan, Probability, Geometry, and Dynamics in the Toss of a Thick Coin, American
    Journal of Physics 79 (2011); the two figures seen where the paper is quoted, its abstract seen itself."""

    def on_side(thickness: float) -> float:
        return next(one.probability for one in stable_states(Cylinder(20.0, 20.0 * thickness)) if one.height_mm == 10.0)

    assert on_side(0.5 / math.sqrt(2.0)) < 1.0 / 3.0 < on_side(1.0 / math.sqrt(3.0))


@pytest.mark.slow
def test_drops_come_near_published_throws() -> None:
    errors = []
    for ratio, found, _ in BUDDEN:
        states = stable_states(Box((10.0, 10.0, 10.0 * ratio)), method="dynamic", drops=400)
        errors.append(sum(one.probability for one in states if abs(one.normal[2]) > 0.9) - found)
    assert rms(errors) < 0.06
