"""Types of the IR. A type is plain data; named types are references until a scope resolves them (see passes.scope)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rpl.ir.expressions import Expression


@dataclass(frozen=True, slots=True)
class IntType:
    """Whole number, 32 bit signed on every controller known to us."""


@dataclass(frozen=True, slots=True)
class RealType:
    """Floating point number. RAPID `num` and V+ reals are RealType too: they hold whole numbers exactly."""


@dataclass(frozen=True, slots=True)
class BoolType:
    pass


@dataclass(frozen=True, slots=True)
class CharType:
    """One character. Compares with numbers by its code where the language says so."""


@dataclass(frozen=True, slots=True)
class StringType:
    """Text with an optional capacity in characters (a KRL `CHAR s[80]` is StringType with capacity 80)."""

    capacity: Expression | None = None


@dataclass(frozen=True, slots=True)
class VectorType:
    """x, y, z in mm (RAPID pos)."""


@dataclass(frozen=True, slots=True)
class RotationType:
    """A rotation (RAPID orient); components q1..q4 = w, x, y, z or a, b, c (ZYX Euler degrees)."""


@dataclass(frozen=True, slots=True)
class PoseType:
    """Position and rotation, no arm configuration (KRL FRAME, RAPID pose)."""


@dataclass(frozen=True, slots=True)
class ConfigType:
    """Arm configuration flags in the notation of a dialect (RAPID confdata)."""

    notation: str


@dataclass(frozen=True, slots=True)
class ExternalType:
    """Positions of external axes e1..e6, each possibly unset (RAPID extjoint)."""


@dataclass(frozen=True, slots=True)
class AxesType:
    """Joint values j1..j6 alone (RAPID robjoint)."""


@dataclass(frozen=True, slots=True)
class TargetType:
    """Pose, arm configuration and external axes (KRL POS/E6POS, RAPID robtarget). `external`: has external axes."""

    notation: str
    external: bool = True


@dataclass(frozen=True, slots=True)
class JointsType:
    """Joint values j1..j6 and external axes e1..e6 in the robot's own units (KRL AXIS/E6AXIS, RAPID jointtarget)."""

    external: bool = True


@dataclass(frozen=True, slots=True)
class ToolType:
    """Tool: `held` (robot holds it), `frame` (tool centre point in the flange), `load`."""


@dataclass(frozen=True, slots=True)
class WorkObjectType:
    """Work object: `held`, `fixed` (user frame is programmed), `unit`, `user_frame`, `object_frame`."""


@dataclass(frozen=True, slots=True)
class LoadType:
    """Payload: `mass` kg, `cog` vector mm, `axes` rotation, `ix` `iy` `iz` kg m2."""


@dataclass(frozen=True, slots=True)
class SpeedType:
    """Speed profile: `path` mm/s, `rotation` deg/s, `linear_external` mm/s, `rotary_external` deg/s."""


@dataclass(frozen=True, slots=True)
class ZoneType:
    """Zone: `stop`, `path` mm, `rotation_path` mm, `external_path` mm, `rotation` deg, `linear_external` mm,
    `rotary_external` deg."""


@dataclass(frozen=True, slots=True)
class ClockType:
    """A stop watch."""


@dataclass(frozen=True, slots=True)
class InterruptType:
    """Identity of an interrupt (RAPID intnum)."""


@dataclass(frozen=True, slots=True)
class TriggerType:
    """A stored path event (RAPID triggdata)."""


@dataclass(frozen=True, slots=True)
class SignalType:
    """A physical signal passed as parameter: kind is one of SIGNAL_KINDS."""

    kind: str


@dataclass(frozen=True, slots=True)
class VendorType:
    """A type of one controller that only vendor statements use (RAPID socketdev, iodev)."""

    dialect: str
    name: str


@dataclass(frozen=True, slots=True)
class NamedType:
    """Reference to a declared record, enum or alias."""

    name: str


@dataclass(frozen=True, slots=True)
class ArrayType:
    """`dimensions` are upper bounds (None: taken from the argument or initial value); indices start at `base`. `grows`:
    (dimension, smallest bound) where the bound is a guess, since arrays of the source grow as they are used (V+)."""

    element: Type
    dimensions: tuple[Expression | None, ...]
    base: int = 1
    grows: tuple[tuple[int, int], ...] = field(default=(), compare=False, repr=False)


