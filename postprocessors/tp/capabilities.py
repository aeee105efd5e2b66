"""What a FANUC controller can say in TP, for the passes that rewrite the rest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rpl.errors import UsageError
from rpl.passes.capabilities import Capabilities, NameRules

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
    joined_texts=tables.LONGEST_PLAIN + 1,
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary, "-", "+", "&")),
    types=frozenset(
        (
            *("RealType", "BoolType", "StringType", "PoseType", "TargetType", "JointsType", "ClockType"),
            *("ArrayType",),
        )
    ),
    said_otherwise=frozenset(
        (
            *("operator cand", "operator cor"),  # AND and OR of conditions that neither change nor fail
            "function text_equal",  # SR[n]=SR[m] in an IF
            "statement Trigger",  # TB, TA and DB of the move
            "statement WaitForMotion",  # FINE of the move before it
            "system variable external_speed",  # of a move: reported as left out
            "system variable flag",  # F[n]
        )
    ),
    names=NameRules(longest=36, case_sensitive=False, reserved=tables.RESERVED),
    modal_motion=True,
    printable_texts=True,
    waits_at_rest=False,
    widest_group=16,
    notation="tp",
    rotation="zyx",
    conversions=frozenset(("real", "trunc", "round_half_away")),
    timers=tables.TIMER.last,
    wait_timeout=True,
    dynamic_calls=True,
    switch_types=frozenset(("RealType", "IntType")),
    switch_constant_cases=True,
    switch_variables=True,
    named_aggregates=True,
    partial_aggregates=True,
    constant_aggregates=True,
    untyped_places=True,
    shortest_wait_s=0.01,
    poll_s=0.01,
    logic_names=tables.LOGIC_NAMES,
    relative_moves=True,
    turned_ways=frozenset(("tool", "joint")),
    for_real=True,
    else_if=False,
    for_keeps_last=True,
    for_looks_once=False,
    for_steps="one",
    local_routines=False,
    function_routines=False,
    faults_outside=False,
    faults_fractions=False,
    parameters="numbered",
    locals=False,
    recursion=False,
    call_depth=tables.DEEPEST_CALL,
    search_results=frozenset(("found", "hit")),
    searched_data=True,  # M: SKIP CONDITION takes flags as it takes inputs and registers
    task_operations=frozenset(("start",)),
    moving_tasks=False,
    banks={
        "RealType": tables.R,
        "BoolType": tables.F,
        "StringType": tables.SR,
        "PoseType": tables.PR,
        "TargetType": tables.PR,
        "JointsType": tables.PR,
        "ClockType": tables.TIMER,
    },
    points=tables.POINTS,
    records=False,
    arrays=False,
    longest_message=tables.LONGEST_MESSAGE,
    computed_messages=False,
    text_find_from=False,
    text_case=False,
    calculated_places=False,
    functions_alone=True,
    signal_groups=False,
    timed_arcs=True,
    move_settings=frozenset(("speed", "blend")),
    move_triggers=True,
    path_assignments="signals",
    concurrent_moves="tasks",
    speeds=frozenset(("joint", "path", "rotation", "duration")),
    move_functions=frozenset((":", "compose", "element_sum", "displaced_in_tool", "joints_to_target", "pose_of")),
    blends=frozenset(("BlendStop", "BlendPercent", "BlendDistance")),
    numbered_groups=True,
    watched_interrupts=True,
    place_components=False,
    asked_frames=False,
    most_arguments=tables.MOST_ARGUMENTS,
    pulse_levels=False,
    pulse_times=False,
    static_locals=True,
    local_clocks=False,
    reset_stops=False,
)


def fitted(options: Mapping[str, str]) -> Capabilities:
    """`names=8`: program names of old controllers. Raises UsageError for another number."""
    longest = options.get("names", str(CAPABILITIES.names.longest))
    if longest not in ("8", str(CAPABILITIES.names.longest)):
        raise UsageError(f"names={longest}: a program name has 8 characters on old controllers, else 36")
    return replace(CAPABILITIES, names=replace(CAPABILITIES.names, longest_routine=int(longest)))
