"""Waiting for the robot where the move before went round a corner that nothing follows."""

from test_inform_from_others import jobs_of

TEXT = """VAR p: ARRAY[2] OF POSE = {{x: 400, y: -100, z: 300, a: 0, b: 180, c: 0},
                           {x: 400, y: 100, z: 300, a: 0, b: 180, c: 0}}
VAR i: INT
VAR here: POSE
MOVE TO p[1]
FOR i = 1 TO 2
    MOVE LINEAR TO p[i] SPEED 100 mm/s BLEND 15 mm
END FOR
WAIT FOR MOTION
here = current_target()
SET do[1] TO abs(here.y - 100) < 0.5
MOVE LINEAR TO p[1] SPEED 100 mm/s BLEND 15 mm
stand()
here = current_target()
SET do[2] TO abs(here.y + 100) < 0.5

PROCEDURE stand()
    WAIT FOR MOTION
END PROCEDURE
"""


def test_the_robot_is_at_its_point() -> None:
    jobs, _, met = jobs_of("rpl", TEXT)
    assert met == {1, 2}
    assert not [line for line in jobs["STAND"] if line.startswith(("IMOV", "TIMER"))]


def test_without_corners_nothing_is_driven() -> None:
    jobs, _, met = jobs_of("rpl", TEXT.replace(" BLEND 15 mm", ""))
    assert met == {1, 2}
    assert not [line for line in jobs["STAND"] if line.startswith(("IMOV", "TIMER"))]
