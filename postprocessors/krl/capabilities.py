"""What a KUKA controller can say, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.ir.types import NamedType
from rpl.passes.capabilities import Capabilities, NameRules

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
    # $ROB_TIMER runs since the controller started: as seconds in a REAL it is too coarse for programs of others.
    system_variables=frozenset((*tables.SYSTEM, "actual_joint", "base_unit", "base_root")) - {"time"},
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary)),
    types=frozenset(
        (
            *("IntType", "RealType", "BoolType", "CharType", "StringType", "PoseType", "TargetType", "JointsType"),
            *("NamedType", "ArrayType"),
        )
    ),
    said_otherwise=frozenset(("function parse_number", "function parse_value")),  # StrToReal and kin beside a BOOL
    names=NameRules(
        longest=24,
        case_sensitive=False,
        reserved=tables.RESERVED,
        first="abcdefghijklmnopqrstuvwxyz_",
        further="abcdefghijklmnopqrstuvwxyz0123456789_",
    ),
    modal_motion=True,
    concurrent_moves="advance",
    faults_fractions=False,
    paths_to_joints=False,
    module_points="list",
    widest_group=32,
    notation="krl",
    rotation="zyx",
    enums=True,
    text_room=(tables.DEFAULT_TEXT_CAPACITY, tables.LONGEST_TEXT),
    conversions=tables.SILENT_CONVERSIONS,
    timers=64,
    switch_types=frozenset(("IntType", "CharType", "NamedType")),
    switch_constant_cases=True,
    text_results=False,
    format_state=NamedType("STATE_T"),
    named_aggregates=True,
    list_arguments=False,
    partial_aggregates=True,
    constant_aggregates=True,
    relative_moves=True,
    single_disables=True,
    action_arguments=frozenset(("reaction", "path", "own")),
    arcs_by_angle=True,
    partial_targets=True,
    flags_by_sign=True,
    data_lists=True,
    declared_groups=True,
    background_tasks="shared",
    moving_tasks=False,
    kinematics=("INVERSE", "FORWARD"),
)
