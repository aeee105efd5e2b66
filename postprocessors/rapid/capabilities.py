"""What RAPID can say, as data for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import Capabilities, NameRules

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
    aliases=True,
    compares_records=True,
    operators=OPERATORS,
    types=frozenset(type.__name__ for type in TYPE_NAMES),
    said_otherwise=frozenset(
        (
            "type ArrayType",  # `{n}` behind the name, of any type of the table
            "type NamedType",  # a RECORD by its name
            "statement Trigger",  # TriggL and kin, together with the move
        )
    ),
    names=NameRules(32, False, RESERVED, predefined=PREDEFINED),
    modal_motion=False,
    concurrent_moves="moves",
    shortest_interrupt_period_s=0.1,  # of ITimer, where it is not a single one
    line_ends=True,
    paths_to_joints=False,
    wrist_paths=False,
    turned_ways=frozenset(),
    reads_override=False,
    module_points="module",
    notation="rapid",
    whole_texts=True,
    rotation="quaternion",
    for_at_least_once=True,
    for_scoped=True,
    for_automatic=True,
    error_handlers=True,
    optional_parameters=True,
    short_circuit=True,
    conversions=frozenset(("real", "round_half_away", "trunc", "truth", "code", "char")),
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
    dynamic_calls=True,
    background_tasks="separate",
    moving_tasks=False,
    places_beside=True,
    no_tool="tool0",
    no_frame="wobj0",
    switch_types=frozenset(("IntType", "RealType", "StringType", "BoolType")),
)
