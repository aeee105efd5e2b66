"""Arm configuration that is read: worked out beside the target, by what the controller itself would show."""

from __future__ import annotations

import numpy as np
import pytest

from rpl import ir, registry
from rpl.emulator.model import load_robot
from rpl.emulator.postures import posture_facts
from rpl.passes.legalise.places.postures.flagreadings import flag_readings

from .helpers import context, read

ARMS = ("kuka_kr6r900sixx", "abb_irb1200_5_90", "fanuc_lrmate200id")


@pytest.mark.parametrize("name", ARMS)
def test_the_facts_say_what_the_posture_says(name: str) -> None:
    arm = load_robot(name)
    facts = posture_facts(arm)
    chance = np.random.default_rng(7)
    for _ in range(200):
        joints = arm.limits[:, 0] + chance.random(arm.axes) * (arm.limits[:, 1] - arm.limits[:, 0])
        posture = arm.posture(joints)
        for fact, found in facts.items():
            angles = [np.radians(np.dot(one.factors, joints) + one.offset) for one in found.sines]
            total = found.constant + sum(
                one.amplitude * np.sin(angle) for one, angle in zip(found.sines, angles, strict=True)
            )
            assert (total < 0) == getattr(posture, fact), (fact, joints)
            for one, angle in zip(found.sines, angles, strict=True):
                assert not one.narrow or abs(angle) < np.pi


def test_another_build_has_no_facts() -> None:
    assert posture_facts(load_robot("ur5e")) == {}


KRL = """DEF t()
DECL POS NOW
DECL INT N
NOW = $POS_ACT
N = NOW.S
NOW = $POS_ACT
NOW = {X 1,Y 2,Z 3,A 0,B 0,C 0,S 6,T 35}
N = NOW.T
END
"""
RAPID = """MODULE t
PROC t()
VAR robtarget p;
VAR num n;
p:=Offs(CRobT(\\Tool:=tool0\\WObj:=wobj0),0,0,10);
n:=p.robconf.cf4;
ENDPROC
ENDMODULE
"""
TAKEN_OUT = """DEF t()
DECL POS NOW
DECL INT N
NOW = $POS_ACT
OTHER(NOW)
N = NOW.S
END
DEF OTHER(P:OUT)
DECL POS P
P.S = 2
END
"""


def flags_read(program: ir.Program) -> int:
    found = 0

    def look(node: object) -> None:
        nonlocal found
        if isinstance(node, ir.Field) and node.name in ("s", "t", "cf4"):
            found += 1

    from rpl.ir.walk import walk

    for node in walk(program):
        look(node)
    return found


@pytest.mark.parametrize(("text", "dialect", "left"), [(KRL, "krl", 0), (RAPID, "rapid", 0), (TAKEN_OUT, "krl", 2)])
def test_readings_become_numbers_where_they_can_be_known(text: str, dialect: str, left: int) -> None:
    arm = load_robot("kuka_kr6r900sixx" if dialect == "krl" else "abb_irb1200_5_90")
    program = read(text, dialect)
    assert flags_read(flag_readings(program, context(program, dialect, arm))) == left


def test_only_the_value_that_is_read_is_worked_out() -> None:
    program = read(KRL, "krl")
    done = flag_readings(program, context(program, "krl", load_robot("kuka_kr6r900sixx")))
    body = done.modules[0].routines[0].body
    sets = [one.value for one in body if isinstance(one, ir.Assign) and one.target == ir.Name("NOW_s")]
    assert [one.value for one in sets if isinstance(one, ir.IntLiteral)] == [0, 6]


def test_flag_terms_name_known_facts() -> None:
    facts = set(posture_facts(load_robot("kuka_kr6r900sixx"))) | {"elbow_above_stretched", "negative", "quarter"}
    for name in registry.dialect_names():
        terms = registry.dialect(name).flag_terms("")
        assert {fact for parts in terms.values() for _, fact, _ in parts} <= facts
