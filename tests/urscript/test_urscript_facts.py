"""Facts about the controller that nobody could check on one: the table of rules.py as tests, so that a correction has
one place and shows what it changes.
"""

from __future__ import annotations

from urscript_helpers import holds


def test_division_is_real_and_logic_stops_early() -> None:
    holds(
        "n = 0\ndef count():\nn = n + 1\nreturn True\nend\na = False and count()\nb = True or count()",
        "n == 0",
        "1 / 2 == 0.5",
    )


def test_pose_sub_is_what_pose_add_undoes() -> None:
    holds(
        "a = p[0.1, 0.2, 0.3, 0.4, 0.1, -0.3]\nb = p[0.3, -0.1, 0, 0, 0.5, 0.2]\nc = pose_add(b, pose_sub(a, b))",
        "point_dist(a, c) < 0.000001 and norm(a[3] - c[3]) < 0.000001 and norm(a[5] - c[5]) < 0.000001",
    )


def test_pose_dist_counts_the_angle_like_a_length() -> None:
    holds(
        "a = p[0, 0, 0, 0, 0, 0]\nb = p[3, 0, 0, 0, 0, 0]\nc = p[0.3, 0, 0, 0, 0, 0.4]",
        "norm(pose_dist(a, b) - 3) < 0.000001",
        "norm(pose_dist(a, c) - 0.5) < 0.000001",
    )


def test_lists_multiply_element_by_element() -> None:
    holds("a = [1, 2, 3] * [4, 5, 6]", "a[0] == 4 and a[1] == 10 and a[2] == 18")


def test_the_step_of_the_controller() -> None:
    holds("s = get_steptime()", "s == 0.002")


def test_old_numbers_of_the_tool() -> None:
    holds("set_digital_out(8, True)", "get_tool_digital_out(0) and not get_configurable_digital_out(0)")
