"""Every sample, in every language: reads without an error, does what it says, and still does when written anew.

Driven by the registry and by `samples/<language>/<sample>/expected.toml`; names no vendor. Keys of `expected.toml`:

    robot = "..."            the arm it is written for
    status = "finished"      how the run ends (default)
    outputs = [["do1", true], ...]   changes in order, each signal by any of its names (left out: not checked)
    messages = ["..."]       in order (left out: not checked)
    cell = "cell.toml"       surroundings, relative to the sample
    entry = "main"           routine to start with
    end_xyz_mm = [x, y, z]   where the tool stands at the end
    retarget = ["..."]       other arms that the sample must run on after translation
    divergences = ["rapid: why"]     targets in which it cannot mean the same, with the reason
    quick = ["rapid"]        targets that it is written in by the quick tests (default: all)
"""

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from outcomes import ALIKE, DIFFERENT, PAGE, REFUSED, first_run, model_of, outcome_of, page, recorded

from rpl import registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.legalise.refusals import REFUSALS
from rpl.project import ReadProgram, read_program, read_sources
from rpl.proof.prove import ProofResult, load_cell, prove_against
from rpl.proof.record import signal_names
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.source import source_from_bytes
from rpl.translation import translate_program

ROOT = Path(__file__).parents[2]
SAMPLES = sorted(path.parent for path in (ROOT / "samples").glob("*/*/expected.toml"))
TARGETS = registry.target_names()
KNOWN_KEYS = {
    *("robot", "status", "outputs", "messages", "cell", "entry", "end_xyz_mm", "retarget", "divergences"),
    *("title", "description", "source", "sources", "max_time", "quick"),
}


def name_of(sample: Path) -> str:
    return f"{sample.parent.name}-{sample.name}"


each_sample = pytest.mark.parametrize("sample", SAMPLES, ids=name_of)


@dataclass(frozen=True)
class Expected:
    data: dict[str, Any]
    folder: Path

    @property
    def robot(self) -> str:
        return str(self.data["robot"])

    @property
    def cell(self) -> Any:
        return load_cell(str(self.folder / self.data["cell"]) if "cell" in self.data else None)

    @property
    def entry(self) -> str | None:
        return self.data.get("entry")

    def divergence(self, target: str) -> str | None:
        for line in self.data.get("divergences", []):
            name, _, reason = line.partition(":")
            if name.strip() == target:
                return str(reason.strip())
        return None


@cache
def expected(sample: Path) -> Expected:
    data = tomllib.loads((sample / "expected.toml").read_text("utf-8"))
    return Expected(data, sample)


@cache
def read(sample: Path) -> tuple[ReadProgram, Diagnostics]:
    diagnostics = Diagnostics()
    return read_program([sample], None, diagnostics), diagnostics


def programs_of(sample: Path) -> ReadProgram:
    return read(sample)[0]


def proof_of(sample: Path, target: str, to_robot: str | None = None) -> tuple[ProofResult, Diagnostics]:
    """Write the sample in the target, read it back, run both."""
    wanted, program = expected(sample), programs_of(sample)
    diagnostics = Diagnostics()
    given = wanted.cell.variables if wanted.cell is not None else None
    levels = wanted.cell.analog if wanted.cell is not None else ()
    translation = translate_program(program, target, wanted.robot, to_robot, diagnostics, given=given, analog=levels)
    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    again = Diagnostics()
    back = read_sources(sources, target, again)
    assert not again.has_errors, [item.as_text() for item in again.of(Severity.ERROR)]
    entry = wanted.entry
    to_entry = translation.renamed.get(entry, entry) if entry else None
    other = model_of(to_robot or wanted.robot)
    named = with_signal_names(back.program, translation.program)
    record = first_run(program, wanted.robot, wanted.cell, entry)
    result = prove_against(record, program.program, named, other, wanted.cell, to_entry=to_entry)
    return result, diagnostics


def test_every_language_that_is_read_has_samples() -> None:
    lonely = [name for name in registry.dialect_names() if not any(sample.parent.name == name for sample in SAMPLES)]
    assert not lonely, f"no samples for {', '.join(lonely)}"


