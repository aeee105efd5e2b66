"""Joint moves to places without a posture: the one that the source's controller takes, or a warning."""

import pytest

from tests.there_and_back import there_and_back

ROBOT = "kuka_kr6r900sixx"
START = "MOVE TO {j1: -8.9, j2: -58, j3: 116, j4: 0, j5: 32, j6: -8.9}\n"
PLACE = "{x: 420, y: -60, z: 240, a: 0, b: 150, c: 0}"
BEHIND = "MOVE LINEAR BY {y: 100, x: 0, z: 0, a: 0, b: 0, c: 0} SPEED 250 mm/s\nSET do[1] TO $actual_joint[5] < 0\n"


def program(body: str) -> str:
    tool = "$tool = {x: 0, y: 0, z: 100, a: 0, b: 0, c: 0}"
    return f"ENTRY main\nPROCEDURE main()\n{tool}\n{body}END PROCEDURE\n"


@pytest.mark.parametrize("target", ["krl", "vplus", "rapid", "tp", "urscript", "rpl"])
@pytest.mark.parametrize(
    "body",
    [
        f"{START}MOVE TO {PLACE}\n{BEHIND}",
        # What turns the wrist over is known behind another move to a place too.
        f"{START}MOVE TO {PLACE}\nMOVE TO {{x: 420, y: -60, z: 240, a: 0, b: 170, c: 0}}\nMOVE TO {PLACE}\n{BEHIND}",
    ],
)
def test_the_wrist_turns_over_where_the_source_turns_it(body: str, target: str) -> None:
    trip = there_and_back({"main.rpl": program(body)}, "rpl", target, ROBOT)
    assert "posture-left-free" not in [one.code.name for one in trip.found]
    result = trip.run()
    assert result.status == "finished", result.fault
    assert trip.switched_on(result) == {1}


@pytest.mark.parametrize("target", ["krl", "vplus", "urscript", "rpl"])
def test_the_same_from_everywhere_is_taken_and_told(target: str) -> None:
    body = f"{START}MOVE LINEAR BY {{x: 0, y: 0, z: $time, a: 0, b: 0, c: 0}}\nMOVE TO {PLACE}\n{BEHIND}"
    trip = there_and_back({"main.rpl": program(body)}, "rpl", target, ROBOT)
    assert ("posture-as-from-known" in [one.code.name for one in trip.found]) is (target in ("krl", "vplus"))
    assert trip.switched_on(trip.run()) == {1}


@pytest.mark.parametrize(("target", "told"), [("krl", True), ("vplus", True), ("urscript", False), ("rpl", False)])
def test_what_is_not_known_is_told(target: str, told: bool) -> None:
    body = f"MOVE LINEAR BY {{x: 0, y: 0, z: $time, a: 0, b: 0, c: 0}}\nMOVE TO {PLACE}\n{BEHIND}"
    trip = there_and_back({"main.rpl": program(body)}, "rpl", target, ROBOT)
    assert ("posture-left-free" in [one.code.name for one in trip.found]) is told


def test_a_place_that_both_reach_alike_stays_a_place() -> None:
    body = f"{START}MOVE TO {{x: 500, y: 60, z: 270, a: 0, b: 180, c: 0}}\n"
    assert "PTP {X 500" in there_and_back({"main.rpl": program(body)}, "rpl", "krl", ROBOT).text
