"""What VAL3 can say, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import Capabilities, NameRules

from . import tables

CAPABILITIES = Capabilities(
    statements=tables.words(
        """Assign CallRoutine If Switch For While Repeat Return Wait WaitUntil WaitForMotion StopMotion StartMotion
        ClearMotion Message TaskControl Nothing Move Vendor Opaque"""
    ),
    functions=frozenset(
        (
            *tables.FUNCTIONS,
            *("round", "trunc", "sign", "text_part", "text_find", "number_text", "value_text", "character_code"),
            *("offset", "tool_offset", "displaced", "displaced_in_tool", "inverse", "compose", "pose_of", "distance"),
            *("current_target", "current_joints", "joints_to_target", "task_runs", "frame_from_points"),
        )
    ),
    procedures=frozenset(),
    system_variables=tables.words("null_frame world override time moving"),
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary, "div")),
    types=frozenset((*tables.TYPES, "ArrayType")),
    names=NameRules(
        longest=tables.LONGEST_NAME,
        case_sensitive=True,
        reserved=tables.RESERVED - {"start", "stop"},
        first="abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ",
        further="abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_",
    ),
    modal_motion=True,
    notation="val3",
    rotation="zyx",
    keeps_angles=False,
    place_turns=False,
    short_circuit=True,
    conversions=tables.words("real round_half_away trunc bit truth floor"),
    signal_prefixes={
        "digital_in": "di",
        "digital_out": "do",
        "analog_in": "ai",
        "analog_out": "ao",
        "group_in": "gi",
        "group_out": "go",
    },
    for_real=True,
    wait_timeout=True,
    waits_at_rest=False,
    named_aggregates=True,
    index_base=0,
    function_routines=False,
    text_results=False,
    records=False,
    list_arguments=False,
    turned_ways=frozenset(),
    wrist_paths=False,
    paths_to_joints=False,
    computed_decimals=False,
    printable_texts=True,
    text_find_from=False,
    text_parts_cut=True,
    switch_types=frozenset(("IntType", "RealType", "StringType")),
    move_settings=frozenset(("tool", "frame", "speed", "blend")),
    speeds=frozenset(("joint", "path")),
    blends=frozenset(("BlendDistance",)),
    places_beside=True,
    task_operations=frozenset(("start", "stop", "pause", "resume")),
    poll_s=0.004,
    said_otherwise=frozenset(("type SignalType",)),
)
