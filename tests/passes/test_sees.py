"""A pass is not called where a program holds nothing that it sees; it would then change and report nothing."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise import pipeline
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import kinds_in, kinds_of
from rpl.passes.legalise.stages import Pass
from rpl.project import read_sources
from rpl.source import source_from_bytes
from rpl.translation import translate_program

SAMPLES = Path(__file__).parents[2] / "samples"
PROGRAMS = {"rapid": ".mod", "krl": ".src", "vplus": ".v2", "rpl": ".rpl"}


@pytest.mark.parametrize("target", ["tp", "inform", "urscript"])
@pytest.mark.parametrize("language", list(PROGRAMS))
def test_a_pass_that_sees_nothing_does_nothing(language: str, target: str, monkeypatch: pytest.MonkeyPatch) -> None:
    skipped: list[str] = []
    acted: list[str] = []

    def checked(passes: Iterable[Pass], program: ir.Program, context: Context) -> ir.Program:
        for one in passes:
            if not one.needed(context):
                continue
            reported = len(context.diagnostics.items)
            done = one.run(program, context)
            if one.sees and one.sees.isdisjoint(kinds_in(program)):
                skipped.append(one.name)
                if done != program or len(context.diagnostics.items) != reported:
                    acted.append(one.name)
            program = done
        return program

    monkeypatch.setattr(pipeline, "run_passes", checked)
    paths = sorted((SAMPLES / language / "palletiser").rglob(f"*{PROGRAMS[language]}"))
    sources = [source_from_bytes(path.name, path.read_bytes()) for path in paths]
    read = read_sources(sources, language, Diagnostics())
    translate_program(read, target, "kuka_kr6r900sixx", None, Diagnostics())
    assert acted == []
    assert skipped


@pytest.mark.parametrize(
    ("node", "kinds"),
    [
        (ir.Move("linear", ir.Name("p")), "Move"),
        (ir.Move("joint", ir.Name("p"), relative="joints"), "Move|move relative to joints"),
        (ir.Move("linear", ir.Name("p"), motion_class="velocity"), "Move|velocity move"),
        (ir.Signal("flag", ir.IntLiteral(1)), "Signal|signal flag"),
        (ir.System("override"), "System|system override"),
    ],
)
def test_what_passes_see_of_a_node(node: object, kinds: str) -> None:
    assert "|".join(kinds_of(node)) == kinds
