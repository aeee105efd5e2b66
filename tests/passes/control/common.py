"""Two made-up targets with the powers of real ones, and the check that a pass keeps what a run shows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.analog import AnalogPorts, AnalogRange
from rpl.passes.analog import AnalogRanges
from rpl.passes.capabilities import (
    Capabilities,
    Control,
    Counting,
    Errors,
    Io,
    Limit,
    NameRules,
    Passing,
    PlaceRule,
    Places,
    RoutineRule,
    Routines,
    Settings,
)
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.facts.effects import blocks, children, everything
from rpl.passes.legalise.stages import Pass
from rpl.passes.typing import normalise
from rpl.project import read_sources
from rpl.source import source_from_text

from .machine import run

COMMON = frozenset(
    (
        *("Assign", "CallRoutine", "If", "Switch", "For", "While", "Label", "Goto", "Return", "Halt", "Wait"),
        *("WaitUntil", "Message", "Do", "Nothing", "Pulse", "Move"),
    )
)
NAMES = NameRules(24, False, frozenset())
# What the programs show they show at an analogue output: as volts in KRL and RAPID, so that numbers stay as they are.
ANALOG = {
    language: AnalogRanges(language, said=(AnalogPorts("analog_out", AnalogRange((0.0, 10.0), (0.0, 10.0))),))
    for language in ("krl", "rapid")
}
OPERATORS = frozenset(("+", "-", "*", "/", "=", "<>", "<", ">", "<=", ">=", "and", "or", "not"))
# A controller with blocks but few functions: no early end of `and`, no handlers, no optional parameters.
PLAIN = Capabilities(
    statements=COMMON | {"Repeat", "Loop", "ExitLoop"},
    functions=frozenset(
        ("abs", "sqrt", "sin", "cos", "tan", "acos", "atan2", "text_length", "text_equal", "text_find")
    ),
    procedures=frozenset(("text_append", "text_copy", "text_clear", "format_into")),
    system_variables=frozenset(("timer", "timer_stopped")),
    operators=OPERATORS | {"div", "band", "bor", "bxor", "xor", "bnot"},
    types=frozenset(("IntType", "RealType", "BoolType", "CharType", "StringType")),
    names=NAMES,
    conversions=frozenset(("real", "round_half_away", "code", "char")),
    places=Places(notation="krl"),
    settings=Settings(modal=True),
    io=Io(timers=16),
    routines=Routines(rules=frozenset((RoutineRule.FUNCTIONS, RoutineRule.LOCAL, RoutineRule.RECURSION))),
    control=Control(
        switch_types=frozenset(("IntType", "CharType", "NamedType")), limits=frozenset((Limit.CONSTANT_CASES,))
    ),
)
# A controller with handlers, early `and`, its own loop counters, but neither Repeat nor ExitLoop nor bit operators.
RICH = Capabilities(
    statements=COMMON | {"Raise", "Retry", "TryNext", "Clock"},
    functions=frozenset(ir.FUNCTIONS) - {"floor", "ceil", "min", "max", "text_find_any"},
    procedures=frozenset(("increment", "decrement", "clear")),
    system_variables=frozenset(),
    operators=OPERATORS | {"div", "mod", "cand", "cor", "&", "xor"},
    types=frozenset(("RealType", "BoolType", "StringType", "ClockType")),
    names=NAMES,
    places=Places(notation="rapid", rules=frozenset((PlaceRule.KEEP_ANGLES, PlaceRule.QUATERNIONS, PlaceRule.TURNS))),
    settings=Settings(modal=False),
    io=Io(wait_timeout=True),
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
        counting=frozenset((Counting.AT_LEAST_ONCE, Counting.AUTOMATIC, Counting.REAL, Counting.SCOPED)),
    ),
)


def read(dialect: str, *texts: str) -> ir.Program:
    suffix = {"krl": "src", "rapid": "mod"}[dialect]
    diagnostics = Diagnostics()
    sources = [source_from_text(f"part{at}.{suffix}", text) for at, text in enumerate(texts)]
    program = read_sources(sources, dialect, diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return program


def context(program: ir.Program, capabilities: Capabilities) -> Context:
    source = program.modules[0].dialect
    made = Context(source, "rapid" if source == "krl" else "krl", capabilities, Diagnostics())
    made.taken |= names_in(program)
    made.analog = ANALOG
    return made


def legalised(program: ir.Program, capabilities: Capabilities, *passes: Pass) -> tuple[ir.Program, Context]:
    given = context(program, capabilities)
    for one in passes:
        program = one(program, given)
        diagnostics = Diagnostics()
        again = normalise(program, diagnostics)
        assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
        assert not [item for item in diagnostics if item.code.name.startswith("unknown")], [
            item.as_text() for item in diagnostics
        ]
        del again
    return program, given


def same_run(
    program: ir.Program, capabilities: Capabilities, *passes: Pass, inputs: Any = None, entry: str = "main"
) -> ir.Program:
    """The rewritten program, after checking that its run shows the same."""
    after, _ = legalised(program, capabilities, *passes)
    # A rewritten program says itself that nobody handles an error; a controller does that for the original.
    shown = [one for one in run(after, entry, inputs) if "is not handled" not in str(one)]
    wanted = run(program, entry, inputs)
    if ("end", "limit") in (shown[-1], wanted[-1]):  # an endless program was cut off, not at the same place
        common = min(len(shown), len(wanted)) - 1
        shown, wanted = shown[:common], wanted[:common]
    assert shown == wanted
    return after


def nodes(program: ir.Program) -> Sequence[object]:
    """All statements and expressions of a program."""
    found: list[object] = []

    def body(statements: ir.Body) -> None:
        for statement in statements:
            found.append(statement)
            for child in children(statement):
                found.extend(everything(child))
            for inner in blocks(statement):
                body(inner)

    for module in program.modules:
        for routine in module.routines:
            for one in (routine.body, *(handler.body for handler in routine.handlers), routine.undo):
                body(one)
    return found


def count(program: ir.Program, wanted: Callable[[object], bool] | type) -> int:
    test = wanted if not isinstance(wanted, type) else lambda node: isinstance(node, wanted)
    return sum(1 for node in nodes(program) if test(node))
