"""Runs of cells made by hand: one arm, a table, a bin, a part that is carried and falls."""

from __future__ import annotations

from functools import cache

import numpy as np

from rpl.cell.layout import Body, Fixture, Gripper, Layout, Part, RobotPlace
from rpl.cell.shapes import Box, Cylinder
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import FloatArray
from rpl.simulation import run_program
from rpl.workcell.record import CellRun, Grasp, Opening, Placed, RobotRun
from tests.runtime.helpers import KUKA, read

PROGRAM = """DEF prog( )
$VEL.CP=0.2
$TOOL={X 0,Y 0,Z 120,A 0,B 0,C 0}
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
$OUT[3]=TRUE
LIN_REL {Z -120} C_DIS
LIN_REL {Y 300}
$OUT[3]=FALSE
WAIT SEC 0.5
END
"""


def at(x: float, y: float, z: float) -> FloatArray:
    pose = np.eye(4)
    pose[:3, 3] = (x, y, z)
    return pose


LAYOUT = Layout(
    robots=(RobotPlace(arm=KUKA, base=at(0.0, 100.0, 0.0)),),
    grippers=(
        Gripper("jaws", "jaws", grip=at(0.0, 0.0, 120.0), bodies=(Body(Box((60.0, 90.0, 80.0)), at(0, 0, 40)),)),
    ),
    fixtures=(
        Fixture("table", (Body(Box((600.0, 800.0, 40.0)), at(600.0, 0.0, -20.0)),)),
        Fixture("bin", (Body(Box((10.0, 300.0, 100.0)), at(350.0, 300.0, 50.0)),), inside=(300.0, 300.0, 100.0)),
    ),
    parts=(Part("plug", Cylinder(30.0, 60.0), at(500.0, 0.0, 30.0)),),
)
IN_HAND = at(0.0, 0.0, 120.0)


@cache
def cell_run() -> CellRun:
    """The arm drives with a part in its jaws from 1 s to 2 s, which then falls for half a second."""
    model = load_robot(KUKA)
    program = read("krl", PROGRAM)
    result = run_program(program, model)
    return CellRun(
        LAYOUT,
        (RobotRun(LAYOUT.robots[0], model, program, result),),
        placed=(
            Placed(0.0, "plug", "rests", at(500.0, 0.0, 30.0), "table"),
            Placed(1.0, "plug", "held", IN_HAND, "jaws"),
            Placed(2.0, "plug", "falls", at(400.0, 0.0, 430.0)),
            Placed(2.5, "plug", "rests", at(400.0, 0.0, 30.0), "table"),
        ),
        grasps=(Grasp(1.0, "jaws", "plug", True), Grasp(2.2, "jaws", "", False, "nothing between the jaws")),
        openings=(Opening(1.0, "jaws", False, 30.0), Opening(2.0, "jaws", True, 80.0)),
        status=result.status,
        time_s=result.time_s,
    )
