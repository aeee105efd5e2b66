"""Programs run before and after passes: what they show (outputs, messages, moves, end) must be the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from rpl import ir, registry
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.passes.capabilities import Bank, Capabilities, Composite, DataRule, Limit
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.stages import Pass
from rpl.passes.typing import normalise
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

EVERYTHING: Capabilities = replace(registry.target("rpl").capabilities(), carries_rules=False)
# Everything in numbered storage, one operation a line: what the weakest controllers have.
REGISTERS = Bank("R", 1, 200)
POSITIONS = Bank("PR", 1, 100)
WEAK = replace(
    EVERYTHING,
    operators=EVERYTHING.operators - {"cand", "cor", "xor"},
    data=replace(EVERYTHING.data, composites=EVERYTHING.data.composites - {Composite.RECORDS, Composite.ARRAYS}),
    control=replace(
        EVERYTHING.control,
        short_circuit=False,
        limits=EVERYTHING.control.limits | {Limit.STEPS, Limit.COMPARISONS, Limit.PLAIN_PLACES},
    ),
)
NUMBERED = replace(
    WEAK,
    types=EVERYTHING.types - {"IntType", "NamedType"},
    data=replace(WEAK.data, rules=WEAK.data.rules - {DataRule.LISTS}),
    storage=replace(
        WEAK.storage,
        points=Bank("P", 1, 1000),
        banks={
            "RealType": REGISTERS,
            "IntType": REGISTERS,
            "BoolType": Bank("F", 1, 100),
            "StringType": Bank("SR", 1, 25),
            "PoseType": POSITIONS,
            "TargetType": POSITIONS,
            "JointsType": POSITIONS,
        },
    ),
)


def read(text: str, dialect: str = "rpl") -> ir.Program:
    """The normalised program of one source text."""
    suffix = {"krl": "src", "rapid": "mod"}.get(dialect, dialect)
    diagnostics = Diagnostics()
    found = read_sources([source_from_text(f"t.{suffix}", text)], dialect, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return found.program


def context(program: ir.Program, capabilities: Capabilities, **more: Any) -> Context:
    made = Context("rpl", "rpl", capabilities, Diagnostics(), **more)
    made.taken |= names_in(program)
    return made


def passed(program: ir.Program, passes: Sequence[Pass], given: Context) -> ir.Program:
    """The program behind the passes, in normal form."""
    for one in passes:
        program = one(program, given)
    again = Diagnostics()
    program = normalise(program, again)
    assert not len(again), [item.as_text() for item in again]
    return program


def run(program: ir.Program, cell: str = "", **more: Any) -> RunResult:
    return run_program(program, cell=parse_cell(cell) if cell else None, **more)


def shown(result: RunResult, timed: bool = False) -> tuple[Any, ...]:
    """What a run shows to the outside."""
    outputs = tuple((round(t, 6) if timed else 0, name, value) for t, name, value in result.outputs)
    moves = tuple(_move(event.data) for event in result.trace if event.kind == "move")
    fault = None if result.fault is None else result.fault.code
    return result.status, fault, outputs, result.messages, moves


def _move(data: dict[str, Any]) -> tuple[Any, ...]:
    return data.get("motion"), _rounded(data.get("joints")), _rounded(data.get("xyz_mm"))


def _rounded(values: Any) -> Any:
    return None if values is None else tuple(round(float(value), 6) + 0.0 for value in values)


def same(program: ir.Program, passes: Sequence[Pass], given: Context, cell: str = "", **more: Any) -> ir.Program:
    """The program behind the passes; it shows what it showed before."""
    after = passed(program, passes, given)
    assert shown(run(after, cell, **more)) == shown(run(program, cell, **more))
    return after
