"""There and back: a program is written in another language, read again by that language's reader, and run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rpl import ir
from rpl.cell import Cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.ir.analog import AnalogSetting
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import NOTHING_ACCEPTED, ProofResult, prove_programs
from rpl.proof.recording import record_of
from rpl.proof.tolerance import Accepted
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import Translation, translate_program


def entry_of(written: Translation, entry: str) -> str:
    """What the routine is called in a translation, whatever letters it is asked for in."""
    return next((new for old, new in written.renamed.items() if old.lower() == entry.lower()), entry)


@dataclass(frozen=True, slots=True)
class Journey:
    """A program, what was written, and what the target's reader made of it. `found`: of reading and of writing."""

    source: ReadProgram
    written: Translation
    back: ReadProgram
    found: Diagnostics
    robot: str | None

    @property
    def text(self) -> str:
        """All that was written."""
        return "\n".join(file.data.decode("latin-1") for file in self.written.files)

    @property
    def losses(self) -> list[str]:
        """The names of what the target cannot say."""
        return [item.code.name for item in self.found.of(Severity.LOSS)]

    @property
    def program(self) -> ir.Program:
        """What was read back, with the signals that the source names."""
        return with_signal_names(self.back.program, self.written.program)

    def run(self, entry: str = "main", cell: Cell | None = None, limit_s: float = 60.0) -> RunResult:
        """Run what was read back: from the routine that the source calls `entry`, in surroundings that are described in
        the words of the source; driven as proofs drive both, by constant accelerations."""
        theirs = in_words_of(cell, self.source.program, self.program) if cell is not None else None
        begins = entry_of(self.written, entry)
        return run_program(self.program, self.robot, theirs, begins, limit_s, controller="plain")

    def prove(self, entry: str = "main", accepted: Accepted = NOTHING_ACCEPTED) -> ProofResult:
        """Do the source and what was read back mean the same?"""
        to_entry = entry_of(self.written, entry)
        source, back = self.source.program, self.program
        return prove_programs(source, back, self.robot, entry=entry, to_entry=to_entry, accepted=accepted)

    def switched_on(self, result: RunResult) -> set[int]:
        """Numbers of the digital outputs that a run of what was read back switches on."""
        happenings = [one for task in record_of(result, self.program).tasks.values() for one in task]
        names = {name for one in happenings if one.kind == "output" and one.value for name in one.names}
        return {int(name.partition(":")[2]) for name in names if name.startswith("digital_out:")}


def there_and_back(
    files: Mapping[str, str],
    language: str,
    target: str,
    robot: str | None = None,
    analog: tuple[AnalogSetting, ...] = (),
) -> Journey:
    """Read the files (texts by name), write them in the target's language, and read that. What the readers find wrong
    is a failure here; losses are for the caller to look at."""
    found, again = Diagnostics(), Diagnostics()
    source = read_sources([source_from_text(name, text) for name, text in files.items()], language, found)
    assert not found.has_errors, [item.as_text() for item in found]
    written = translate_program(source, target, robot, None, found, analog=analog)
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, again)
    assert not again.has_errors, [item.as_text() for item in again]
    return Journey(source, written, back, found, robot)
