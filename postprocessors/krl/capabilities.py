"""What a KUKA controller can say, for the passes that rewrite the rest."""

from __future__ import annotations

from collections.abc import Mapping

from rpl.errors import UsageError
from rpl.passes.capabilities import (
    AS_MODULE,
    ActionArguments,
    Aggregate,
    Background,
    Capabilities,
    Composite,
    Control,
    Data,
    DataRule,
    Errors,
    Fault,
    InterruptRule,
    Interrupts,
    Io,
    Limit,
    ModulePoints,
    Motion,
    NameRules,
    Passing,
    PathRule,
    PlaceRule,
    Places,
    RoutineRule,
    Routines,
    Settings,
    Storage,
    Tasks,
    Texts,
)

from . import tables

CAPABILITIES = Capabilities(
    statements=frozenset(
        (
            *("Assign", "CallRoutine", "If", "Switch", "For", "While", "Repeat", "Loop", "ExitLoop", "Label", "Goto"),
            *("Return", "Halt", "Wait", "WaitUntil", "WaitForMotion", "LookAhead", "Pulse", "DeclareInterrupt"),
            *("ControlInterrupt", "StopMotion", "ResumeLevel", "Message", "Dialog", "Do", "Nothing", "Move", "Spline"),
            *("Trigger", "PathRule", "Vendor", "Opaque"),
        )
    ),
    functions=frozenset((*tables.FUNCTIONS, "text_equal", "text_find", "is_uninitialised", "message_text", "compose")),
    procedures=frozenset(tables.PROCEDURES),
    system_variables=frozenset((*tables.SYSTEM, "actual_joint", "base_unit", "base_root")) - {"time"},
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary)),
    types=frozenset(
        (
            *("IntType", "RealType", "BoolType", "CharType", "StringType", "PoseType", "TargetType", "JointsType"),
            *("NamedType", "ArrayType"),
        )
    ),
    said_otherwise={
        "function parse_number": "StrToReal and kin beside a BOOL",
        "function parse_value": "StrToReal and kin beside a BOOL",
    },
    names=NameRules(
        entry=AS_MODULE,
        longest=24,
        case_sensitive=False,
        reserved=tables.RESERVED,
        first="abcdefghijklmnopqrstuvwxyz_",
        further="abcdefghijklmnopqrstuvwxyz0123456789_",
        predefined=tables.OWN,
    ),
    conversions=tables.SILENT_CONVERSIONS,
    places=Places(
        notation="krl",
        kinematics=("INVERSE", "FORWARD"),
        rules=frozenset((PlaceRule.AXIS_SIGNS, PlaceRule.KEEP_ANGLES, PlaceRule.PARTIAL, PlaceRule.TURNS)),
    ),
    motion=Motion(relative=True, paths=frozenset((PathRule.ARCS_BY_ANGLE, PathRule.EVEN_WRIST))),
    settings=Settings(modal=True),
    interrupts=Interrupts(
        action_arguments=frozenset((ActionArguments.OWN, ActionArguments.PATH, ActionArguments.REACTION)),
        rules=frozenset((InterruptRule.SINGLE_DISABLES,)),
    ),
    tasks=Tasks(background=Background.SHARED, moving=False),
    io=Io(widest_group=32, timers=64, groups=frozenset()),  # each declared (passes/groups.py)
    texts=Texts(room=(tables.DEFAULT_TEXT_CAPACITY, tables.LONGEST_TEXT)),
    data=Data(
        composites=frozenset((Composite.ARRAYS, Composite.ENUMS, Composite.RECORDS)),
        aggregates=frozenset((Aggregate.CONSTANT, Aggregate.NAMED, Aggregate.PARTIAL)),
        rules=frozenset((DataRule.LISTS, DataRule.ROW_SIZES)),
    ),
    errors=Errors(faults=frozenset((Fault.INDEX_OUTSIDE, Fault.TEXT_PART))),
    routines=Routines(
        rules=frozenset((RoutineRule.FUNCTIONS, RoutineRule.LOCAL, RoutineRule.RECURSION)),
        passing=frozenset((Passing.ARRAYS_BY_VALUE, Passing.REFERENCES)),
    ),
    control=Control(
        switch_types=frozenset(("IntType", "CharType", "NamedType")), limits=frozenset((Limit.CONSTANT_CASES,))
    ),
    storage=Storage(module_points=ModulePoints.LIST),
)


def fitted(options: Mapping[str, str]) -> Capabilities:
    """`moves` says how moves look, not what can be said. Raises UsageError for another way than there is."""
    moves = options.get("moves", "forms")
    if moves not in ("forms", "lines"):
        raise UsageError(f"moves={moves}: moves are `forms` (inline forms) or `lines` (expert lines)")
    return CAPABILITIES
