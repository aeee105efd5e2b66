"""What a FANUC controller can say in TP, for the passes that rewrite the rest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rpl.errors import UsageError
from rpl.passes.capabilities import (
    Aggregate,
    Capabilities,
    Control,
    Counting,
    Data,
    Errors,
    Fault,
    GroupRule,
    Interrupts,
    Io,
    Limit,
    Local,
    Motion,
    MoveSetting,
    NameRules,
    Parameters,
    PathRule,
    PlaceRule,
    Places,
    RoutineRule,
    Routines,
    SearchResult,
    SettingRule,
    Settings,
    Storage,
    Tasks,
    TextRule,
    Texts,
    TriggerRule,
    TurnedWay,
    Watched,
)

from . import tables

CAPABILITIES = Capabilities(
    statements=frozenset(
        (
            *("Assign", "CallRoutine", "If", "Switch", "For", "Label", "Goto", "Return", "Halt", "Wait", "WaitUntil"),
            *("Pulse", "Message", "Clock", "TaskControl", "Vendor", "Opaque", "Nothing", "Move", "Search"),
            *("DeclareInterrupt", "ControlInterrupt"),
        )
    ),
    functions=frozenset(
        (
            *(
                name for name in tables.FUNCTIONS if name not in ("round", "trunc")
            ),  # conversions; they take no decimals
            *tables.TEXT_FUNCTIONS,
            *tables.POSITION_FUNCTIONS,
            "clock_seconds",
            "text_value",
            "text_find",
            "value_text",
            "number_text",
        )
    ),
    procedures=frozenset(),
    system_variables=frozenset(
        (
            "tool",
            "base",
            "coordinated",
            "remote_tool",
            "override",
            "actual_pose",
            "actual_joints",
            "timer",
            "timer_stopped",
            "null_frame",
            "world",
        )
    ),
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary, "-", "+", "&")),
    types=frozenset(
        (
            *("RealType", "BoolType", "StringType", "PoseType", "TargetType", "JointsType", "ClockType"),
            *("ArrayType",),
        )
    ),
    said_otherwise={
        "operator cand": "AND of conditions that neither change nor fail",
        "operator cor": "OR of conditions that neither change nor fail",
        "function text_equal": "SR[n]=SR[m] in an IF",
        "statement WaitForMotion": "FINE of the move before it",
        "system variable external_speed": "nothing: of a move, and reported as left out",
    },
    names=NameRules(longest=36, case_sensitive=False, reserved=tables.RESERVED),
    conversions=frozenset(("real", "trunc", "round_half_away")),
    places=Places(
        notation="tp",
        move_functions=frozenset((":", "compose", "element_sum", "displaced_in_tool", "joints_to_target", "pose_of")),
        rules=frozenset((PlaceRule.KEEP_ANGLES, PlaceRule.POSTURE_SAID, PlaceRule.TURNS, PlaceRule.UNTYPED)),
    ),
    motion=Motion(
        relative=True,
        tool_ways=False,  # INC is in the axes of the frame
        turned_ways=frozenset((TurnedWay.JOINT, TurnedWay.TOOL)),
        search_results=frozenset((SearchResult.FOUND, SearchResult.HIT)),
        # SEARCHED_DATA, M: SKIP CONDITION takes flags as it takes inputs and registers
        paths=frozenset((PathRule.EVEN_WRIST, PathRule.SEARCHED_DATA, PathRule.TIMED_ARCS, PathRule.TO_JOINTS)),
        triggers=frozenset((TriggerRule.LATE, TriggerRule.OF_MOVES)),
    ),
    settings=Settings(
        modal=True,
        of_moves=frozenset((MoveSetting.BLEND, MoveSetting.SPEED)),
        speeds=frozenset(("joint", "path", "rotation", "duration")),
        blends=frozenset(("BlendStop", "BlendPercent", "BlendDistance")),
        rules=frozenset((SettingRule.READ_OVERRIDE, SettingRule.TOOL_IN_FORCE)),
    ),
    interrupts=Interrupts(watched=Watched.INTERRUPTS),
    tasks=Tasks(operations=frozenset(("start",)), moving=False),
    io=Io(
        own_signals=frozenset(tables.OWN_SIGNALS),
        waits_at_rest=False,
        widest_group=16,
        timers=tables.TIMER.last,
        wait_timeout=True,
        shortest_wait_s=0.01,
        poll_s=0.01,
        groups=frozenset((GroupRule.COMPUTED, GroupRule.NUMBERED)),
        pulses=frozenset(),
    ),
    texts=Texts(
        longest_message=tables.LONGEST_MESSAGE,
        rules=frozenset((TextRule.COMPUTED_DECIMALS, TextRule.PRINTABLE)),
        messages=frozenset(),
    ),
    data=Data(aggregates=frozenset((Aggregate.CONSTANT, Aggregate.NAMED, Aggregate.PARTIAL)), composites=frozenset()),
    errors=Errors(faults=frozenset((Fault.TEXT_PART,))),
    routines=Routines(
        parameters=Parameters.NUMBERED,
        rules=frozenset((RoutineRule.COMPUTED_NAMES, RoutineRule.TEXT_RESULTS)),
        most_arguments=tables.MOST_ARGUMENTS,
        locals=frozenset((Local.STATICS,)),
    ),
    control=Control(
        switch_types=frozenset(("RealType", "IntType")),
        counting=frozenset((Counting.KEEPS_LAST, Counting.LOOKS_EACH_PASS, Counting.ONE_STEP, Counting.REAL)),
        limits=frozenset(
            (
                *(Limit.FUNCTIONS_ALONE, Limit.PLAIN_PLACES, Limit.ONE_BRANCH),
                Limit.CONSTANT_CASES,
            )
        ),
    ),
    storage=Storage(
        banks={
            "RealType": tables.R,
            "BoolType": tables.F,
            "StringType": tables.SR,
            "PoseType": tables.PR,
            "TargetType": tables.PR,
            "JointsType": tables.PR,
            "ClockType": tables.TIMER,
        },
        own=frozenset((*(bank for bank, _ in tables.SELECTED.values()), tables.TIMED_OUT)),
        points=tables.POINTS,
    ),
)


def fitted(options: Mapping[str, str]) -> Capabilities:
    """`names=8`: program names of old controllers. Raises UsageError for another number."""
    longest = options.get("names", str(CAPABILITIES.names.longest))
    if longest not in ("8", str(CAPABILITIES.names.longest)):
        raise UsageError(f"names={longest}: a program name has 8 characters on old controllers, else 36")
    return replace(CAPABILITIES, names=replace(CAPABILITIES.names, longest_routine=int(longest)))
