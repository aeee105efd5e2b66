"""What a V+ controller can say, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import Capabilities, NameRules

from . import tables

CAPABILITIES = Capabilities(
    statements=tables.words(
        """Assign CallRoutine If Switch For While Repeat Loop ExitLoop NextPass Label Goto Return Halt Wait WaitUntil
        WaitForMotion DeclareInterrupt ControlInterrupt StopMotion ClearMotion Trigger Message Dialog Do TaskControl
        LookAhead Pulse SetAfter SetForNextMove OnError TryNext Nothing Move Vendor Opaque"""
    ),
    functions=frozenset(
        (
            *tables.FUNCTIONS,
            *tables.VALUES,
            *("tan", "asin", "acos", "atan", "round", "trunc", "floor", "ceil", "sign", "compose", "pose_of"),
            *("offset", "tool_offset", "displaced", "displaced_in_tool", "distance", "pose_zyz"),
            *("zyz_yaw", "zyz_pitch", "zyz_roll", "joints_to_target", "is_reachable", "frame_from_points"),
            *(
                "text_part",
                "text_find",
                "text_equal",
                "text_upper",
                "text_lower",
                "text_map",
                "number_text",
                "value_text",
                "format",
                "message_text",
                "number_bytes",
                "bytes_number",
            ),
            *("text_upper", "text_lower", "text_map"),
            *("is_uninitialised", "bit_shift_left", "power", "task_runs"),
        )
    ),
    procedures=tables.words("increment decrement clear text_append text_copy text_clear"),
    system_variables=frozenset((*tables.SYSTEM, *tables.SETTINGS, "timer", "flag", "moving", "actual_joint")),
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary, *tables.WRITTEN_OPERATORS)),
    types=tables.words("RealType BoolType StringType PoseType TargetType JointsType ArrayType"),
    said_otherwise=frozenset(
        (
            "function target_to_joints_near",  # the words of the posture that the joints mean (RIGHTY, ABOVE, FLIP)
            "statement StartMotion",  # nothing is held back behind a BRAKE
            "system variable remaining_distance",  # DISTANCE(HERE, DEST)
            "system variable timer_stopped",  # timers run on; only one that is read while it stands is another matter
            "type IntType",  # numbers of V+ are not declared, whole or not
        )
    ),
    names=NameRules(
        longest=tables.LONGEST_NAME,
        case_sensitive=False,
        reserved=tables.RESERVED,
        first="abcdefghijklmnopqrstuvwxyz",
        further="abcdefghijklmnopqrstuvwxyz0123456789_.",
    ),
    modal_motion=True,
    concurrent_moves="moves",
    line_ends=True,
    wrist_paths=False,
    reads_override=False,
    module_points="global",
    last_flag=tables.LAST_FLAG,
    most_arguments=5,  # a call stands in one line: what nothing reads is left out of longer ones
    computed_decimals=False,
    widest_group=32,
    notation="vplus",
    rotation="zyx",
    keeps_angles=False,
    conversions=tables.words("real round_half_away trunc bit truth minus_bit floor code char"),
    for_real=True,
    timers=tables.TIMERS,
    computed_groups=False,  # BITS n, 8: whose signals those are shows only when the program runs
    switch_types=tables.words("RealType IntType"),
    poll_s=0.016,
    else_if=False,
    function_routines=False,
    recursion=True,
    next_move_settings=True,
    text_ordering=True,
    text_parts=True,
    text_parts_cut=True,
    leading_numbers=True,
    stopping_reactions=True,
    interrupt_masks=True,
    one_shot_reactions=True,
    faults_outside=False,
    action_arguments=frozenset(("path", "own")),
    places_in_base=True,
    task_operations=frozenset(("start", "stop")),
    records=False,
    relative_moves=True,
    truth="minus_one",
    index_base=0,
    named_aggregates=True,
    whole_places=True,
    straight_distances=True,
    timed_arcs=True,
    move_settings=frozenset(("frame", "speed", "blend")),
    speeds=frozenset(("joint", "path", "duration")),
    blends=tables.words("BlendDistance BlendPercent BlendSpeed BlendZone"),
    postures="joints",
    place_turns=False,
    static_locals=True,
    arrays_by_value=False,
    list_arguments=False,
    write_only=frozenset(("analog_out",)),
)
