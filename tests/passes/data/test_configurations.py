"""Arm configuration from one notation to the other, on one arm and on two."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rpl import ir, registry
from rpl.emulator.model import RobotModel, load_robot
from rpl.emulator.rotations import matrix_to_zyx
from rpl.passes.legalise.places.postures.configurations import configurations
from rpl.passes.legalise.places.postures.unreachable import unreachable_moves

from .helpers import context, lines, read, show, variable

POSTURES = [
    [10, -70, 100, 20, 40, -30],
    [-100, -60, 80, -120, 50, 200],
    [150, -110, 30, 95, -60, -170],
    [20, -150, -60, -15, 70, 10],
]


@pytest.fixture(scope="module")
def kuka() -> RobotModel:
    return load_robot("kuka_kr6r900sixx")


@pytest.fixture(scope="module")
def abb() -> RobotModel:
    return load_robot("abb_irb1600_6_12")


def krl_pos(robot: RobotModel, joints: list[float]) -> str:
    return registry.dialect("krl").notation().format_pose(robot, robot.forward(joints), np.array(joints, float))  # type: ignore[misc]


def flags(program: ir.Program, name: str) -> dict[str, int]:
    initial = variable(program, name).initial
    assert isinstance(initial, ir.Aggregate)
    entries = dict(initial.entries)
    if "conf" in entries:
        conf = entries["conf"]
        assert isinstance(conf, ir.Aggregate)
        entries = dict(conf.entries)
    return {
        name: value.value
        for name, value in entries.items()
        if isinstance(value, ir.IntLiteral) and name and name != "e"
    }


@pytest.mark.parametrize("joints", POSTURES)
def test_flags_name_the_same_posture(kuka: RobotModel, joints: list[float]) -> None:
    text = f"DEF t()\nPTP P1\nEND\n====\nDEFDAT t\nDECL POS P1={krl_pos(kuka, joints)}\nENDDAT\n"
    program = read(text, "krl")
    surroundings = context(program, "krl", kuka)
    done = configurations(program, surroundings)
    expected = registry.dialect("rapid").notation().encode(kuka, np.array(joints, float))  # type: ignore[misc]
    found = flags(done, "P1")
    assert {name: found[name] for name in expected} == expected
    assert not surroundings.diagnostics.items
    assert variable(done, "P1").type == ir.TargetType("rapid", external=False)
    assert variable(done, "P1").initial.type_name == "target rapid"  # type: ignore[union-attr]


def test_tool_and_base_of_the_moves_count(kuka: RobotModel) -> None:
    """The pose is given in a base that is turned half round, with a tool that reaches back over axis 1."""
    joints = [10, -70, 100, 20, 40, -30]
    flange = kuka.forward(joints)
    base, tool = np.diag([-1.0, -1.0, 1.0, 1.0]), np.eye(4)
    base[:3, 3], tool[:3, 3] = [100, 50, 0], [0, 0, 900]
    pose = np.linalg.inv(base) @ flange @ tool
    x, y, z = pose[:3, 3]
    a, b, c = matrix_to_zyx(pose)
    status = registry.dialect("krl").notation().encode(kuka, np.array(joints, float))  # type: ignore[misc]
    pos = f"{{X {x:.6f},Y {y:.6f},Z {z:.6f},A {a:.6f},B {b:.6f},C {c:.6f},S {status['s']},T {status['t']}}}"
    text = f"""DEF t()
INT n
settings()
FOR n=1 TO 3
  PTP P1
