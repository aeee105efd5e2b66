"""Motion statements: moves with everything a controller attaches to them.

A setting that is None is taken from the modal system variable of the same meaning (`tool`, `base`, `path_speed`, ...).
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.ir.actions import Assign, CallRoutine, Nothing, Opaque, Vendor
from rpl.ir.expressions import Expression
from rpl.source import NOWHERE, Origin


@dataclass(frozen=True, slots=True)
class Speed:
    """Speed of one move. `profile` is an expression of SpeedType (RAPID speeddata); the others override parts of it:
    `path` mm/s, `rotation` deg/s, `joint` percent of the axes' maximum, `axis` deg/s of the leading axis (URScript),
    `duration` s for the whole move. Accelerations: `path_acceleration` mm/s2, `axis_acceleration` deg/s2
    of the leading axis."""

    profile: Expression | None = None
    path: Expression | None = None
    rotation: Expression | None = None
    joint: Expression | None = None
    duration: Expression | None = None
    axis: Expression | None = None
    path_acceleration: Expression | None = None
    axis_acceleration: Expression | None = None


@dataclass(frozen=True, slots=True)
class BlendStop:
    """Exact stop at the target."""


@dataclass(frozen=True, slots=True)
class BlendDistance:
    """Leave the path at most `distance` mm before the target (KRL C_DIS, UR r, FANUC CR). `rotation` deg: KRL C_ORI."""

    distance: Expression | None = None
    rotation: Expression | None = None


@dataclass(frozen=True, slots=True)
class BlendPercent:
    """Blend by a percentage of the controller's own measure (KRL C_PTP, FANUC CNT)."""

    percent: Expression
    path: BlendDistance | BlendSpeed | None = None


@dataclass(frozen=True, slots=True)
class BlendSpeed:
    """Blend when the speed has fallen to `percent` of the programmed one (KRL C_VEL)."""

    percent: Expression


@dataclass(frozen=True, slots=True)
class BlendZone:
    """Blend by a zone value (ZoneType); `distance` mm overrides its path radius (RAPID \\Z)."""

    zone: Expression
    distance: Expression | None = None
    in_position: Expression | None = None


@dataclass(frozen=True, slots=True)
class BlendLevel:
    """Blend by a numbered level of the controller (INFORM PL 0..8): `Rules.blend_levels` has the distances."""

    level: Expression


Blend = BlendStop | BlendDistance | BlendPercent | BlendSpeed | BlendZone | BlendLevel


@dataclass(frozen=True, slots=True)
class Trigger:
    """An action on the path of the next move (as a statement) or of its move (in Move.triggers).

    reference: `start`, `end`, `middle` (of the corner path or end). `distance` mm along the path from the reference
    (negative: before), `delay` s after that point (negative: before it). `action` is an Assign or CallRoutine.
    """

    reference: str
    action: Assign | CallRoutine
    distance: Expression | None = None
    delay: Expression | None = None
    priority: Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class DefineTrigger:
    """Store a trigger in a variable of TriggerType (RAPID TriggIO, TriggEquip, TriggInt)."""

    target: Expression
    trigger: Trigger
    interrupt: Expression | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class PathRule:
    """How the path of a spline block is driven from or up to a place (KRL TIME_BLOCK, CONST_VEL).

    rule: `time_start`, `time_part` (`value`: share of the time), `time_end` (`value`: s for the whole): at the point
    before it. `constant_start`, `constant_end`: between them the speed does not change; `value`: mm along the path
    from the `reference` of the next segment, `start` or `end`.
    """

    rule: str
    value: Expression | None = None
    reference: str = "end"
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Search:
    """Watch a condition while moving. `stop`: none, stop (quick), path (on the path), soft (ramp down). `found`: lvalue
    that receives the target where it became true. `edge`: rising, falling, either. `hit`: BOOL lvalue that says whether
    it became true before the move ended (FANUC Skip)."""

    condition: Expression
    found: Expression | None = None
    stop: str = "none"
    edge: str = "rising"
    hit: Expression | None = None


@dataclass(frozen=True, slots=True)
class Move:
    """One move.

    kind: joint, linear, circular, spline (a point of a spline block).
    motion_class: `classic`, `spline` (KRL SLIN and PTP blend by different rules) or `process` (URScript movep: constant
    speed of the tool, circular blends), or `velocity` (URScript speedl, speedj: a relative move without an end. Its
    target is the way in a second, the speed's duration the time after which the program goes on; without a duration it
    goes on at full speed. The next move of this class takes over at the speed there is, any other one brakes first), or
    `servo` (URScript servoj: the program goes on after the speed's duration, wherever the robot is then; the next move
    of this class takes over at the speed there is, any other one begins at the target).
    target: expression of target, pose or joints type (a joints value makes any move go there).
    via: auxiliary point of a circle; swept: total angle in deg.
    relative: None, `base` (target is an offset in base axes), `tool`, or `joints` (offset per axis).
    tool / frame: expression of tool or pose type / work object or pose type.
    orientation: variable, constant, wrist; circle_orientation: base, path.
    configuration: `exact`, `nearest`, or None for the modal rule.
    concurrent: the program goes on at once (RAPID \\Conc).
    """

    kind: str
    target: Expression
    via: Expression | None = None
    swept: Expression | None = None
    relative: str | None = None
    tool: Expression | None = None
    frame: Expression | None = None
    load: Expression | None = None
    speed: Speed | None = None
    acceleration: Expression | None = None
    blend: Blend | None = None
    orientation: str | None = None
    circle_orientation: str | None = None
    configuration: str | None = None
    triggers: tuple[Expression | Trigger, ...] = ()
    search: Search | None = None
    settings: tuple[tuple[Expression, Expression], ...] = ()  # KRL WITH: system variable := value, for this move
    concurrent: bool = False
    without_offsets: bool = False
    group: int = 1
    identity: Expression | None = None
    motion_class: str = "classic"
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class MoveExternal:
    """Move external axes only (RAPID MoveExtJ)."""

    target: Expression
    speed: Speed | None = None
    blend: Blend | None = None
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)


@dataclass(frozen=True, slots=True)
class Spline:
    """A spline block: its moves and triggers form one path. kind: path (SPLINE) or joint (PTP_SPLINE)."""

    kind: str
    body: tuple[Move | Trigger | PathRule | Assign | CallRoutine | Vendor | Nothing | Opaque, ...]
    blend: Blend | None = None
    settings: tuple[tuple[Expression, Expression], ...] = ()
    origin: Origin = field(default=NOWHERE, compare=False, repr=False, kw_only=True)
