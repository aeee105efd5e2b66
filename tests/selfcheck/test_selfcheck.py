"""Programs in the languages themselves that switch an output when an expectation holds: run, translated, run again.

The expectations are the manuals' (named in the programs). A program may leave gaps in its output numbers; every output
that it names in its own text must be on at the end, except those that stand for a wrong branch.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_program, read_sources
from rpl.simulation import run_program
from rpl.source import read_source, source_from_bytes, source_from_text
from rpl.translation import translate_program

HERE = Path(__file__).parent
KUKA, ABB = "kuka_kr6r900sixx", "abb_irb1200_5_90"
# program -> (arm it was written for, outputs that must be on at the end)
PROGRAMS = {
    "arith.src": (None, range(1, 33)),
    "moves.src": (KUKA, range(1, 8)),
    "checks.mod": (None, range(1, 31)),
    "motion.mod": ("abb_irb120_3_58", range(1, 7)),
}


def switched_on(read: ReadProgram, robot: str | None) -> set[int]:
    """Numbers of the digital outputs that are on when the program has finished."""
    result = run_program(read.program, robot)
    assert result.status == "finished", (result.status, result.fault)
    state: dict[int, bool] = {}
    for _, name, value in result.outputs:
        number = re.search(r"(\d+)\D*$", str(name))
        assert number, f"output {name!r} has no number"
        state[int(number.group(1))] = bool(value)
    return {number for number, on in state.items() if on}


def translated(
    read: ReadProgram, target: str, robot: str | None, to_robot: str | None, known: frozenset[str] = frozenset()
) -> ReadProgram:
    """The program written in the target and read back. `known`: codes of the losses that may come."""
    diagnostics = Diagnostics()
    written = translate_program(read, target, robot, to_robot, diagnostics)
    found = [item for item in diagnostics if item.severity.word in ("error", "loss")]
    problems = [item.as_text() for item in found if item.code.name not in known]
    assert not problems
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, again)
    assert not again.has_errors, [item.as_text() for item in again]
    return back


@pytest.mark.parametrize("name", PROGRAMS)
def test_every_expectation_is_met(name: str) -> None:
    robot, expected = PROGRAMS[name]
    diagnostics = Diagnostics()
    read = read_program([HERE / name], diagnostics=diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    assert set(expected) - switched_on(read, robot) == set()


@pytest.mark.parametrize("target", ["krl", "rapid", "rpl"])
@pytest.mark.parametrize("name", PROGRAMS)
def test_every_expectation_is_still_met_after_translation(name: str, target: str) -> None:
    robot, expected = PROGRAMS[name]
    read = read_program([HERE / name])
    back = translated(read, target, robot, None)
    assert set(expected) - switched_on(back, robot) == set()


def test_every_expectation_is_met_on_another_arm() -> None:
    robot, expected = PROGRAMS["moves.src"]
    # A relative joint move is the one arm's own (it is refused for another), and so are joint values read back.
    text = (HERE / "moves.src").read_text("utf-8").replace("PTP_REL {A1 10}\n", "")
    sources = [source_from_text("moves.src", text), read_source(HERE / "moves.dat")]
    back = translated(
        read_sources(sources, "krl", Diagnostics()), "rapid", robot, ABB, frozenset(("joints-not-converted",))
    )
    assert set(expected) - {1, 7} - switched_on(back, ABB) == set()
