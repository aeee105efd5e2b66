"""What VAL3 can say, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import (
    Aggregate,
    Capabilities,
    Composite,
    Control,
    Counting,
    Data,
    Errors,
    Fault,
    Io,
    Motion,
    MoveSetting,
    NameRules,
    Passing,
    Places,
    RoutineRule,
    Routines,
    SearchResult,
    SettingRule,
    Settings,
    Tasks,
    TextRule,
    Texts,
)

from . import tables

CAPABILITIES = Capabilities(
    statements=tables.words(
        """Assign CallRoutine If Switch For While Repeat Loop ExitLoop NextPass Return Wait WaitUntil
        WaitForMotion StopMotion StartMotion ClearMotion Halt Pulse Message TaskControl Search Nothing Move Vendor
        Opaque"""
    ),
    functions=frozenset(
        (
            *tables.FUNCTIONS,
            *("round", "trunc", "sign", "text_part", "text_find", "number_text", "value_text", "character_code"),
            *("offset", "tool_offset", "displaced", "displaced_in_tool", "inverse", "compose", "pose_of", "distance"),
            *("current_target", "current_joints", "joints_to_target", "task_runs", "frame_from_points"),
            *("euler_x", "euler_y", "euler_z"),
        )
    ),
    procedures=frozenset(),
    system_variables=tables.words("null_frame world override time timer moving actual_pose"),
    operators=frozenset((*tables.OPERATORS.binary, *tables.OPERATORS.unary, "div")),
    types=frozenset((*tables.TYPES, "ArrayType")),
    names=NameRules(
        longest=tables.LONGEST_NAME,
        case_sensitive=True,
        reserved=tables.RESERVED - {"start", "stop"},
        first="abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ",
        further="abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_",
    ),
    conversions=tables.words("real round_half_away trunc bit truth floor"),
    places=Places(notation="val3", rules=frozenset()),
    motion=Motion(
        turned_ways=frozenset(),
        paths=frozenset(),
        search_results=frozenset((SearchResult.FOUND, SearchResult.HIT)),
    ),
    settings=Settings(
        modal=True,
        of_moves=frozenset(
            (MoveSetting.DECELERATION, MoveSetting.TOOL, MoveSetting.FRAME, MoveSetting.SPEED, MoveSetting.BLEND)
        ),
        speeds=frozenset(("joint", "path")),
        blends=frozenset(("BlendDistance",)),
        rules=frozenset((SettingRule.ASKED_FRAME, SettingRule.READ_OVERRIDE)),
    ),
    tasks=Tasks(operations=frozenset(("start", "stop", "pause", "resume"))),
    io=Io(
        signal_prefixes={
            "digital_in": "di",
            "digital_out": "do",
            "analog_in": "ai",
            "analog_out": "ao",
            "group_in": "gi",
            "group_out": "go",
        },
        pulses=frozenset(),
        timers=99,  # numbers that the passes choose from: each is a variable of the program
        wait_timeout=True,
        waits_at_rest=False,
        poll_s=0.004,
    ),
    texts=Texts(rules=frozenset((TextRule.CASE, TextRule.PARTS, TextRule.PRINTABLE))),
    data=Data(aggregates=frozenset((Aggregate.NAMED,)), composites=frozenset((Composite.ARRAYS,)), rules=frozenset()),
    routines=Routines(
        passing=frozenset((Passing.REFERENCES,)), rules=frozenset((RoutineRule.RECURSION, RoutineRule.TEXT_RESULTS))
    ),
    errors=Errors(faults=frozenset((Fault.INDEX_OUTSIDE, Fault.INDEX_FRACTION))),
    control=Control(
        counting=frozenset((Counting.REAL,)),
        short_circuit=True,
        switch_types=frozenset(("IntType", "RealType", "StringType")),
    ),
)
