"""The proof's own mutation test (benchmarks/mutants.py), a small fixed part of it: what is changed must be told."""

import sys
from functools import cache
from pathlib import Path

import pytest

from rpl.ir.walk import walk

ROOT = Path(__file__).parents[2]
sys.path.append(str(ROOT / "benchmarks"))

import mutants as mutation  # noqa: E402
from mutation_operators import Mutant, mutants  # noqa: E402
from mutation_sites import replaced, sites  # noqa: E402

SMALL = ("inform/dispensing", "krl/machine_tending", "rapid/turntable", "rpl/pick_and_place", "tp/machine_tending")
SEEN = (
    "coordinate +1 mm",
    "joint +0.5 deg",
    "tool or frame +1 mm",
    "path speed +20 %",
    "wait +1 ms",
    "pulse three times as long",
    "output inverted",
    "output dropped",
    "number of an output +1",
    "move dropped",
    "joint move for linear move",
    "condition negated",
    "external axis +1",
)


@cache
def sample(name: str) -> mutation.Sample:
    return mutation.sample_of(ROOT / "samples" / name)


@cache
def side(name: str) -> mutation.Side:
    return sample(name).side()


@pytest.mark.parametrize("name", SMALL)
def test_every_mutant_changes_one_place(name: str) -> None:
    program = side(name).program
    before = {site.path: site.value for site in sites(program)}
    seen = set()
    for mutant in mutants(program):
        changed = replaced(program, mutant.path, mutant.value)
        seen.add(mutant.operator)
        for path, value in before.items():
            if path[: len(mutant.path)] == mutant.path or path == mutant.path[: len(path)]:
                continue  # the place itself, and what it lies in
            holder: object = changed
            for step in path:
                holder = holder[step] if isinstance(holder, tuple) else getattr(holder, str(step))  # type: ignore[index]
            assert holder is value, (mutant.operator, path)
        assert changed != program, (mutant.operator, mutant.site.place)
    assert len(seen) > 15


@pytest.mark.parametrize("name", SMALL)
def test_what_is_changed_is_told(name: str) -> None:
    one = side(name)
    reached = mutation.Reached(one.program, one.result)
    before = mutation.prove_recorded(one.record, one.record, one.program, one.program)
    as_it_was = mutation.shown(one.result)
    chosen: dict[str, Mutant] = {}
    for mutant in mutation.chosen(one.program, name, mutation.Drawn()):
        if mutant.operator in SEEN and all(reached.holds(needed) for needed in mutant.needs):
            chosen.setdefault(mutant.operator, mutant)
    assert len(chosen) >= 5
    for mutant in chosen.values():
        program = replaced(one.program, mutant.path, mutant.value)
        result, record = one.run(program, one.limits())
        verdict = mutation.prove_recorded(one.record, record, one.program, program)
        unseen = mutation.shown(result) == as_it_was
        assert mutation.told(verdict, before) or unseen, (mutant.operator, mutant.site.place, verdict.headline())


def test_a_machine_that_is_not_waited_for_is_told_across_controllers() -> None:
    """A wait is no event between two controllers; what it releases must not come before the input (door, clamp)."""
    first, second = side("inform/machine_tending"), mutation.translated(sample("inform/machine_tending"), "krl")
    before = mutation.prove_recorded(first.record, second.record, first.program, second.program)
    assert before.agrees
    waits = [m for m in mutants(first.program) if m.operator in ("wait dropped", "condition negated")]
    told = []
    for mutant in waits:
        program = replaced(first.program, mutant.path, mutant.value)
        _, record = first.run(program, first.limits())
        verdict = mutation.prove_recorded(record, second.record, program, second.program)
        if verdict.difference is not None and verdict.difference.kind == "wait":
            told.append(verdict.difference.explanation)
    assert len(told) == 2
    assert all("B waits until in[2] becomes True, A goes on before" in text for text in told)


def test_nodes_are_counted_once() -> None:
    program = side("rpl/pick_and_place").program
    assert sum(not site.is_body for site in sites(program)) == sum(1 for _ in walk(program.modules))


def test_the_page_holds_a_table_of_the_operators() -> None:
    text = mutation.PAGE.read_text("utf-8")
    part = text.partition(mutation.BEGIN)[2].partition(mutation.END)[0]
    assert "| change |" in part
    assert all(f"| {operator} |" in part for operator in SEEN)
