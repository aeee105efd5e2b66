"""Values of constants, rotations of literals, and arithmetic identities."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rpl import ir
from rpl.emulator.rotations import quaternion_to_matrix, zyx_to_matrix
from rpl.passes import rigid
from rpl.passes.fold import constant, simplify
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Record, Target

from .helpers import read, show

DATA = """MODULE t
  CONST num two:=2;
  CONST num four:=two*two;
  CONST num loop:=loop+1;
  VAR num changing:=1;
  PERS num never:=7;
  CONST pos corner:=[1,two,3];
  CONST robtarget p:=[[1,2,3],[0,0,1,0],[1,-1,0,4],[9E9,5,9E9,9E9,9E9,9E9]];
  CONST num row{2,2}:=[[1,2],[3,4]];
  PROC t()
    VAR num n;
    changing:=2;
    n:=%s;
  ENDPROC
ENDMODULE
"""


def scope_and_value(text: str) -> tuple[ir.Program, Scope, ir.Expression]:
    program = read(DATA % text, "rapid")
    module = program.modules[0]
    statement = module.routines[-1].body[-1]
    assert isinstance(statement, ir.Assign)
    return program, ProgramScope(program).routine(module, module.routines[-1]), statement.value


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("four+1", 5),
        ("7 DIV two", 3),
        ("-7 DIV 2", -3),
        ("7/2", 3.5),
        ("-7 MOD 3", -1),
        ("row{2,1}", 3),
        ("row{3,1}", None),
        ("p.trans.y", 2.0),
        ("p.robconf.cfx", 4),
        ("p.extax.eax_b", 5.0),
        ("Round(2.5)+Round(-2.5)", 0),
        ("Distance(corner,[1,2,0])", 3.0),
        ("1/0", None),
        ("changing", None),
        ("never", None),
        ("loop", None),
        ("v100.v_tcp", 100),
        ("n", None),
    ],
)
def test_constants(text: str, expected: float | None) -> None:
    _, scope, value = scope_and_value(text)
    found = constant(value, scope)
    assert found == (None if expected is None else pytest.approx(expected))


def test_what_nothing_assigns_is_constant_when_asked() -> None:
    program, scope, value = scope_and_value("never+changing")
    unchanged = unchanged_in(program)
    assert isinstance(value, ir.Binary)
    assert constant(value.left, scope, unchanged) == 7
    assert constant(value.right, scope, unchanged) is None
    assert constant(value, scope, unchanged, {"changing": 3}) == 10


def test_a_data_list_sets_elements() -> None:
    text = "DEF t()\nn=BASE_D[2].X\nEND\n====\nDEFDAT t\nINT n\nFRAME BASE_D[3]\n"
    text += "BASE_D[2]={X 5,Y 0,Z 0,A 0,B 0,C 90}\nENDDAT\n"
    program = read(text, "krl")
    module = program.modules[0]
    statement = module.routines[0].body[0]
    scope = ProgramScope(program).routine(module, module.routines[0])
    assert isinstance(statement, ir.Assign)
    value = statement.value.operand if isinstance(statement.value, ir.Convert) else statement.value
    assert constant(value, scope, unchanged_in(program)) == 5


def test_structures() -> None:
    program, scope, value = scope_and_value("p.trans.x")
    assert isinstance(value, ir.Field)
    assert isinstance(value.base, ir.Field)
    target = constant(value.base.base, scope)
    assert isinstance(target, Target)
    assert target.flags == (("cf1", 1), ("cf4", -1), ("cf6", 0), ("cfx", 4))
    tool = constant(ir.Name("tool0"), scope, unchanged_in(program))
    assert isinstance(tool, Record)
    assert tool.part("held") is True


IDENTITIES = {
    "v100.v_tcp": "v100.path",
    "n+0": "n",
    "0+n": "n",
    "n*1": "n",
    "n-0": "n",
    "-(-n)": "n",
    "n+1": "(n + 1)",
}


@pytest.mark.parametrize("text", IDENTITIES)
def test_identities(text: str) -> None:
    _, scope, value = scope_and_value(text)
    assert show(simplify(value, scope)) == IDENTITIES[text]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (ir.Quantity(ir.RealLiteral(0.25), "m/s"), "250.0"),
        (ir.Quantity(ir.RealLiteral(250.0, "250.0"), "mm/s"), "250.0"),
        (ir.Quantity(ir.Magnitude(ir.Name("n"), "m/s"), "m/s"), "n"),
        (ir.Magnitude(ir.Quantity(ir.Name("n"), "m/s"), "mm/s"), "(n * 1000.0)"),
        (ir.Magnitude(ir.Name("n"), "m/s"), "(n / 1000.0)"),
        (ir.Quantity(ir.Unary("-", ir.IntLiteral(3)), "m"), "-3000.0"),
    ],
)
def test_units(expression: ir.Expression, expected: str) -> None:
    _, scope, _ = scope_and_value("n")
    assert show(simplify(expression, scope)) == expected


def test_a_literal_keeps_its_spelling_where_the_unit_stays() -> None:
    _, scope, _ = scope_and_value("n")
    kept = simplify(ir.Quantity(ir.RealLiteral(0.5, ".50"), "s"), scope)
    assert isinstance(kept, ir.RealLiteral)
    assert kept.spelling == ".50"


ANGLE = st.one_of(st.sampled_from([0.0, 90.0, -90.0, 180.0, 45.0]), st.floats(-180, 180, width=32))


@given(st.tuples(ANGLE, ANGLE, ANGLE))
def test_rotations_agree_with_the_emulator_and_come_back(angles: tuple[float, float, float]) -> None:
    rotation = rigid.rotation_of_zyx(*angles)
    matrix = zyx_to_matrix(angles)
    assert np.allclose(rotation.rows, matrix, atol=1e-9)
    assert np.allclose(quaternion_to_matrix(rotation.quaternion), matrix, atol=1e-9)
    back = rigid.quaternion_to_zyx(rotation.quaternion)
    assert np.allclose(zyx_to_matrix(back), matrix, atol=1e-6)
    assert np.allclose(rigid.rotation_of_rows(rotation.rows).rows, matrix, atol=1e-9)


@given(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(ANGLE, ANGLE, ANGLE))
def test_a_pose_times_its_inverse_is_none(
    first: tuple[float, float, float], second: tuple[float, float, float]
) -> None:
    pose = rigid.Pose(rigid.Vector(*second), rigid.rotation_of_zyx(*first))
    assert np.allclose(pose.then(pose.inverse).matrix, np.eye(4), atol=1e-9)
    assert np.allclose(rigid.pose_of_matrix(pose.matrix).matrix, pose.matrix, atol=1e-9)
