"""Motor torques and following errors of a finished run: the optional layers on top of its path.

Torques are those of the rigid bodies (links, rotors, load) without friction, at the joint behind the gear; each move is
driven with the load that the program gave for it, or with one load for the whole run. Following errors are those of one
first-order lag per axis.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.dynamics import ArmDynamics
from rpl.emulator.following import lagged, off_path
from rpl.emulator.inertias import LAG_S, Body, inertia_matrix, together
from rpl.emulator.rotations import FloatArray
from rpl.report.sampling import STANDING, RunSamples, driven_moves, sample_run
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.runtime.moves.orders import Payload
    from rpl.runtime.trace import Event, RunResult

# A lag smooths what lasts shorter than itself: short runs are looked at finely, long ones as finely as memory allows.
FINE_STEP_S, STEP_S, LONG_RUN_S = 0.004, 0.012, 600.0
# Behind its command by more than this many time constants a joint never is in a path's direction.
LAGS_BACK = 8.0


@dataclass(frozen=True, slots=True)
class Moment:
    """A largest value: how much, when (s), and the statement that was driven."""

    value: float
    time_s: float
    origin: Origin

    def as_json(self) -> dict[str, object]:
        return {
            "value": round(self.value, 6),
            "time_s": round(self.time_s, 6),
            "file": self.origin.file,
            "line": self.origin.line,
        }


@dataclass(frozen=True, slots=True)
class JointLoad:
    """One joint over the run. `torque` and `speed` have the sign of the pendant; torques in N m (N of a sliding joint),
    speeds in deg/s (mm/s). `limit` of the torque, where it is known."""

    name: str
    unit: str
    torque: Moment
    rms: float
    limit: float | None
    speed: Moment
    speed_limit: float

    @property
    def share(self) -> float | None:
        """Largest torque by its limit."""
        return abs(self.torque.value) / self.limit if self.limit else None

    def as_json(self) -> dict[str, object]:
        share = self.share
        return {
            "name": self.name,
            "unit": self.unit,
            "torque": self.torque.as_json(),
            "rms": round(self.rms, 6),
            "limit": self.limit,
            "share": None if share is None else round(share, 6),
            "speed": self.speed.as_json(),
            "speed_limit": round(self.speed_limit, 6),
        }


@dataclass(frozen=True, slots=True, eq=False)
class Following:
    """How far the tool is behind its command, and how far off its way, mm; errors over time as rows of s and mm."""

    lag_s: tuple[float, ...]
    assumed: bool
    behind: Moment
    off: Moment
    rows: FloatArray

    def as_json(self) -> dict[str, object]:
        return {
            "lag_s": list(self.lag_s),
            "assumed": self.assumed,
            "behind_mm": self.behind.as_json(),
            "off_path_mm": self.off.as_json(),
        }


@dataclass(frozen=True, slots=True, eq=False)
class RunDynamics:
    """The layers of a run. `joints` is empty where the arm has no inertias. `torques`: rows of s, one value a joint."""

    joints: tuple[JointLoad, ...]
    following: Following
    payload_kg: float
    warnings: tuple[str, ...]
    torques: FloatArray

    def as_json(self) -> dict[str, object]:
        return {
            "joints": [joint.as_json() for joint in self.joints],
            "following": self.following.as_json(),
            "payload_kg": round(self.payload_kg, 6),
            "warnings": list(self.warnings),
        }

    def layers(self) -> list[tuple[str, str, FloatArray]]:
        """Curves for a page: torques by their limits or in N m, and the errors of following."""
        found = []
        for number, joint in enumerate(self.joints):
            values = self.torques[:, number + 1] * (100.0 / joint.limit if joint.limit else 1.0)
            name, unit = f"Joint torque {joint.name}", "% of limit" if joint.limit else joint.unit
            found.append((name, unit, np.stack([self.torques[:, 0], values], axis=1)))
        found.append(("Behind the command", "mm", self.following.rows[:, :2]))
        found.append(("Off the path", "mm", self.following.rows[:, [0, 2]]))
        return found


def run_dynamics(
    result: RunResult, model: RobotModel, payload: Body | None = None, most_rows: int = 20_000
) -> RunDynamics:
    """The layers of a run; `payload`, in the flange's frame, stands in place of all loads of the program."""
    moves = driven_moves(result)
    samples = sample_run(result, model, FINE_STEP_S if result.time_s <= LONG_RUN_S else STEP_S)
    every = max(-(-len(samples) // most_rows), 1)
    following = _following(samples, moves, model, every)
    heaviest = max((sum(p.mass for p in event.payloads) for event in moves), default=0.0)
    mass = payload.mass if payload is not None else heaviest
    if model.inertias is None:
        reason = f"{model.name}: no inertias in the robot file: torques are not known"
        return RunDynamics((), following, mass, (reason,), np.zeros((0, model.axes + 1)))
    torques = _torques(samples, moves, model, payload)
    limits = model.inertias.torques
    joints = tuple(_joint(model, axis, samples, moves, torques, limits) for axis in range(model.axes))
    warnings = _warnings(joints)
    if payload is None and heaviest <= 0.0:
        warnings.append("the program sets no load: torques are those of the empty flange (--payload gives one)")
    rows = np.column_stack([samples.times, torques])[::every]
    return RunDynamics(joints, following, mass, tuple(warnings), rows)


def _torques(samples: RunSamples, moves: Sequence[Event], model: RobotModel, payload: Body | None) -> FloatArray:
    """Torques (k, n); a rest has the load of the move before it (the first move's at the start)."""
    dynamics = ArmDynamics(model, payload)
    if payload is not None:
        return dynamics.torques(samples.joints, samples.speeds, samples.accelerations)
    known = np.where(samples.moves == STANDING, -1, np.arange(len(samples)))
    owner = samples.moves[np.maximum(np.maximum.accumulate(known), 0)]
    torques = np.zeros_like(samples.joints)
    loads: dict[tuple[Payload, ...], list[int]] = {}
    for number, event in enumerate(moves):
        loads.setdefault(event.payloads, []).append(number)
    if moves:
        loads[moves[0].payloads].append(STANDING)
    for carried, numbers in (loads or {(): [STANDING]}).items():
        rows = np.isin(owner, numbers)
        dynamics.carry(together(tuple(_body(one) for one in carried)) if carried else None)
        part = samples.only(rows)
        torques[rows] = dynamics.torques(part.joints, part.speeds, part.accelerations)
    return torques


def _body(payload: Payload) -> Body:
    centred = Body(payload.mass, np.zeros(3), inertia_matrix(payload.inertias))
    return centred.seen_from(np.array(payload.frame.matrix))


def _joint(
    model: RobotModel,
    axis: int,
    samples: RunSamples,
    moves: Sequence[Event],
    torques: FloatArray,
    limits: FloatArray | None,
) -> JointLoad:
    turning = bool(model.revolute[axis])
    steps = np.gradient(samples.times) if len(samples) > 1 else np.ones(1)
    square = float((torques[:, axis] ** 2 * steps).sum() / max(float(steps.sum()), 1e-300))
    limit = float(limits[axis]) if limits is not None and limits[axis] > 0.0 else None
    return JointLoad(
        f"J{axis + 1}",
        "N m" if turning else "N",
        _moment(torques[:, axis], samples, moves),
        float(np.sqrt(square)),
        limit,
        _moment(samples.speeds[:, axis], samples, moves),
        float(model.speeds[axis]),
    )


def _moment(values: FloatArray, samples: RunSamples, moves: Sequence[Event]) -> Moment:
    row = int(np.argmax(np.abs(values)))
    number = int(samples.moves[row])
    origin = moves[number].origin if number != STANDING else NOWHERE
    return Moment(float(values[row]), float(samples.times[row]), origin)


def _following(samples: RunSamples, moves: Sequence[Event], model: RobotModel, every: int) -> Following:
    """The tool where the lagging joints have it, against the tool where it should be."""
    constants = model.lag if model.lag is not None else np.full(model.axes, LAG_S)
    late = lagged(samples.times, samples.joints, constants)
    flange, followed = model.forward(samples.joints), model.forward(late)
    # The tool keeps its place in the flange, whichever tool the move has.
    arm = np.einsum("kij,ki->kj", flange[:, :3, :3], samples.tool - flange[:, :3, 3])
    tool = followed[:, :3, 3] + np.einsum("kij,kj->ki", followed[:, :3, :3], arm)
    behind = np.linalg.norm(tool - samples.tool, axis=1)
    step = float(np.median(np.diff(samples.times))) if len(samples) > 1 else STEP_S
    back = int(np.ceil(LAGS_BACK * float(np.max(constants)) / max(step, 1e-6))) + 1
    off = off_path(samples.tool, tool, min(back, 400))
    rows = np.column_stack([samples.times, behind, off])[::every]
    return Following(
        tuple(float(value) for value in constants),
        model.lag is None,
        _moment(behind, samples, moves),
        _moment(off, samples, moves),
        rows,
    )


def _warnings(joints: Sequence[JointLoad]) -> list[str]:
    found = []
    for joint in joints:
        share = joint.share
        if share is not None and share > 1.0:
            origin = joint.torque.origin
            place = f"{origin.file}:{origin.line}: " if origin.source is not None else ""
            found.append(
                f"{place}{joint.name} would need {abs(joint.torque.value):.1f} {joint.unit}, "
                f"{100.0 * share:.0f} % of its limit, at {joint.torque.time_s:.3f} s"
            )
    return found
