"""What RAPID can say, as data for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import (
    Background,
    Capabilities,
    Control,
    Counting,
    Data,
    DataRule,
    Errors,
    Io,
    ModulePoints,
    Motion,
    NameRules,
    Passing,
    PlaceRule,
    Places,
    RoutineRule,
    Routines,
    SettingRule,
    Settings,
    Storage,
    Tasks,
    TextRule,
    Texts,
)

from .functions import FUNCTIONS
from .predefined import PREDEFINED
from .tables import OPERATORS, RESERVED, TYPE_NAMES, words

_STATEMENTS = words(
    """Assign CallRoutine If Switch For While Label Goto Return Halt Wait WaitUntil WaitForMotion Pulse SetAfter
    ConnectInterrupt OrderInterrupt ControlInterrupt StopMotion StartMotion ClearMotion StoreMotion Raise Retry
    TryNext Message Dialog Clock Do Vendor Nothing Move MoveExternal DefineTrigger Search Meet"""
)

CAPABILITIES = Capabilities(
    statements=_STATEMENTS,
    functions=frozenset(FUNCTIONS),
    procedures=words("increment decrement clear parse_value parse_number text_append text_copy text_clear"),
    system_variables=frozenset(
        (
            *("speed_percent", "speed_limit", "acceleration_percent", "acceleration_ramp", "stop_ramp"),
            *("joint_configuration_check", "path_configuration_check", "singularity_mode", "load", "override"),
            "displacement",
            *("error_number", "interrupt_number", "circle_orientation", "actual_pose", "actual_joints"),
        )
    ),
    operators=OPERATORS,
    types=frozenset(type.__name__ for type in TYPE_NAMES),
    names=NameRules(32, False, RESERVED, predefined=PREDEFINED, entry="main"),
    conversions=frozenset(("real", "round_half_away", "trunc", "truth", "code", "char")),
    places=Places(notation="rapid", rules=frozenset((PlaceRule.KEEP_ANGLES, PlaceRule.QUATERNIONS, PlaceRule.TURNS))),
    motion=Motion(concurrent=True, turned_ways=frozenset(), paths=frozenset()),
    settings=Settings(
        modal=False,
        rules=frozenset((SettingRule.ASKED_FRAME, SettingRule.TOOL_IN_FORCE)),
        bare=("tool0", "wobj0"),
    ),
    tasks=Tasks(background=Background.SEPARATE, moving=False),
    io=Io(
        signal_prefixes={
            "digital_in": "di",
            "digital_out": "do",
            "analog_in": "ai",
            "analog_out": "ao",
            "group_in": "gi",
            "group_out": "go",
        },
        wait_timeout=True,
    ),
    texts=Texts(
        rules=frozenset(
            (TextRule.CASE, TextRule.COMPUTED_DECIMALS, TextRule.FIND_FROM, TextRule.LINE_ENDS, TextRule.WHOLE)
        )
    ),
    data=Data(rules=frozenset((DataRule.ALIASES, DataRule.COMPARED_RECORDS, DataRule.ROW_SIZES))),
    errors=Errors(handlers=True),
    routines=Routines(
        rules=frozenset(
            (
                RoutineRule.COMPUTED_NAMES,
                RoutineRule.FUNCTIONS,
                RoutineRule.LOCAL,
                RoutineRule.RECURSION,
                RoutineRule.TEXT_RESULTS,
            )
        ),
        passing=frozenset((Passing.ARRAYS_BY_VALUE, Passing.OPTIONAL, Passing.REFERENCES, Passing.WRITTEN_LISTS)),
    ),
    control=Control(
        short_circuit=True,
        switch_types=frozenset(("IntType", "RealType", "StringType", "BoolType")),
        counting=frozenset((Counting.AT_LEAST_ONCE, Counting.AUTOMATIC, Counting.REAL, Counting.SCOPED)),
    ),
    storage=Storage(module_points=ModulePoints.MODULE),
)