ENDFOR
END
DEF settings()
$TOOL=TOOL_DATA[2]
$BASE={{X 100,Y 50,Z 0,A 180,B 0,C 0}}
END
====
DEFDAT t
DECL FRAME TOOL_DATA[2]
TOOL_DATA[2]={{X 0,Y 0,Z 900,A 0,B 0,C 0}}
DECL POS P1={pos}
ENDDAT
"""
    program = read(text, "krl")
    surroundings = context(program, "krl", kuka)
    found = flags(configurations(program, surroundings), "P1")
    expected = registry.dialect("rapid").notation().encode(kuka, np.array(joints, float))  # type: ignore[misc]
    assert {name: found[name] for name in expected} == expected
    assert not surroundings.diagnostics.items


def test_without_an_arm_the_controller_keeps_the_nearest() -> None:
    text = "DEF t()\nPTP P1\nLIN P2\nEND\n====\nDEFDAT t\nDECL POS P1={X 400,Y 0,Z 500,A 0,B 90,C 0,S 2,T 10}\n"
    text += "DECL POS P2={X 400,Y 0,Z 500,A 0,B 90,C 0,S 2,T 10}\nENDDAT\n"
    program = read(text, "krl")
    surroundings = context(program, "krl")
    done = configurations(program, surroundings)
    assert [item.code.name for item in surroundings.diagnostics] == ["configuration-not-converted"]
    assert lines(done)[:2] == ["$joint_configuration_check := False", "$path_configuration_check := False"]
    assert show(variable(done, "P1").initial).endswith("conf {cf1 0, cf4 0, cf6 0, cfx 0}}")  # type: ignore[arg-type]


def test_a_tool_that_changes_cannot_be_followed(kuka: RobotModel) -> None:
    pos = krl_pos(kuka, POSTURES[0])
    text = "DEF t(k)\nINT k\n$TOOL=TOOL_DATA[k]\nPTP P1\nEND\n====\nDEFDAT t\nDECL FRAME TOOL_DATA[2]\n"
    text += f"DECL POS P1={pos}\nENDDAT\n"
    program = read(text, "krl")
    surroundings = context(program, "krl", kuka)
    configurations(program, surroundings)
    assert [item.message.count("tool") for item in surroundings.diagnostics] == [1]


def rapid_target(robot: RobotModel, joints: list[float]) -> str:
    return registry.dialect("rapid").notation().format_pose(robot, robot.forward(joints), np.array(joints, float))  # type: ignore[misc]


def test_rapid_to_krl_through_variables_and_parameters(abb: RobotModel) -> None:
    joints = [30, 20, 10, -100, 50, 200]
    text = f"""MODULE t
  CONST robtarget p1:={rapid_target(abb, joints)};
  PERS tooldata grip:=[TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  PROC go(robtarget q)
    MoveJ Offs(q,0,0,0),v100,fine,grip;
  ENDPROC
  PROC t()
    VAR robtarget p;
    p:=p1;
    go p;
    p.robconf:=p1.robconf;
  ENDPROC
ENDMODULE
"""
    program = read(text, "rapid")
    surroundings = context(program, "rapid", abb)
    done = configurations(program, surroundings)
    expected = registry.dialect("krl").notation().encode(abb, np.array(joints, float))  # type: ignore[misc]
    found = flags(done, "p1")
    assert {name: found[name] for name in expected} == expected
    assert not surroundings.diagnostics.items
    assert lines(done)[-2:] == ["p.s := p1.s", "p.t := p1.t"]


def test_flags_as_numbers_are_reported() -> None:
    text = (
        "MODULE t\nVAR robtarget p;\nPROC t()\nVAR num n;\np.robconf.cf1:=1;\nn:=p.robconf.cf6;\nENDPROC\nENDMODULE\n"
    )
    program = read(text, "rapid")
    surroundings = context(program, "rapid")
    done = configurations(program, surroundings)
    assert [item.code.name for item in surroundings.diagnostics] == ["configuration-field"] * 2
    assert lines(done) == ["Opaque", "Opaque", "n := 0"]


def test_joints_travel_to_another_arm_through_their_pose(kuka: RobotModel, abb: RobotModel) -> None:
    text = "DEF t()\nPTP {A1 10,A2 -80,A3 100,A4 5,A5 40,A6 20}\nPTP P1\nEND\n====\nDEFDAT t\n"
    text += f"DECL POS P1={krl_pos(kuka, [10, -80, 100, 5, 40, 20])}\n"
    text += "DECL POS FAR={X 2500,Y 0,Z 500,A 0,B 90,C 0,S 2,T 10}\nENDDAT\n"
    program = read(text.replace("PTP P1", "PTP P1\nPTP FAR"), "krl")
    surroundings = context(program, "krl", kuka, abb)
    done = configurations(program, surroundings)
    move = next(one for one in done.modules[0].routines[0].body if isinstance(one, ir.Move))
    assert isinstance(move.target, ir.Aggregate)
    joints = [value.value for _, value in move.target.entries if isinstance(value, ir.RealLiteral)]
    assert np.allclose(abb.forward(joints), kuka.forward([10, -80, 100, 5, 40, 20]), atol=1e-6)
    expected = registry.dialect("rapid").notation().encode(abb, np.array(joints))  # type: ignore[misc]
    assert {name: flags(done, "P1")[name] for name in expected} == expected
    assert not surroundings.diagnostics.items
    unreachable_moves(done, surroundings)
    reported = [(item.code.name, item.origin.line) for item in surroundings.diagnostics]
    assert reported == [("unreachable-on-target-arm", 4)]  # the move, not its datum


def test_only_the_move_whose_flags_are_unknown_goes_unchecked(kuka: RobotModel) -> None:
    text = "DEF t()\nPTP P1\nPTP P2\nEND\n====\nDEFDAT t\n"
    text += f"DECL POS P1={krl_pos(kuka, POSTURES[0])}\nDECL POS P2={{X 400,Y 0,Z 500,A 0,B 90,C 0}}\nENDDAT\n"
    program = read(text, "krl")
    surroundings = context(program, "krl", kuka)
    done = configurations(program, surroundings)
    assert lines(done) == [
        *("$path_configuration_check := False", "joint P1"),
        *("$joint_configuration_check := False", "joint P2", "$joint_configuration_check := True"),
    ]


def test_flags_that_an_offset_changes_are_left_out(abb: RobotModel) -> None:
    """The offset leads across axis 1 = 0: the sign bit of T would be wrong at one of the two places."""
    joints = [-1, 20, 10, 20, 50, 30]
    text = f"""MODULE t
  CONST robtarget p1:={rapid_target(abb, joints)};
  PERS tooldata grip:=[TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  PROC t()
    MoveJ p1,v100,fine,grip;
    %s Offs(p1,0,100,0),v100,fine,grip;
  ENDPROC
ENDMODULE
"""
    found = {}
    for move in ("MoveJ", "MoveL"):
        program = read(text % move, "rapid")
        surroundings = context(program, "rapid", abb)
        found[move] = sorted(set(flags(configurations(program, surroundings), "p1")) & {"s", "t"})
        assert not surroundings.diagnostics.items
    assert found == {"MoveJ": ["s"], "MoveL": ["s", "t"]}


@pytest.mark.parametrize("dialect", ["krl", "rapid"])
def test_the_same_language_on_another_arm_keeps_its_form(kuka: RobotModel, abb: RobotModel, dialect: str) -> None:
    joints = [10, -80, 100, 5, 40, 20]
    if dialect == "krl":
        text = f"DEF t()\nPTP P1\nEND\n====\nDEFDAT t\nDECL POS P1={krl_pos(kuka, joints)}\nENDDAT\n"
    else:
        text = f"MODULE t\nCONST robtarget P1:={rapid_target(kuka, joints)};\n"
        text += "PROC t()\nMoveJ P1,v100,fine,tool0;\nENDPROC\nENDMODULE\n"
    program = read(text, dialect)
    surroundings = context(program, dialect, kuka, abb)
    surroundings.target = dialect
    done = configurations(program, surroundings)
    reached = abb.inverse(kuka.forward(joints), abb.home)
    notation = registry.dialect(dialect).notation()  # type: ignore[misc]
    allowed = [notation.encode(abb, choice) for one in reached for choice in abb.expand_turns(one)]
    assert {name: value for name, value in flags(done, "P1").items() if name in notation.fields} in allowed
    assert variable(done, "P1").type == variable(program, "P1").type
    assert lines(done) == lines(program)


def test_a_program_with_a_task_beside_it_goes_unchecked_too(kuka: RobotModel) -> None:
    text = "DEF t()\nPTP P1\nEND\n====\nDEFDAT t\nDECL POS P1={X 400,Y 0,Z 500,A 0,B 90,C 0}\nENDDAT\n"
    program = read(text, "krl")
    beside = ir.Routine("sps", body=(ir.Nothing(),))
    module = replace(program.modules[0], name="sps", declarations=(), routines=(beside,), task="sps")
    program = replace(program, modules=(*program.modules, module), tasks=(ir.Task("sps", "sps", "background"),))
    done = configurations(program, context(program, "krl", kuka))
    assert lines(done)[:2] == ["$joint_configuration_check := False", "$path_configuration_check := False"]


CARRIED = """DEF t()
DECL POS P
INT N
N=2
P=SHIFT[N]:P1
%s
PTP P
END
====
DEFDAT t
DECL FRAME SHIFT[2]
SHIFT[1]={X 50,Y 0,Z 0,A 0,B 0,C 0}
SHIFT[2]={X -50,Y 0,Z 0,A 0,B 0,C 0}
DECL POS P1=%s
ENDDAT
"""


@pytest.mark.parametrize(
    ("statement", "codes", "unchecked"),
    [
        ("P.S=P1.S", [], False),
        ("P.T=P1.T", [], False),
        ("P.S=2", [], False),  # that is what P1 has
        ("P.T=3", ["configuration-without-turns"], True),
        ("P.S=N", ["configuration-field"], False),
        ("P.S=6", ["configuration-field"], False),
    ],
)
def test_flags_carried_to_a_computed_place(kuka: RobotModel, statement: str, codes: list[str], unchecked: bool) -> None:
    """What a place has already is not set again; how far axes turn is left to the controller; a posture is not."""
    pos = krl_pos(kuka, [10, -70, 100, 20, 40, -30])
    assert "S 2" in pos
    program = read(CARRIED % (statement, pos), "krl")
    surroundings = context(program, "krl", kuka)
    done = configurations(program, surroundings)
    assert [item.code.name for item in surroundings.diagnostics] == codes
    assert ("Opaque" in lines(done)) == ("configuration-field" in codes)
    assert ("$joint_configuration_check := False" in lines(done)) == unchecked


def test_a_flag_that_is_always_the_same_is_a_number(kuka: RobotModel) -> None:
    pos = krl_pos(kuka, [10, -70, 100, 20, 40, -30])
    text = CARRIED % ("N=P.S\nPTP P\nP=$POS_ACT\nN=P.T", pos)
    for wanted, program in ((["Opaque"] * 2, read(text, "krl")), ([], read(text.replace("P=$POS_ACT\n", ""), "krl"))):
        surroundings = context(program, "krl", kuka)
        done = configurations(program, surroundings)
        assert [line for line in lines(done) if line == "Opaque"] == wanted
        assert lines(done).count("N := 2") == (1 if wanted else 2)


def test_the_flags_of_a_computed_place_are_those_of_the_taught_one(kuka: RobotModel) -> None:
    """A function carries the posture of the taught place; the turns differ, so that only the posture is a number."""
    pos = krl_pos(kuka, [10, -70, 100, 20, 40, -30])
    text = "DEF t()\nDECL E6POS NOW\nDECL INT N\nNOW=place(2)\nN=NOW.%s\nEND\n"
    text += "DEFFCT E6POS place(k:IN)\nINT k\nDECL E6POS q\nq=SHIFT[k]:P1\nq.S=P1.S\nq.T=k\nRETURN (q)\nENDFCT\n====\n"
    text += "DEFDAT t\nDECL FRAME SHIFT[2]\nSHIFT[1]={X 50,Y 0,Z 0,A 0,B 0,C 0}\nSHIFT[2]={X 0,Y 9,Z 0,A 0,B 0,C 0}\n"
    text += f"DECL E6POS P1={pos[:-1]},E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}}\nENDDAT\n"
    for flag, refused in (("S", False), ("T", True)):
        program = read(text % flag, "krl")
        surroundings = context(program, "krl", kuka)
        done = configurations(program, surroundings)
        assert ("Opaque" in lines(done)) == refused
        assert ("N := 2" in lines(done)) == (not refused)
