"""What a Yaskawa controller can say in INFORM, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import Capabilities, NameRules

from . import tables

CAPABILITIES = Capabilities(
    statements=frozenset(
        (
            *("Assign", "CallRoutine", "If", "While", "For", "Label", "Goto", "Return", "Halt", "Wait", "WaitUntil"),
            *("Pulse", "Message", "TaskControl", "Vendor", "Opaque", "Nothing", "Move", "Search", "Trigger"),
            *("DeclareInterrupt", "ControlInterrupt", "Dialog"),
        )
    ),
    functions=frozenset((*tables.FUNCTIONS, *tables.TEXT_FUNCTIONS, *tables.POSITION_FUNCTIONS, "abs", "number_text")),
    procedures=frozenset(),
    system_variables=frozenset(("actual_pose", "actual_joints", "actual_joint", "null_frame", "world", "coordinated")),
    operators=frozenset((*tables.COMPARISONS, *tables.ARITHMETIC, "mod", "and", "or", "&", ":")),
    types=frozenset(
        (
            *("IntType", "RealType", "BoolType", "StringType", "CharType", "PoseType", "TargetType", "JointsType"),
            "ArrayType",
        )
    ),
    said_otherwise=frozenset(
        (
            "statement WaitForMotion",  # the move before it gets PL=0, or nothing is needed where the robot stands
            "system variable deceleration_percent",  # DEC= of the move behind it
            "system variable flag",  # an element of the bank of flags by its number
        )
    ),
    names=NameRules(
        longest=tables.LONGEST_NAME,
        case_sensitive=False,
        reserved=tables.RESERVED,
        further="abcdefghijklmnopqrstuvwxyz0123456789_-",
    ),
    modal_motion=True,
    curve_points=True,
    concurrent_moves="moves",
    ways_from_here=True,
    wrist_paths=False,
    waits_at_rest=False,
    notation="inform",
    rotation="zyx",
    conversions=frozenset(("real", "trunc", "round_half_away", "bit", "truth", "floor", "code", "char")),
    wait_timeout=True,
    counted_clocks=tables.WATCH_STEP_S,
    named_aggregates=True,
    partial_aggregates=False,
    constant_aggregates=True,
    untyped_places=True,
    shortest_wait_s=0.01,
    relative_moves=True,
    turned_ways=frozenset(("base", "tool")),
    local_routines=False,
    function_routines=False,
    faults_outside=False,
    faults_fractions=False,
    parameters="none",
    locals=False,
    flags=False,
    recursion=False,
    call_depth=tables.DEEPEST_CALL,
    search_results=frozenset(("found", "hit")),
    task_operations=frozenset(("start", "join")),
    moving_tasks=False,
    late_triggers=False,
    banks={
        "IntType": tables.D,
        "RealType": tables.R,
        "BoolType": tables.B,
        "StringType": tables.S,
        "PoseType": tables.P,
        "TargetType": tables.P,
        "JointsType": tables.P,
    },
    points=tables.POINTS,
    records=False,
    arrays=False,
    expressions="steps",
    calculated_places=False,
    conditions="comparisons",
    condition_terms=tables.SURE_TERMS,
    functions_alone=True,
    index_base=None,
    numbered_messages=True,
    longest_message=tables.LONGEST_MESSAGE,
    asks_numbers_only=True,
    group_sizes=(8, 4),
    widest_group=16,
    move_settings=frozenset(("tool", "frame", "speed", "blend", "deceleration")),
    speeds=frozenset(("joint", "path", "rotation")),
    blends=frozenset(("BlendStop", "BlendDistance", "BlendLevel")),
    static_locals=True,
    path_points=tables.TAGS["CR"][0],
    straight_distances=True,
    watched_interrupts=True,
    action_arguments=frozenset(("reaction",)),
    pulse_levels=False,
    poll_s=tables.WATCH_STEP_S,
)
