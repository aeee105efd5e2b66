"""Enumerations as constants."""

from __future__ import annotations

from there_and_back import there_and_back

from rpl import ir
from rpl.passes.legalise.statements.enums import enums_to_constants

from .helpers import context, lines, read, variable

PROGRAM = """DEF t()
DECL COLOR c
DECL STATE s
DECL INT n
c=#RED
IF c==#GREEN THEN
 n=1
ENDIF
SWITCH c
 CASE #RED
  n=2
 DEFAULT
  n=3
ENDSWITCH
s=#STOPPED
use(#GREEN)
END
DEF use(k:IN)
DECL COLOR k
END
====
DEFDAT t
ENUM COLOR RED,GREEN,BLUE
ENUM STATE IDLE,STOPPED,BLUE
INT STOPPED2=0
DECL COLOR last=#BLUE
ENDDAT
"""


def test_members_become_constants_numbered_per_enumeration() -> None:
    program = read(PROGRAM, "krl")
    done = enums_to_constants(program, context(program, "krl"))
    values = {name: variable(done, name).initial for name in ("RED", "GREEN", "BLUE", "IDLE", "STOPPED")}
    numbers = {name: value.value for name, value in values.items() if isinstance(value, ir.IntLiteral)}
    assert numbers == {"RED": 1, "GREEN": 2, "BLUE": 3, "IDLE": 1, "STOPPED": 2}
    assert all(variable(done, name).storage == "constant" for name in numbers)
    assert variable(done, "BLUE").scope == "global"
    assert not any(isinstance(d, ir.EnumDeclaration) for m in done.modules for d in m.declarations)


def test_statements_and_types_follow() -> None:
    program = read(PROGRAM, "krl")
    done = enums_to_constants(program, context(program, "krl"))
    assert lines(done) == [
        *("c := RED", "if (c = GREEN)", "  n := 1", "switch c", "case RED", "  n := 2", "default", "  n := 3"),
        *("s := STOPPED", "use(GREEN)"),
    ]
    assert variable(done, "c").type == ir.IntType()
    assert done.modules[0].routines[1].parameters[0].type == ir.IntType()
    assert variable(done, "last").initial == ir.Name("BLUE")


def test_a_taken_name_is_avoided_and_the_pass_is_idempotent() -> None:
    program = read(
        "DEF t()\nDECL C v\nDECL INT red\nv=#RED\nred=1\nEND\n====\nDEFDAT t\nENUM C RED,BLACK\nENDDAT\n", "krl"
    )
    surroundings = context(program, "krl")
    done = enums_to_constants(program, surroundings)
    assert lines(done) == ["v := RED2", "red := 1"]
    assert enums_to_constants(done, surroundings) == done


def test_shared_members_that_collide_are_numbered_through() -> None:
    text = "DEF t()\nEND\n====\nDEFDAT t\nENUM A X,Y\nENUM B Z,X\nENUM D Z,Y\nENUM E Y,Z,X\n"
    text += "DECL E p=#X\nDECL E q=#Y\nDECL E r=#Z\nENDDAT\n"
    program = read(text, "krl")
    done = enums_to_constants(program, context(program, "krl"))
    numbers = [variable(done, name).initial for name in "XYZ"]
    assert len({n.value for n in numbers if isinstance(n, ir.IntLiteral)}) == 3


def test_a_target_with_enumerations_keeps_them() -> None:
    program = read(PROGRAM, "krl")
    surroundings = context(program, "rapid")
    assert enums_to_constants(program, surroundings) is program


def test_members_that_only_the_controllers_own_data_share_leave_no_constant() -> None:
    """`BASE` belongs to two enumerations of what every KUKA controller declares."""
    files = {
        "main.src": "DEF main()\n  FDAT_ACT=FP1\n  BAS(#PTP_PARAMS,50)\n  PTP XP1\nEND\n",
        "main.dat": (
            "DEFDAT main\nDECL E6AXIS XP1={A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}\n"
            'DECL FDAT FP1={TOOL_NO 1,BASE_NO 1,IPO_FRAME #BASE,POINT2[] " ",TQ_STATE FALSE}\nENDDAT\n'
        ),
    }
    journey = there_and_back(files, "krl", "rapid", "kuka_kr10r1100sixx")
    assert "BASE" not in "".join(file.data.decode() for file in journey.written.files if file.path.endswith(".mod"))
