"""What is told of arm configurations that become others, or none."""

from __future__ import annotations

from rpl.diagnostics import Severity, code

NOT_CONVERTED = code(
    "configuration-not-converted",
    Severity.WARNING,
    "the arm configuration is not converted ({reason}); the controller takes the nearest",
    "name the arm with --robot, and give moves constant tools and frames",
)
WITHOUT_TURNS = code(
    "configuration-without-turns",
    Severity.WARNING,
    "{reason}, so that the turns of the axes are not known; the posture of the arm is written",
    "the controller takes the shortest way to it",
)
POSTURE_CHANGED = code(
    "posture-changed",
    Severity.WARNING,
    "the arm {arm} does not reach this {what} in the posture that it was taught in: {before} becomes {after}",
    "look at the ways to and from it: the arm goes over, and its cables with it; or move the place",
)
JOINTS_LOST = code(
    "joints-not-converted", Severity.LOSS, "these joint values are not constant; they mean another posture on {arm}"
)
FLAG_ACCESS = code(
    "configuration-field",
    Severity.LOSS,
    "{name} is part of the arm configuration, which the target writes otherwise",
    "look at the joints instead, or keep a number beside the place that says which posture it has",
    stops=True,
)
