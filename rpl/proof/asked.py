"""What two programs ask of the same move, apart from where it goes: speeds, accelerations, corners, loads, tool, frame,
and the joints with their turns. None of it depends on how a controller speeds up, so it is compared between
controllers too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from rpl.proof.difference import Difference, Side
from rpl.proof.findings import Findings
from rpl.proof.paths import turn_deg
from rpl.proof.record import Stretch
from rpl.proof.tolerance import Tolerance

if TYPE_CHECKING:
    from rpl.passes import rigid
    from rpl.runtime.moves.orders import Payload, Programmed

# A turn counts as if it happened that far (mm) from the frame.
_LEVER_MM = 100.0
_NO_TURN_DEG = 0.1


class _Asked:
    """Compares two moves measure by measure and tells what deviates."""

    def __init__(self, task: str, pair: tuple[Stretch, Stretch], tolerance: Tolerance, found: Findings) -> None:
        self.task, self.pair, self.tolerance, self.found = task, pair, tolerance, found

    def tell(self, kind: str, amount: float, text: str) -> None:
        """One deviation."""
        a, b = (Side(f"{one.motion} move", one.place, float(one.times[0])) for one in self.pair)
        self.found.deviates(kind, amount, text, a, b, self.task)

    def share(self, kind: str, what: str, unit: str, a: float | None, b: float | None, scale: float = 1.0) -> None:
        """Two amounts that may differ by a share of the larger one."""
        if a is None or b is None:
            return
        percent = 100.0 * abs(a - b) / max(abs(a), 1e-12)
        if percent > 100.0 * self.tolerance.measure_share:
            self.tell(kind, percent, f"{what}: {a * scale:.4g} {unit} in A, {b * scale:.4g} {unit} in B")


def compare_asked(
    task: str,
    pair: tuple[Stretch, Stretch],
    whole: bool,
    same_arm: bool,
    same_language: bool,
    tolerance: Tolerance,
    found: Findings,
) -> Difference | None:
    """Tell every measure of a move that deviates; the difference where the arm is to stand in another way. `whole`: one
    move is all of the other, else both drive a part of the same way."""
    first, second = pair
    a, b = first.asked, second.asked
    if a is None or b is None:
        return None
    asked = _Asked(task, pair, tolerance, found)
    _speeds(asked, a, b, whole)
    _accelerations(asked, a, b)
    if whole and not (first.cut and second.cut):
        _corners(asked, a, b)
    _loads(asked)
    _frame(asked, "tool", a.tool, b.tool, same_language)
    _frame(asked, "frame", a.frame, b.frame, same_language)
    return _joints(task, pair, tolerance, found) if same_arm else None


def _speeds(asked: _Asked, a: Programmed, b: Programmed, whole: bool) -> None:
    if a.seconds or b.seconds:
        if whole:
            asked.share("move-time", "time of the move", "s", a.planned_s or None, b.planned_s or None)
        return
    asked.share("path-speed", "path speed", "mm/s", a.path_mm_s, b.path_mm_s)
    asked.share("joint-speed", "joint speed", "% of the axes'", a.joint_share, b.joint_share, 100.0)
    turned = max(float(turn_deg(one.poses[0, :3, :3], one.poses[-1, :3, :3])) for one in asked.pair)
    if turned <= _NO_TURN_DEG:
        return
    if a.turning_deg_s is not None and b.turning_deg_s is not None:
        asked.share("turning-speed", "turning speed", "deg/s", a.turning_deg_s, b.turning_deg_s)
    elif whole and a.path_mm_s == b.path_mm_s:  # the turning may govern how fast the path is
        asked.share("turning-speed", "turning speed in force", "deg/s", a.rate, b.rate, turned)


def _accelerations(asked: _Asked, a: Programmed, b: Programmed) -> None:
    """In one unit by their share. One that is absolute and one that is a share of what a controller has do not compare:
    that is told with what they come to on this arm."""
    if a.acceleration is None or b.acceleration is None:
        return
    (one, unit), (other, there) = a.acceleration, b.acceleration
    if unit == there:
        asked.share("acceleration", "acceleration", unit, one, other)
    elif a.driven_acceleration is not None and b.driven_acceleration is not None and a.kind == b.kind:
        percent = 100.0 * abs(a.driven_acceleration - b.driven_acceleration) / max(abs(a.driven_acceleration), 1e-12)
        if (a.usual_acceleration or b.usual_acceleration) and percent <= 100.0 * asked.tolerance.measure_share:
            return  # one says what the other's language begins with
        text = f"acceleration: {one:.4g} {unit} in A, {other:.4g} {there} in B, on this arm {percent:.4g} % apart"
        asked.tell("acceleration-unit", percent, text)


def _corners(asked: _Asked, a: Programmed, b: Programmed) -> None:
    """Lengths of corners; where both come to rest they mean nothing."""
    first, second = asked.pair
    if a.corner_mm is None or b.corner_mm is None or (first.stops and second.stops):
        return
    apart = abs(a.corner_mm - b.corner_mm)
    if apart > asked.tolerance.corner_mm:
        asked.tell("corner-size", apart, f"corner: {a.corner_mm:g} mm in A, {b.corner_mm:g} mm in B")


def _frame(asked: _Asked, kind: str, a: rigid.Pose | None, b: rigid.Pose | None, same_language: bool) -> None:
    """Where both programs say it: one frame, or how far its point and, at a lever, its axes are apart. In one language
    also where only one of them says it: the other one takes what is set on the controller."""
    if a is b or (not same_language and (a is None or b is None)):
        return
    word = "tool" if kind == "tool" else "work object"
    if a is None or b is None:
        said = a if b is None else b
        assert said is not None  # one of them is
        amount = float(np.linalg.norm(np.array(said.matrix)[:3, 3]))
        asked.tell(kind, amount, f"only {'A' if b is None else 'B'} says the {word}")
        return
    one, other = np.array(a.matrix), np.array(b.matrix)
    mm = float(np.linalg.norm(one[:3, 3] - other[:3, 3]))
    deg = float(turn_deg(one[:3, :3], other[:3, :3]))
    if mm > asked.tolerance.path_mm or deg > asked.tolerance.turn_deg:
        amount = float(np.hypot(mm, np.radians(deg) * _LEVER_MM))  # neither hides the other
        asked.tell(kind, amount, f"{word}: {mm:.3f} mm and {deg:.3f} deg apart")


def _loads(asked: _Asked) -> None:
    (mass, centre), (other, there) = (_whole(one.loads) for one in asked.pair)
    if abs(mass - other) > asked.tolerance.load_kg:
        asked.tell("load", abs(mass - other), f"load: {mass:g} kg in A, {other:g} kg in B")
    if mass > 0.0 or other > 0.0:  # of no load at all the centre is taken at the flange
        apart = float(np.linalg.norm(centre - there))
        if apart > asked.tolerance.load_mm:
            asked.tell("load-centre", apart, f"centre of the load: {apart:.3f} mm apart")


def _whole(loads: tuple[Payload, ...]) -> tuple[float, np.ndarray]:
    """The whole mass (kg) and its centre (mm) in the flange."""
    mass = sum(load.mass for load in loads)
    centre = np.zeros(3)
    for load in loads:
        place = load.frame.position
        centre += load.mass * np.array([place.x, place.y, place.z])
    return mass, centre / mass if mass > 0.0 else centre


def _joints(task: str, pair: tuple[Stretch, Stretch], tolerance: Tolerance, found: Findings) -> Difference | None:
    """The joints that both moves head for, with their turns; at a passed point nothing else would show them."""
    (first, second), (a, b) = pair, (one.asked.joints if one.asked is not None else None for one in pair)
    if a is None or b is None or len(a) != len(b) or first.cut or second.cut:
        return None
    apart = np.abs(a - b)
    if apart.max(initial=0.0) <= tolerance.joint_deg:
        return None
    found.max_joint_deg = max(found.max_joint_deg, float(apart.max()))
    axis = int(np.argmax(apart))
    whole = abs(apart[axis] - 360.0 * round(apart[axis] / 360.0)) <= tolerance.joint_deg
    text = f"the arm is to stand differently: axis {axis + 1} at {a[axis]:.3f} in A, {b[axis]:.3f} in B"
    one, other = (Side(f"{move.motion} move", move.place, float(move.times[0])) for move in pair)
    return Difference("joints", "geometry", text + (", by whole turns" if whole else ""), one, other, task)


__all__ = ["compare_asked"]