@each_sample
def test_its_expectations_are_spelled_right(sample: Path) -> None:
    assert not set(expected(sample).data) - KNOWN_KEYS


@each_sample
def test_it_reads_without_an_error(sample: Path) -> None:
    program, diagnostics = read(sample)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics.of(Severity.ERROR)]
    assert program.dialects == (sample.parent.name,)
    assert sum(report.opaque for report in program.files) == 0


@each_sample
def test_it_does_what_it_says(sample: Path) -> None:
    from rpl.simulation import run_program

    wanted, program = expected(sample), programs_of(sample).program
    robot = model_of(wanted.robot)
    result = run_program(program, robot, wanted.cell, wanted.entry)
    assert result.status == wanted.data.get("status", "finished"), result.as_json()["fault"]
    if "outputs" in wanted.data:
        shown = [(name, value) for _, name, value in result.outputs]
        asked = [(name, value) for name, value in wanted.data["outputs"]]
        assert len(shown) == len(asked), shown
        for (name, value), (wanted_name, wanted_value) in zip(shown, asked, strict=True):
            assert signal_names(None, [name]) & signal_names(None, [wanted_name]), (wanted_name, shown)
            assert value == pytest.approx(wanted_value), (wanted_name, shown)
    if "messages" in wanted.data:
        assert list(result.messages) == wanted.data["messages"]
    if "end_xyz_mm" in wanted.data:
        stretches = next(iter(record_of(result, program, robot).motion.values()))
        assert stretches[-1].poses[-1, :3, 3] == pytest.approx(wanted.data["end_xyz_mm"], abs=0.01)


def pairs() -> list[Any]:
    """Every sample in every target; slow where the sample leaves a target out of the quick ones."""
    found = []
    for sample in SAMPLES:
        quick = expected(sample).data.get("quick", TARGETS)
        for target in TARGETS:
            marks = [] if target in quick else [pytest.mark.slow]
            found.append(pytest.param(sample, target, id=f"{name_of(sample)}-{target}", marks=marks))
    return found


@pytest.mark.parametrize(("sample", "target"), pairs())
def test_it_means_the_same_when_written_anew(sample: Path, target: str) -> None:
    """Equal, or refused by name; and just as docs/support.md says."""
    reason = expected(sample).divergence(target)
    wanted = expected(sample)
    outcome, _ = outcome_of(programs_of(sample), target, wanted.robot, wanted.cell, wanted.entry)
    if reason is None:
        assert outcome.status != DIFFERENT, outcome.why
    else:
        assert outcome.status in (ALIKE, DIFFERENT, REFUSED), f"no divergence any more ({reason}): take it off the list"
    found = outcome.as_json() | ({"reason": reason} if reason else {})
    told = recorded().get(name_of(sample), {}).get(target)
    assert found == told, "docs/support.md says otherwise: python tests/conformance/outcomes.py brings it up to date"


def test_the_page_of_what_is_supported_is_current() -> None:
    assert PAGE.read_text("utf-8") == page(recorded())


def test_every_refusal_is_on_the_page_with_what_to_do_by_hand() -> None:
    text = page(recorded())
    for row in REFUSALS:
        assert row.code.help, f"{row.code.name} does not say what the user can do"
        assert f"| {row.what} | " in text
        assert f" | `{row.code.name}` |" in text


def test_every_pair_of_languages_is_on_the_page() -> None:
    pairs = {(sample.partition("-")[0], target) for sample, found in recorded().items() for target in found}
    assert pairs == {(name, target) for name in registry.dialect_names() for target in TARGETS}


@each_sample
def test_it_means_the_same_on_another_arm(sample: Path) -> None:
    arms = expected(sample).data.get("retarget", [])
    for arm in arms:
        for target in TARGETS:
            if expected(sample).divergence(target) is None:
                result, _ = proof_of(sample, target, arm)
                assert result.agrees, f"{target} on {arm}: {result.as_text()}"
