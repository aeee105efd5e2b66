"""What a UR controller can say, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import (
    Aggregate,
    Capabilities,
    Control,
    Data,
    Errors,
    Fault,
    Interrupts,
    Io,
    Local,
    ModulePoints,
    Motion,
    MoveSetting,
    NameRules,
    Passing,
    PathRule,
    PlaceRule,
    Places,
    Postures,
    RoutineRule,
    Routines,
    SearchResult,
    Settings,
    Storage,
    TextRule,
    Texts,
    Watched,
)

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
    conversions=tables.words("real round_half_away trunc bit truth floor code char"),
    places=Places(
        notation="urscript",
        postures=Postures.JOINTS,
        rules=frozenset((PlaceRule.IN_BASE, PlaceRule.TURNS)),
    ),
    motion=Motion(
        turned_ways=frozenset(),
        search_results=frozenset((SearchResult.FOUND, SearchResult.HIT)),
        paths=frozenset((PathRule.FIXED_ARCS, PathRule.STRAIGHT_DISTANCES, PathRule.TO_JOINTS)),
    ),
    settings=Settings(
        modal=True,
        of_moves=frozenset((MoveSetting.BLEND, MoveSetting.FRAME, MoveSetting.SPEED)),
        speeds=frozenset(("joint", "axis", "path", "duration", "path_acceleration", "axis_acceleration")),
        blends=frozenset(("BlendDistance",)),
    ),
    storage=Storage(module_points=ModulePoints.GLOBAL),
    interrupts=Interrupts(watched=Watched.ALL),
    io=Io(
        wait_timeout=True,
        wait_answers=False,
        widest_group=32,
        last_flag=tables.FLAGS,
        poll_s=0.002,
        number_data={f"digital_{way}": tables.COUNTED_FROM_0 for way in ("in", "out")},
    ),
    texts=Texts(rules=frozenset((TextRule.CASE, TextRule.FIND_FROM, TextRule.PARTS, TextRule.PRINTABLE))),
    data=Data(aggregates=frozenset((Aggregate.NAMED,)), rules=frozenset()),
    errors=Errors(faults=frozenset((Fault.INDEX_OUTSIDE,))),
    routines=Routines(
        rules=frozenset(
            (
                RoutineRule.FUNCTIONS,
                RoutineRule.LIST_RESULTS,
                RoutineRule.LOCAL,
                RoutineRule.RECURSION,
                RoutineRule.TEXT_RESULTS,
            )
        ),
        passing=frozenset((Passing.ARRAYS_BY_VALUE, Passing.WRITTEN_LISTS)),
        locals=frozenset((Local.VARIABLES,)),
    ),
    control=Control(short_circuit=True),
)
