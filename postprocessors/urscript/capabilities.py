"""What a UR controller can say, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import Capabilities, NameRules

from . import tables

_FURTHER = "abcdefghijklmnopqrstuvwxyz0123456789_"

CAPABILITIES = Capabilities(
    statements=tables.words(
        """Assign CallRoutine If Switch For While Repeat Loop ExitLoop NextPass Return Halt Wait WaitUntil
        WaitForMotion Pulse SetAfter StopMotion Clock Message Dialog Do TaskControl Critical Nothing Move Vendor
        Opaque Trigger Search DeclareInterrupt ControlInterrupt ResumeLevel"""
    ),
    functions=frozenset(
        (
            *tables.FUNCTIONS,
            *tables.TO_ANGLE,
            *tables.FROM_ANGLE,
            *("exp", "log", "log10", "round", "trunc", "fraction", "text_part", "text_find", "text_equal"),
            *("offset", "tool_offset", "displaced", "displaced_in_tool", "distance", "magnitude", "pose_of"),
            *("current_target", "current_joints", "target_to_joints", "joints_to_target"),
            *("rotation_vector_x", "rotation_vector_y", "rotation_vector_z", "pose_from_rotation_vector"),
            *("clock_seconds", "dimension", "target_to_joints_near", "is_reachable", "pose_sum", "pose_difference"),
        )
    ),
    procedures=tables.words("increment decrement clear text_append text_copy text_clear"),
    system_variables=tables.words("tool load null_frame world actual_pose actual_joints actual_joint flag"),
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary, *tables.OPERATOR_FUNCTIONS)),
    types=tables.words(
        "IntType RealType BoolType StringType PoseType TargetType JointsType NamedType ArrayType ClockType"
    ),
    names=NameRules(
        longest=tables.LONGEST_NAME,
        case_sensitive=True,
        reserved=tables.RESERVED,
        first="abcdefghijklmnopqrstuvwxyz_",
        further=_FURTHER,
    ),
    modal_motion=True,
    concurrent_moves="moves",
    wrist_paths=False,
    turned_ways=frozenset(),
    computed_decimals=False,
    notation="urscript",
    rotation="zyx",
    keeps_angles=False,
    short_circuit=True,
    conversions=tables.words("real round_half_away trunc bit truth floor code char"),
    wait_timeout=True,
    named_aggregates=True,
    partial_aggregates=False,
    index_base=0,
    faults_fractions=False,
    row_sizes=False,
    move_settings=frozenset(("frame", "speed", "blend")),
    speeds=frozenset(("joint", "axis", "path", "duration", "path_acceleration", "axis_acceleration")),
    blends=frozenset(("BlendDistance",)),
    postures="joints",
    straight_distances=True,
    widest_group=32,
    watching_tasks=True,
    last_flag=tables.FLAGS,
    fixed_arcs=True,
    text_parts=True,
    text_parts_cut=True,
    text_decimals=6,
    printable_texts=True,
    places_in_base=True,
    poll_s=0.002,
    search_results=frozenset(("found", "hit")),
    reference_parameters=False,
    local_clocks=False,
    list_results=True,
)
