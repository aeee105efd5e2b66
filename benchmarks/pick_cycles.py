"""Pick cycles that makers state (25 mm up, 300 mm across, 25 mm down, and back) against the emulation.

python benchmarks/pick_cycles.py          prints the table of docs/fidelity.md
python benchmarks/pick_cycles.py --write  puts it there

Source of the stated times: data sheets. Makers tune such a cycle (its place, its arch, the load, the last per cent of
the axes' accelerations, which nobody publishes): the comparison is loose by nature.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from measured_moves import put, table

from rpl.diagnostics import Diagnostics
from rpl.emulator.model import RobotModel, load_robot
from rpl.emulator.rotations import FloatArray, pose_matrix
from rpl.project import read_program
from rpl.simulation import run_program


@dataclass(frozen=True, slots=True)
class Cycle:
    """A stated cycle: the middle of the way across (mm, in front of the arm, the way runs along y), the controller that
    drives the arm, and the times that the maker states, s (lowest, highest)."""

    robot: str
    controller: str
    middle: tuple[float, float]
    stated: tuple[float, float]


CYCLES = (
    Cycle("abb_irb910sc", "rapid", (430.0, 100.0), (0.385, 0.385)),
    Cycle("epson_c4_a601", "plain", (400.0, 400.0), (0.37, 0.47)),
)
NOT_MODELLED = ("Epson GX4", "Epson C8", "Epson C12XL", "Epson VT6L")
UP, ACROSS = 25.0, 300.0


def places(model: RobotModel, cycle: Cycle) -> list[FloatArray]:
    """Joints at the pick, above it, above the place and at the place."""
    x, z = cycle.middle
    wanted = [(-0.5, 0.0), (-0.5, UP), (0.5, UP), (0.5, 0.0)]
    near, found = np.array(model.home, dtype=np.float64), []
    for side, height in wanted:
        pose = pose_matrix(np.array([x, side * ACROSS, z + height]), np.diag([1.0, -1.0, -1.0]))
        joints = model.nearest(pose, near)
        if joints is None:
            raise SystemExit(f"{cycle.robot}: a place of the cycle is out of reach")
        near = joints
        found.append(joints)
    return found


def program(model: RobotModel, cycle: Cycle) -> str:
    """There and back three times, as fast as it goes, corners of half of the way up."""
    lines = ["MODULE Cycle"]
    for number, joints in enumerate(places(model, cycle)):
        axes = ",".join(f"{joint:.6f}" for joint in [*joints, *[0.0] * (6 - len(joints))])
        lines.append(f"  CONST jointtarget j{number}:=[[{axes}],[9E9,9E9,9E9,9E9,9E9,9E9]];")
    lines += ["  PROC main()", "    MoveAbsJ j0,vmax,fine,tool0;"]
    for number, zone in [(1, "z10"), (2, "z10"), (3, "z0"), (2, "z10"), (1, "z10"), (0, "z0")] * 3:
        lines.append(f"    MoveAbsJ j{number},vmax,{zone},tool0;")
    return "\n".join([*lines, "    MoveAbsJ j0,vmax,fine,tool0;", "  ENDPROC", "ENDMODULE", ""])


def emulated_s(cycle: Cycle) -> float:
    """How long the second of the three cycles lasts."""
    model = load_robot(cycle.robot)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "Cycle.mod"
        path.write_text(program(model, cycle), encoding="utf-8")
        read = read_program([path], None, Diagnostics()).program
    result = run_program(read, model, controller=cycle.controller)
    if result.fault is not None:
        raise SystemExit(f"{cycle.robot}: {result.fault.message}")
    moves = [event for event in result.trace if event.kind == "move"]
    ends = [max(leg.start_s + leg.duration_s for leg in event.legs) for event in moves]
    return ends[12] - ends[6]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true")
    write = parser.parse_args().write
    rows = []
    for cycle in CYCLES:
        low, high = cycle.stated
        stated = f"{low:.3g}" if low == high else f"{low:.3g} to {high:.3g}"
        found = emulated_s(cycle)
        off = 0.0 if low <= found <= high else found / (high if found > high else low) - 1.0
        rows.append([f"`{cycle.robot}`", cycle.controller, stated, f"{found:.3f}", f"{100.0 * off:+.0f} %"])
    rows += [[name, "", "", "not modelled: axis speeds are not at hand", ""] for name in NOT_MODELLED]
    text = table(["arm", "controller", "stated, s", "emulated, s", "off by"], rows)
    if write:
        put("pick cycles", text)
    else:
        print(text)


if __name__ == "__main__":
    main()