Type = (
    IntType
    | RealType
    | BoolType
    | CharType
    | StringType
    | VectorType
    | RotationType
    | PoseType
    | ConfigType
    | ExternalType
    | AxesType
    | TargetType
    | JointsType
    | ToolType
    | WorkObjectType
    | LoadType
    | SpeedType
    | ZoneType
    | ClockType
    | InterruptType
    | TriggerType
    | SignalType
    | VendorType
    | NamedType
    | ArrayType
)

SIGNAL_KINDS = ("digital_in", "digital_out", "analog_in", "analog_out", "group_in", "group_out", "flag")

NUMBER_TYPES = (IntType, RealType)

# The components of a place by its pose (angles turn about z, y and x), and those by its joints.
ANGLES = ("a", "b", "c")
POSE = ("x", "y", "z", *ANGLES)
AXES = ("j1", "j2", "j3", "j4", "j5", "j6")

_REAL = RealType()
_POSE_FIELDS: dict[str, Type] = {
    **dict.fromkeys(POSE, _REAL),
    "trans": VectorType(),
    "rot": RotationType(),
}
_EXTERNAL_FIELDS: dict[str, Type] = dict.fromkeys(("e1", "e2", "e3", "e4", "e5", "e6"), _REAL)
_AXIS_FIELDS: dict[str, Type] = dict.fromkeys(AXES, _REAL)

# Components of the built-in types by their neutral names. Target and configuration types add the flags of their
# notation, which the dialect declares (registry.notation_fields).
COMPONENTS: dict[type, dict[str, Type]] = {
    VectorType: dict.fromkeys(("x", "y", "z"), _REAL),
    RotationType: dict.fromkeys(("q1", "q2", "q3", "q4", "a", "b", "c"), _REAL),
    PoseType: _POSE_FIELDS,
    ExternalType: _EXTERNAL_FIELDS,
    TargetType: {**_POSE_FIELDS, **_EXTERNAL_FIELDS, "ext": ExternalType()},
    AxesType: _AXIS_FIELDS,
    JointsType: {**_AXIS_FIELDS, **_EXTERNAL_FIELDS, "robax": AxesType(), "ext": ExternalType()},
    ToolType: {"held": BoolType(), "frame": PoseType(), "load": LoadType()},
    WorkObjectType: {
        "held": BoolType(),
        "fixed": BoolType(),
        "unit": StringType(),
        "user_frame": PoseType(),
        "object_frame": PoseType(),
    },
    LoadType: {"mass": _REAL, "cog": VectorType(), "axes": RotationType(), "ix": _REAL, "iy": _REAL, "iz": _REAL},
    SpeedType: dict.fromkeys(("path", "rotation", "linear_external", "rotary_external"), _REAL),
    ZoneType: {
        "stop": BoolType(),
        **dict.fromkeys(
            ("path", "rotation_path", "external_path", "rotation", "linear_external", "rotary_external"), _REAL
        ),
    },
}

# The order of components in a positional aggregate (RAPID `[[x,y,z],[q1,q2,q3,q4],...]`). A target's and joints'
# positional form nests: (trans, rot, conf, ext) and (robax, ext); the configuration's order is its notation's.
POSITIONAL: dict[type, tuple[str, ...]] = {
    VectorType: ("x", "y", "z"),
    RotationType: ("q1", "q2", "q3", "q4"),
    PoseType: ("trans", "rot"),
    ExternalType: ("e1", "e2", "e3", "e4", "e5", "e6"),
    AxesType: ("j1", "j2", "j3", "j4", "j5", "j6"),
    TargetType: ("trans", "rot", "conf", "ext"),
    JointsType: ("robax", "ext"),
    ToolType: ("held", "frame", "load"),
    WorkObjectType: ("held", "fixed", "unit", "user_frame", "object_frame"),
    LoadType: ("mass", "cog", "axes", "ix", "iy", "iz"),
    SpeedType: ("path", "rotation", "linear_external", "rotary_external"),
    ZoneType: ("stop", "path", "rotation_path", "external_path", "rotation", "linear_external", "rotary_external"),
}
