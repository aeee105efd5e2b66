"""What a V+ controller can say, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import (
    ActionArguments,
    Aggregate,
    Capabilities,
    Composite,
    Control,
    Counting,
    Data,
    DataRule,
    Errors,
    Fault,
    InterruptRule,
    Interrupts,
    Io,
    Limit,
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
    SettingRule,
    Settings,
    Storage,
    Tasks,
    TextRule,
    Texts,
)

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
    system_variables=frozenset(
        (*tables.SYSTEM, *tables.SETTINGS, "timer", "flag", "moving", "actual_joint", "remaining_distance")
    ),
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary, *tables.WRITTEN_OPERATORS)),
    types=tables.words("RealType BoolType StringType PoseType TargetType JointsType ArrayType"),
    said_otherwise={
        "function target_to_joints_near": "the words of the posture that the joints mean (RIGHTY, ABOVE, FLIP)",
        "statement StartMotion": "nothing: no motion is held back behind a BRAKE",
        "system variable timer_stopped": "nothing: timers run on; one that is read while it stands is a variable",
    },
    names=NameRules(
        longest=tables.LONGEST_NAME,
        case_sensitive=False,
        reserved=tables.RESERVED,
        first="abcdefghijklmnopqrstuvwxyz",
        further="abcdefghijklmnopqrstuvwxyz0123456789_.",
    ),
    conversions=tables.words("real round_half_away trunc bit truth minus_bit floor code char"),
    places=Places(
        notation="vplus",
        postures=Postures.JOINTS,
        rules=frozenset((PlaceRule.IN_BASE, PlaceRule.WHOLE)),
    ),
    motion=Motion(
        concurrent=True,
        relative=True,
        paths=frozenset((PathRule.STRAIGHT_DISTANCES, PathRule.TIMED_ARCS, PathRule.TO_JOINTS)),
    ),
    settings=Settings(
        modal=True,
        rules=frozenset((SettingRule.ASKED_FRAME, SettingRule.NEXT_MOVE, SettingRule.TOOL_IN_FORCE)),
        of_moves=frozenset((MoveSetting.BLEND, MoveSetting.FRAME, MoveSetting.SPEED)),
        speeds=frozenset(("joint", "path", "duration")),
        blends=tables.words("BlendDistance BlendPercent BlendSpeed BlendZone"),
    ),
    interrupts=Interrupts(
        action_arguments=frozenset((ActionArguments.OWN, ActionArguments.PATH)),
        rules=frozenset((InterruptRule.MASKED, InterruptRule.ONE_SHOT, InterruptRule.STOPPING)),
    ),
    tasks=Tasks(operations=frozenset(("start", "stop"))),
    io=Io(
        last_flag=tables.LAST_FLAG,
        widest_group=32,
        timers=tables.TIMERS,
        poll_s=0.016,
        number_data={kind: ((1, tables.MOST_SIGNALS, tables.SIGNALS[kind]),) for kind in ("digital_in", "digital_out")},
        groups=frozenset(),  # BITS n, 8: whose signals those are shows only when the program runs
    ),
    texts=Texts(
        rules=frozenset(
            (
                TextRule.CASE,
                TextRule.FIND_FROM,
                TextRule.LEADING_NUMBERS,
                TextRule.LINE_ENDS,
                TextRule.ORDER,
                TextRule.PARTS,
            )
        )
    ),
    data=Data(
        rules=frozenset((DataRule.ROW_SIZES,)),
        composites=frozenset((Composite.ARRAYS,)),
        aggregates=frozenset((Aggregate.NAMED,)),
    ),
    errors=Errors(faults=frozenset((Fault.INDEX_FRACTION,))),
    routines=Routines(
        most_arguments=5,  # a call stands in one line: what nothing reads is left out of longer ones
        rules=frozenset((RoutineRule.LOCAL, RoutineRule.RECURSION, RoutineRule.TEXT_RESULTS)),
        locals=frozenset((Local.CLOCKS, Local.STATICS, Local.VARIABLES)),
        passing=frozenset((Passing.REFERENCES,)),
    ),
    control=Control(
        switch_types=tables.words("RealType IntType"),
        limits=frozenset((Limit.ONE_BRANCH,)),
        counting=frozenset((Counting.REAL,)),
    ),
    storage=Storage(module_points=ModulePoints.GLOBAL),
)
