"""A motion statement with everything evaluated: what the program pointer hands to the motion queue."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from rpl.runtime.code import Code, Instruction, Read, Values, Write
from rpl.runtime.values import Record, Value

if TYPE_CHECKING:
    from rpl.emulator.planner import PlannedMove
    from rpl.emulator.rotations import FloatArray
    from rpl.ir.rules import Rules
    from rpl.passes import rigid

Modal = dict[str, Value]


@dataclass(slots=True, eq=False)
class SpeedOrder:
    """Base units: mm/s, deg/s, percent, s; accelerations mm/s2 and deg/s2. `axis`: deg/s of the leading axis."""

    profile: Record | None = None
    path: float | None = None
    rotation: float | None = None
    joint: float | None = None
    duration: float | None = None
    axis: float | None = None
    path_acceleration: float | None = None
    axis_acceleration: float | None = None


@dataclass(slots=True, eq=False)
class BlendOrder:
    """kind: stop, distance, percent, speed, zone."""

    kind: str
    distance: float | None = None
    rotation: float | None = None
    percent: float = 0.0
    path: BlendOrder | None = None
    zone: Record | None = None

    @property
    def stops(self) -> bool:
        return self.kind == "stop" or (self.zone is not None and bool(self.zone.get("stop")))


@dataclass(slots=True, eq=False)
class TriggerOrder:
    """What happens on the path: `act` writes something at once, `routine` runs in the task, `interrupt` is an
    interrupt's identity. `due` is its time as far as it is known. `early_while_braking`: it comes before its place only
    while the robot brakes for it. `behind_corner`: its place is the end of a corner at the start of the move."""

    reference: str
    distance: float | None
    delay: float
    values: Values
    act: Instruction | None = None
    routine: Code | None = None
    interrupt: int | None = None
    due: float | None = None
    fired: bool = False
    early_while_braking: bool = False
    behind_corner: bool = False

    def copy(self) -> TriggerOrder:
        """A stored trigger is used by many moves: each has its own."""
        return replace(self, due=None, fired=False)


@dataclass(frozen=True, slots=True)
class PathRuleOrder:
    """A rule about the speeds of a block, behind `at` of its segments: see `ir.PathRule`. `value`: a share, s or mm."""

    at: int
    rule: str
    value: float
    reference: str


@dataclass(slots=True, eq=False)
class SearchOrder:
    """`write` takes the target where it came, `hit` whether it came before the move's end. `last`: the condition's
    value when looked at last; `found`: it has come; `early`: it was there before the search."""

    condition: Read
    write: Write | None
    values: Values
    stop: str
    edge: str
    hit: Write | None = None
    last: bool = False
    found: bool = False
    early: bool = False


@dataclass(frozen=True, slots=True)
class Payload:
    """A body in the flange: mass kg; `frame` stands at its centre (mm), turned like its axes; inertias about the centre
    and these axes, kg m2."""

    mass: float
    frame: rigid.Pose
    inertias: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def __deepcopy__(self, memo: object) -> Payload:
        return self


@dataclass(frozen=True, slots=True, eq=False)
class Programmed:
    """A move as it is asked for. None: the program does not say it, or it has no meaning for this move.

    path_mm_s: of the tool on a path. turning_deg_s: of its orientation. joint_share: of the leading axis' greatest
    speed. seconds: a time of its own, and planned_s what that gives. acceleration: with its unit, absolute or a share
    of what the controller has; driven_acceleration: what this arm makes of it (mm/s2 on a path, else the share of the
    axes' own), for two that do not compare. usual_acceleration: the program says none, and its language has a
    value of its own at the start. corner_mm: the size of the corner at its end, 0 for a stop, None where it is not a
    length. tool: the tool centre point in the flange. frame: the work object. joints (n,): where the arm is to stand,
    with turns. rate: the part of a path per second at which the slowest of path, turning and external axes lets it go.
    """

    kind: str
    path_mm_s: float | None = None
    turning_deg_s: float | None = None
    joint_share: float | None = None
    seconds: float | None = None
    planned_s: float = 0.0
    acceleration: tuple[float, str] | None = None
    driven_acceleration: float | None = None
    usual_acceleration: bool = False
    corner_mm: float | None = None
    tool: rigid.Pose | None = None
    frame: rigid.Pose | None = None
    joints: FloatArray | None = None
    rate: float | None = None

    def __deepcopy__(self, memo: object) -> Programmed:
        return self


@dataclass(frozen=True, slots=True, eq=False)
class Rate:
    """How a move without an end goes: mm/s and rad/s of the tool (6,), or deg/s of the axes (n,). `size`: its leading
    speed (mm/s, deg/s); `acceleration` of that. `stretch_s`: how long the planned way lasts at full speed."""

    joint: bool
    vector: FloatArray
    size: float
    acceleration: float
    stretch_s: float = 0.0


@dataclass(slots=True, eq=False)
class Order:
    """One move as the program asks for it. `modal` overlays the task's system variables for this move; `once` is what
    of it statements before the move have set. `block`: of the last move of a spline block those before it, and
    `path_rules`: how the block is driven. `together`: the tasks whose moves of the
    same `identity` go with it; `agreed`: when it begins and ends is settled. `programmed`: what is asked of the
    move, once it is planned."""

    kind: str
    target: Value
    code: Code
    at: int
    rules: Rules
    via: Value = None
    swept: float | None = None
    relative: str | None = None
    tool: Value = None
    frame: Value = None
    load: Value = None
    payloads: tuple[Payload, ...] = ()
    speed: SpeedOrder = field(default_factory=SpeedOrder)
    acceleration: float | None = None
    blend: BlendOrder = field(default_factory=lambda: BlendOrder("stop"))
    orientation: str | None = None
    circle_orientation: str | None = None
    configuration: str | None = None
    triggers: list[TriggerOrder] = field(default_factory=list)
    search: SearchOrder | None = None
    modal: Modal = field(default_factory=dict)
    once: Modal = field(default_factory=dict)
    concurrent: bool = False
    external_only: bool = False
    velocity: bool = False
    servo: bool = False
    block: tuple[Order, ...] = ()
    path_rules: tuple[PathRuleOrder, ...] = ()
    identity: str | None = None
    together: frozenset[int] = frozenset()
    agreed: bool = False
    programmed: Programmed | None = None


@dataclass(slots=True, eq=False)
class Drive:
    """A planned move in the queue. `legs`: how it was driven so far; `goal`: the programmed target in its frame;
    `rate`: of a move at a given speed, which has no end. `entered`: where a corner at its start ends, in mm of the move
    and in mm driven behind the corner's middle. `orders`: of a smooth run of a spline block its segments; `marks`: the
    fractions of the run at which all but the last of them end; so many are `passed`.
    `sliding`: which external axes slide (mm), for all that is known."""

    number: int
    order: Order
    plan: PlannedMove | None
    tool: rigid.Pose
    goal: rigid.Pose | None
    external: tuple[float | None, ...]
    released: bool = False
    blending: bool = False
    legs: list[object] = field(default_factory=list)
    started_s: float | None = None
    rate: Rate | None = None
    entered: tuple[float, float] | None = None
    orders: tuple[Order, ...] = ()
    marks: tuple[float, ...] = ()
    passed: int = 0
    sliding: tuple[bool, ...] = ()

    @property
    def present(self) -> Order:
        """The order that is driven now."""
        return self.orders[self.passed] if self.passed < len(self.marks) else self.order
