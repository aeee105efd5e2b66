"""What RPL can say: everything."""

from __future__ import annotations

from typing import get_args

from rpl import ir
from rpl.ir import words
from rpl.passes.capabilities import (
    Aggregate,
    Composite,
    Control,
    Counting,
    Data,
    Errors,
    GroupRule,
    Io,
    Local,
    Passing,
    Places,
    RoutineRule,
    Routines,
    Settings,
)
from rpl.writing.target import Capabilities, NameRules

CAPABILITIES = Capabilities(
    statements=frozenset(node.__name__ for node in get_args(ir.Statement)),
    functions=frozenset(ir.FUNCTIONS),
    procedures=frozenset(ir.PROCEDURES),
    system_variables=frozenset(ir.SYSTEM_VARIABLES),
    operators=frozenset((*ir.BINARY_OPERATORS, *ir.UNARY_OPERATORS)),
    types=frozenset(node.__name__ for node in get_args(ir.Type)),
    names=NameRules(
        longest=1000,
        case_sensitive=True,
        reserved=words.RESERVED,
        first="abcdefghijklmnopqrstuvwxyz_$",
        further="abcdefghijklmnopqrstuvwxyz0123456789_$.",
    ),
    conversions=frozenset(ir.CONVERSIONS),
    carries_rules=True,
    places=Places(notation=words.NATIVE),
    settings=Settings(modal=True),
    io=Io(wait_timeout=True, timers=1_000_000, groups=frozenset((GroupRule.COMPUTED, GroupRule.NUMBERED))),
    data=Data(
        composites=frozenset((Composite.ARRAYS, Composite.ENUMS, Composite.RECORDS)),
        aggregates=frozenset((Aggregate.NAMED, Aggregate.PARTIAL)),
    ),
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
        locals=frozenset((Local.CLOCKS, Local.STATICS, Local.VARIABLES)),
    ),
    control=Control(
        short_circuit=True,
        counting=frozenset((Counting.AT_LEAST_ONCE, Counting.AUTOMATIC, Counting.REAL, Counting.SCOPED)),
    ),
)
