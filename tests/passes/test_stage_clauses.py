"""Behind each stage nothing is left of what its clause names, and no later stage brings it back: samples of every
language and two self-checking projects, for all targets.
"""

import tomllib
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from rpl import ir, registry, translation
from rpl.cell import Cell, read_cell
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise import legalise
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.pipeline import STAGES
from rpl.passes.legalise.stages import Clause, Pass, Placed, Run
from rpl.passes.legality import unguarded
from rpl.project import read_program

ROOT = Path(__file__).parents[2]
SAMPLES = [
    *sorted(one for language in ("krl", "rapid") for one in (ROOT / "samples" / language).iterdir()),
    *sorted((ROOT / "samples").glob("*/project")),
    *sorted((ROOT / "samples").glob("*/palletiser")),
    ROOT / "samples" / "vplus" / "reactions",
]
FOLDERS = {
    **{str(one.relative_to(ROOT)): one for one in SAMPLES if (one / "expected.toml").exists()},
    **{f"selfcheck/{name}": ROOT / "tests" / "selfcheck" / name for name in ("krl_logic", "rapid_cell")},
}
ROBOT = "kuka_kr6r900sixx"  # of the self-checking projects
REWRITING = [name for name in registry.target_names() if not registry.target(name).capabilities().carries_rules]


def _check(stage: str, kinds: frozenset[str], found: list[str]) -> Run:
    def run(program: ir.Program, context: Context) -> ir.Program:
        for one in unguarded(program, context.capabilities, context.diagnostics.items):
            if one.kind in kinds:
                found.append(f"behind {stage}: {one.kind} at {one.origin.file}:{one.origin.line}")
        return program

    return run


def checks(found: list[str]) -> tuple[Placed, ...]:
    """Behind the last pass of each stage a check of its own clause and of those of the stages before it."""
    kept = frozenset[str]()
    placed = []
    for stage in STAGES:
        kept |= stage.clause.kinds()
        placed.append(Placed(Pass(_check(stage.name, kept, found)), stage.name, behind=stage.passes[-1].name))
    return tuple(placed)


@cache
def _robot_and_cell(folder: Path) -> tuple[str, Cell]:
    expected, beside = folder / "expected.toml", folder / "cell.toml"
    data = tomllib.loads(expected.read_text("utf-8")) if expected.exists() else {}
    place = folder / str(data["cell"]) if "cell" in data else beside
    return str(data.get("robot", ROBOT)), read_cell(str(place)) if place.exists() else Cell()


@pytest.mark.parametrize("target", REWRITING)
@pytest.mark.parametrize("name", FOLDERS)
def test_what_a_stage_has_taken_away_stays_away(name: str, target: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[str] = []

    def checked(program: ir.Program, context: Context, own: tuple[Placed, ...] = ()) -> ir.Program:
        return legalise(program, context, (*own, *checks(found)))

    monkeypatch.setattr(translation, "legalise", checked)
    robot, cell = _robot_and_cell(FOLDERS[name])
    read = read_program([FOLDERS[name]], diagnostics=Diagnostics())
    translation.translate_program(
        read, target, robot, None, Diagnostics(), given=cell.variables, mechanisms=cell.mechanisms, analog=cell.analog
    )
    assert found == []


def test_a_kind_is_named_by_one_clause() -> None:
    named = Counter(kind for stage in STAGES for kind in stage.clause.kinds())
    assert [kind for kind, times in named.items() if times > 1] == []


def test_a_clause_names_kinds_as_the_comparison_with_the_tables_does() -> None:
    clause = Clause(statements="While Loop", operators="&", system="tool", types="ZoneType")
    assert clause.kinds() == {
        *("statement While", "statement Loop", "operator &", "system variable tool", "type ZoneType"),
    }
