"""The family of a posture (front or back, elbow, wrist) on another arm, and flags that no posture inside limits has.

Sources: ABB RAPID Reference Manual, confdata; FANUC CONFIG as in dialects/tp/configuration.py (an angle of exactly 180
degrees is turn 1)."""

from __future__ import annotations

import numpy as np
import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.passes.legalise.places.postures.configurations import configurations
from rpl.passes.legalise.places.postures.families import differing
from rpl.project import ReadProgram, read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

from .helpers import context, read

ABB, KUKA, FANUC = (load_robot(name) for name in ("abb_irb1200_5_90", "kuka_kr6r900sixx", "fanuc_lrmate200id"))
KEPT = [10.0, 20, 10, 20, 50, 30]
# In front on the first arm, where the second one does not come but over its back.
OVER = [58.0, 41, 12, -11, -123, 27]


def retargeted(joints: list[float]) -> tuple[ir.Program, list[tuple[str, int, str]]]:
    axes = ",".join(f"{one:g}" for one in joints)
    data = f"CONST jointtarget j:=[[{axes}],[9E9,9E9,9E9,9E9,9E9,9E9]];"
    program = read(f"MODULE t\n{data}\nPROC t()\nMoveAbsJ j,v100,fine,tool0;\nENDPROC\nENDMODULE\n", "rapid")
    surroundings = context(program, "rapid", ABB, KUKA)
    done = configurations(program, surroundings)
    return done, [(item.code.name, item.origin.line, item.message) for item in surroundings.diagnostics]


def test_a_family_that_is_kept_is_not_told() -> None:
    _, told = retargeted(KEPT)
    assert told == []


def test_another_family_is_told_at_its_point() -> None:
    _, told = retargeted(OVER)
    assert [(name, line) for name, line, _ in told] == [("posture-changed", 2)]
    assert "in front of axis 1, elbow up becomes behind axis 1, elbow down" in told[0][2]


def test_the_shoulder_is_kept_before_elbow_and_wrist() -> None:
    """Where the same family is out of the limits, but one on the same side of axis 1 is not, that one is taken."""
    flange = ABB.forward(np.array(OVER))
    branches = [ABB.posture(one.joints).branch for one in ABB.inverse(flange, ABB.home)]
    first = branches[0]
    ranked = sorted(branches, key=lambda one: differing(first, one))
    assert [one.shoulder == first.shoulder for one in ranked] == [True] * 4 + [False] * 4


def position(flags: str, joints: list[float]) -> str:
    notation = registry.dialect("tp").notation()  # type: ignore[misc]
    x, y, z, w, p, r = notation.values_of(FANUC.forward(np.array(joints))[None])[0]
    return (
        f"P[1]{{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : '{flags}',\n"
        f"\tX = {x:9.3f}  mm,\tY = {y:9.3f}  mm,\tZ = {z:9.3f}  mm,\n"
        f"\tW = {w:9.3f} deg,\tP = {p:9.3f} deg,\tR = {r:9.3f} deg\n}};\n"
    )


def told_of(flags: str, joints: list[float], target: str) -> list[tuple[str, str]]:
    head = "/PROG  T\n/ATTR\nDEFAULT_GROUP\t= 1,*,*,*,*;\n/MN\n   1:J P[1] 50% FINE ;\n/POS\n"
    text = f"{head}{position(flags, joints)}/END\n"
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("t.ls", text)], "tp", diagnostics).program
    translate_program(ReadProgram(program, program, (), (), ("tp",)), target, FANUC.name, None, diagnostics)
    return [(item.code.name, item.severity.name) for item in diagnostics if "unreach" in item.code.name]


STRAIGHT_TURN = [0.0, 20.0, -20.0, 0.0, -50.0, 180.0]  # J6 at exactly half a turn is turn 1


@pytest.mark.parametrize("target", ["rapid", "krl"])
def test_flags_whose_turn_no_solution_has_are_a_guarded_stop(target: str) -> None:
    """Turn 2 of J6 begins at 540 degrees; the arm's axis ends at 360."""
    assert told_of("N U T, 0, 0, 0", [0.0, 20.0, -20.0, 0.0, -50.0, 30.0], target) == []
    assert told_of("N U T, 0, 0, 2", [0.0, 20.0, -20.0, 0.0, -50.0, 30.0], target) == [
        ("unreachable-on-target-arm", "LOSS")
    ]


def test_half_a_turn_is_turn_one() -> None:
    assert told_of("N U T, 0, 0, 1", STRAIGHT_TURN, "rapid") == []
    assert told_of("N U T, 0, 0, 0", STRAIGHT_TURN, "rapid") == [("unreachable-on-target-arm", "LOSS")]
