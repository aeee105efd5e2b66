"""What a Yaskawa controller can say in INFORM, for the passes that rewrite the rest."""

from __future__ import annotations

from rpl.passes.capabilities import (
    ActionArguments,
    Aggregate,
    Capabilities,
    Control,
    Data,
    Errors,
    Fault,
    Interrupts,
    Io,
    Limit,
    Local,
    MessageRule,
    Motion,
    MoveSetting,
    NameRules,
    Parameters,
    PathRule,
    PlaceRule,
    Places,
    PulseRule,
    RoutineRule,
    Routines,
    SearchResult,
    Settings,
    Storage,
    Tasks,
    Texts,
    TriggerRule,
    TurnedWay,
    Watched,
)

from . import tables

CAPABILITIES = Capabilities(
    statements=frozenset(
        (
            *("Assign", "CallRoutine", "If", "While", "For", "Label", "Goto", "Return", "Halt", "Wait", "WaitUntil"),
            *("Pulse", "Message", "TaskControl", "Vendor", "Opaque", "Nothing", "Move", "Search", "Trigger"),
            *("DeclareInterrupt", "ControlInterrupt", "Dialog"),
            "Clock",  # a task of the program counts it (passes/watches.py)
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
    said_otherwise={"statement WaitForMotion": "PL=0 of the move before it; nothing where the robot stands"},
    names=NameRules(
        longest=tables.LONGEST_NAME,
        case_sensitive=False,
        reserved=tables.RESERVED,
        further="abcdefghijklmnopqrstuvwxyz0123456789_-",
    ),
    conversions=frozenset(("real", "trunc", "round_half_away", "bit", "truth", "floor", "code", "char")),
    places=Places(
        notation="inform",
        rules=frozenset((PlaceRule.KEEP_ANGLES, PlaceRule.POSTURE_SAID, PlaceRule.TURNS, PlaceRule.UNTYPED)),
        move_functions=frozenset(("displaced",)),  # SFTON
    ),
    motion=Motion(
        concurrent=True,
        relative=True,
        turned_ways=frozenset((TurnedWay.BASE, TurnedWay.TOOL)),
        search_results=frozenset((SearchResult.FOUND, SearchResult.HIT)),
        paths=frozenset((PathRule.CURVE_POINTS, PathRule.CUT, PathRule.STRAIGHT_DISTANCES, PathRule.TO_JOINTS)),
        triggers=frozenset((TriggerRule.ANY_VARIABLE,)),
    ),
    settings=Settings(
        modal=True,
        of_moves=frozenset(
            (MoveSetting.BLEND, MoveSetting.DECELERATION, MoveSetting.FRAME, MoveSetting.SPEED, MoveSetting.TOOL)
        ),
        speeds=frozenset(("joint", "path", "rotation")),
        blends=frozenset(("BlendStop", "BlendDistance", "BlendLevel")),
    ),
    interrupts=Interrupts(watched=Watched.INTERRUPTS, action_arguments=frozenset((ActionArguments.REACTION,))),
    tasks=Tasks(operations=frozenset(("start", "join")), moving=False),
    io=Io(
        waits_at_rest=False,
        wait_timeout=True,
        wait_answers=False,  # in $B014, two lines more
        shortest_wait_s=0.01,
        last_flag=0,
        widest_group=16,
        poll_s=tables.WATCH_STEP_S,
        pulses=frozenset((PulseRule.COMPUTED_TIME,)),
    ),
    texts=Texts(
        longest_message=tables.LONGEST_MESSAGE,
        messages=frozenset((MessageRule.COMPUTED, MessageRule.NUMBERED)),
    ),
    data=Data(aggregates=frozenset((Aggregate.CONSTANT, Aggregate.NAMED)), composites=frozenset()),
    errors=Errors(faults=frozenset((Fault.TEXT_PART,))),
    routines=Routines(
        parameters=Parameters.NONE,
        rules=frozenset((RoutineRule.TEXT_RESULTS,)),
        locals=frozenset((Local.CLOCKS, Local.STATICS)),
    ),
    control=Control(
        limits=frozenset((Limit.COMPARISONS, Limit.FUNCTIONS_ALONE, Limit.PLAIN_PLACES, Limit.STEPS)),
    ),
    storage=Storage(
        banks={
            "IntType": tables.D,
            "RealType": tables.R,
            "BoolType": tables.B,
            "StringType": tables.S,
            "PoseType": tables.P,
            "TargetType": tables.P,
            "JointsType": tables.P,
        },
        own=frozenset((tables.TL, tables.UF)),
        points=tables.POINTS,
    ),
)
