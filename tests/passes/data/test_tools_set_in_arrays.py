"""Tools that the program puts into the elements of an array: which one holds at a move is followed."""

from __future__ import annotations

import numpy as np
import pytest

from rpl import registry
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import matrix_to_zyx
from rpl.passes.legalise.places.postures.configurations import configurations

from .helpers import context, read
from .test_configurations import flags

JOINTS = [10, -70, 100, 20, 40, -30]
FIRST = "TOOL_DATA[1]={X 0.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\nTOOL_DATA[2]={X 0.0,Y 0.0,Z 900.0,A 0.0,B 0.0,C 0.0}"
SERVES = "DEF serve(F:OUT)\nFRAME F\nF.Z=F.Z+1.0\nEND\nDEF fill( )\nTOOL_DATA[1].Z=3.0\nEND\n"


@pytest.mark.parametrize(
    ("statements", "known"),
    [
        ("$TOOL=TOOL_DATA[2]", True),
        ("n=2\n$TOOL=TOOL_DATA[n]", True),
        ("fill( )\n$TOOL=TOOL_DATA[2]", False),  # another element is changed in part: the array is not known any more
        ("TOOL_DATA[1]={X 0.0,Y 0.0,Z 3.0,A 0.0,B 0.0,C 0.0}\n$TOOL=TOOL_DATA[2]", True),
        ("TOOL_DATA[n]={X 0.0,Y 0.0,Z 3.0,A 0.0,B 0.0,C 0.0}\n$TOOL=TOOL_DATA[2]", False),
        ("TOOL_DATA[2].Z=3.0\n$TOOL=TOOL_DATA[2]", False),
        ("serve(TOOL_DATA[2])\n$TOOL=TOOL_DATA[2]", False),
        ("IF $IN[1] THEN\nTOOL_DATA[2]=$NULLFRAME\nENDIF\n$TOOL=TOOL_DATA[2]", False),
        ("WHILE $IN[1]\nTOOL_DATA[2]=$NULLFRAME\nENDWHILE\n$TOOL=TOOL_DATA[2]", False),
    ],
)
def test_the_element_at_the_move(statements: str, known: bool) -> None:
    robot = load_robot("kuka_kr6r900sixx")
    tool = np.eye(4)
    tool[2, 3] = 900.0
    pose = robot.forward(JOINTS) @ tool
    (x, y, z), (a, b, c) = pose[:3, 3], matrix_to_zyx(pose)
    encode = registry.dialect("krl").notation()
    status = encode.encode(robot, np.array(JOINTS, float))  # type: ignore[union-attr]
    point = f"{{X {x:.6f},Y {y:.6f},Z {z:.6f},A {a:.6f},B {b:.6f},C {c:.6f},S {status['s']},T {status['t']}}}"
    data = f"DEFDAT t\nDECL FRAME TOOL_DATA[2]\nDECL POS P1={point}\nENDDAT\n"
    text = f"DEF t( )\nINT n\n{FIRST}\n{statements}\ngo( )\nEND\n{SERVES}DEF go( )\nPTP P1\nEND\n====\n{data}"
    program = read(text, "krl")
    surroundings = context(program, "krl", robot)
    done = configurations(program, surroundings)
    wanted = registry.dialect("rapid").notation().encode(robot, np.array(JOINTS, float))  # type: ignore[union-attr]
    found = flags(done, "P1")
    assert ({name: found[name] for name in wanted} == wanted) is known
    assert bool(surroundings.diagnostics.items) is not known
