"""Which parameters of a controller a log can tell, their sizes and bounds, and their way into a controller and back."""

from __future__ import annotations

from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from rpl.errors import UsageError
from rpl.motionmodel import MotionModel

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel

USUAL_PATH_ACCELERATION = 5000.0


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number of a controller file: where it may lie, and the size that is typical for it."""

    name: str
    low: float
    high: float
    typical: float


PARAMETERS = (
    Parameter("joint_ramp_s", 0.005, 3.0, 0.2),
    Parameter("joint_acceleration_share", 0.05, 20.0, 1.0),
    Parameter("joint_smoothing_s", 0.0, 1.0, 0.1),
    Parameter("path_ramp_s", 0.005, 3.0, 0.2),
    Parameter("path_acceleration_mm_s2", 50.0, 2e5, 5000.0),
    Parameter("path_smoothing_s", 0.0, 1.0, 0.1),
    Parameter("corner_cut", 0.12, 0.6, 0.3),
    Parameter("corner_filter_s", 0.0, 0.5, 0.05),
    Parameter("corner_acceleration_mm_s2", 50.0, 2e5, 5000.0),
    Parameter("corner_ramp_s", 0.01, 3.0, 0.2),
    Parameter("restart_s", 0.0, 1.0, 0.1),
)
BY_NAME = {parameter.name: parameter for parameter in PARAMETERS}


def prepared(model: MotionModel, robot: RobotModel) -> MotionModel:
    """The controller with one ramp in place of one per axis, and numbers where it has none; under a name of its own, so
    that what a robot file says of the controller does not replace it."""
    ramp = model.joint_ramp_s
    if len(model.joint_ramps_s) == robot.axes:
        ramp = max(ramp, *model.joint_ramps_s)
    elif model.joint_ramp_deg > 0.0:
        ramp = max(ramp, model.joint_ramp_deg / float(robot.speeds[robot.revolute].min()))
    acceleration = model.path_acceleration_mm_s2 or USUAL_PATH_ACCELERATION
    return replace(
        model,
        name="fitted",
        joint_ramp_s=ramp,
        joint_ramps_s=(),
        joint_ramp_deg=0.0,
        path_acceleration_mm_s2=acceleration,
    )


def chosen(model: MotionModel, names: tuple[str, ...]) -> tuple[Parameter, ...]:
    """The parameters to adjust: those asked for, else those that this kind of controller has."""
    for name in names:
        if name not in BY_NAME:
            close = get_close_matches(name, BY_NAME, 1)
            hint = f"; did you mean {close[0]}?" if close else ""
            raise UsageError(f"no parameter {name!r} can be fitted: there are {', '.join(BY_NAME)}{hint}")
    if names:
        return tuple(BY_NAME[name] for name in dict.fromkeys(names))
    return tuple(parameter for parameter in PARAMETERS if _usual(model, parameter.name))


def _usual(model: MotionModel, name: str) -> bool:
    """A constant ramp leaves no room for an acceleration, corners of overlapping moves none for a size."""
    joint_ramps, path_ramps, overlaps = model.joint_ramp_s > 0.0, model.path_ramp_s > 0.0, bool(model.overlap)
    return {
        "joint_ramp_s": joint_ramps,
        "joint_acceleration_share": not joint_ramps,
        "joint_smoothing_s": not joint_ramps or model.joint_smoothing_s > 0.0,
        "path_ramp_s": path_ramps,
        "path_smoothing_s": not path_ramps or model.path_smoothing_s > 0.0,
        "corner_cut": not overlaps,
        "corner_filter_s": model.corner_filter_s > 0.0,
        "corner_acceleration_mm_s2": model.corner_acceleration_mm_s2 is not None,
        "corner_ramp_s": overlaps and model.corner_ramp_s > 0.0,
    }.get(name, True)


def values_of(model: MotionModel, parameters: tuple[Parameter, ...]) -> list[float]:
    """The parameters' present values; the typical one where there is none."""
    found = (getattr(model, parameter.name) for parameter in parameters)
    return [p.typical if value is None else float(value) for value, p in zip(found, parameters, strict=True)]


def with_values(model: MotionModel, parameters: tuple[Parameter, ...], values: list[float]) -> MotionModel:
    """The controller with other values of these parameters."""
    changed: dict[str, Any] = {parameter.name: value for parameter, value in zip(parameters, values, strict=True)}
    return replace(model, **changed)
