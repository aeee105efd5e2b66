"""What a Staubli controller does, as data. `M` marks what rests on memory; docs/val3.md has all of it in one table.

M: precedence from low to high is or xor, and, == !=, < > <= >=, + -, * / %, ! and signs (grammars/val3.lark).
M: `and` and `or` do not look at their right side when the left one decides (expressions.py).
M: FOR looks at its bounds once; behind the loop the counter is the first value beyond (blocks.py).
M: a tool's `open` and `close` wait for the robot, switch its output to true or false and wait the tool's time
(motion.py).
M: appro, compose and here keep the father of what they are given (places.py); an assignment between points of
different frames keeps the place in the room (statements.py).
M: `same` and `free` are told apart only in joint moves: the axis keeps its side, or takes the nearer one
(configuration.py).
M: delay(0) hands the processor to the other tasks and lasts one cycle; taskStatus gives 1 for a task that runs and -1
for one that does not (calls.py).
"""

from __future__ import annotations

from typing import Final

from rpl.ir.rules import AdvanceRules, Rules

# M: one cycle of the controller, s.
CYCLE_S: Final = 0.004
# `tmax` and `rmax` of a movement descriptor that limits nothing (as delivered).
UNLIMITED: Final = 99999.0
# M: path speed at vel 100 of a descriptor without tmax: there the joints alone limit a path, each to vel percent.
FULL_PATH_SPEED_MM_S: Final = 2000.0
FULL_ROTATION_SPEED_DEG_S: Final = 500.0

# Movement instructions put a movement into the controller's queue and the program goes on at once; waitEndMove() waits
# for all of them. M: how many fit in; the size of the queue is the memory's.
ADVANCE = AdvanceRules(
    moves=2000,
    runs_ahead_of="all",
    stop_statements=frozenset(),
    source="VAL3 reference manual 5.3, chapter 9.2, movement anticipation",
)

_XYZABC = {name: name for name in ("x", "y", "z", "a", "b", "c")}

RULES = Rules(
    name="val3",
    advance=ADVANCE,
    case_sensitive=True,
    text_plus=True,
    array_base=0,
    text_length=128,
    wait_poll_s=CYCLE_S,
    components={"PoseType": _XYZABC, "TargetType": _XYZABC},
    system_defaults={
        "override": 100.0,
        "joint_speed": 100.0,
        "joint_acceleration": 100.0,
        "path_speed": FULL_PATH_SPEED_MM_S,
        "swivel_speed": FULL_ROTATION_SPEED_DEG_S,
        "twist_speed": FULL_ROTATION_SPEED_DEG_S,
        "acceleration_percent": 100.0,
        "deceleration_percent": 100.0,
        "circle_orientation": "base",
        "held_work": False,
    },
)

# A movement descriptor. `blend`: 0 off, 1 joint, 2 Cartesian.
MDESC: Final = ("accel", "vel", "decel", "tvel", "rvel", "blend", "leave", "reach")
