"""What came of every sample in every target: the table behind docs/support.md, and the page itself.

    python tests/conformance/outcomes.py            runs all of it, writes `outcomes.json` beside this file and the page
    python tests/conformance/outcomes.py page       writes the page alone, from the outcomes that are recorded
    ... [words of sample names] [to:TARGET ...]     shows these pairs, writes nothing

The conformance tests compare each pair with the file, so that a refusal that appears or goes is seen. A row that comes
to the table of refusals needs the page alone.
"""

from __future__ import annotations

import json
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from string import Formatter

from loading import objections

from rpl import ir, registry
from rpl.cell import Cell
from rpl.diagnostics import Diagnostic, Diagnostics, Severity
from rpl.emulator.model import load_robot
from rpl.errors import RplError
from rpl.ir.walk import walk
from rpl.passes.legalise.refusals import REFUSALS
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_against, recorded_run
from rpl.proof.record import Record
from rpl.proof.wiring import with_signal_names
from rpl.simulation import entry_name
from rpl.source import source_from_bytes
from rpl.translation import translate_program

HERE = Path(__file__).parent
FILE = HERE / "outcomes.json"
PAGE = HERE.parents[1] / "docs" / "support.md"

EXACT, NOTED, ALIKE, UNDECIDED = "exact", "noted", "alike", "undecided"
REFUSED, DIFFERENT = "refused", "different"
_ORDER = (EXACT, NOTED, ALIKE, UNDECIDED, REFUSED, DIFFERENT)
# Codes that say that something means the same in other words, or that concern a name only.
_HARMLESS = frozenset(("signal-number-chosen", "skipped-file"))


@dataclass(frozen=True)
class Outcome:
    """One sample in one target. status: exact, noted (equal, with notes), alike (measures deviate), undecided, refused
    (guarded stops, named), different. `refused`: code and words of each. `deviations`: the kinds of measures.
    `constructs`: word of a construct -> the worst that happened to it. `why`: the first difference."""

    status: str
    notes: tuple[str, ...] = ()
    refused: tuple[str, ...] = ()
    constructs: dict[str, str] = field(default_factory=dict)
    why: str = ""
    deviations: tuple[str, ...] = ()

    def as_json(self) -> dict[str, object]:
        return {
            "status": self.status,
            "notes": list(self.notes),
            "deviations": list(self.deviations),
            "refused": list(self.refused),
            "constructs": dict(sorted(self.constructs.items())),
        }


def outcome_of(
    read: ReadProgram, target: str, robot: str, cell: Cell | None, entry: str | None
) -> tuple[Outcome, Diagnostics]:
    """Write the program in the target, read it back, run both, and say what came of it."""
    diagnostics = Diagnostics()
    given = cell.variables if cell is not None else None
    around = cell.mechanisms if cell is not None else ()
    levels = cell.analog if cell is not None else ()
    translation = translate_program(
        read, target, robot, None, diagnostics, given=given, mechanisms=around, analog=levels
    )
    again = Diagnostics()
    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    back = read_sources(sources, target, again)
    errors = [item.as_text() for item in again.of(Severity.ERROR)] or objections(translation.files, back, target)
    if errors:
        return Outcome(DIFFERENT, why="; ".join(errors[:3])), diagnostics
    entry = entry_name(read.program, entry)
    to_entry = translation.renamed.get(entry, entry) if entry else None
    named = with_signal_names(back.program, translation.program)
    record = first_run(read, robot, cell, entry)
    result = prove_against(record, read.program, named, model_of(robot), cell, to_entry=to_entry or entry)
    refused = sorted({f"{item.code.name}: {item.message}" for item in diagnostics.of(Severity.LOSS)})
    notes = sorted({item.code.name for item in diagnostics.of(Severity.WARNING)} - _HARMLESS)
    if refused:
        status = REFUSED
    elif result.verdict in (DIFFERENT, UNDECIDED, ALIKE):
        status = result.verdict
    else:
        status = NOTED if notes else EXACT
    constructs = _constructs(read.program, diagnostics) if result.agrees or refused else {}
    why = "" if result.agrees else result.as_text()
    kinds = tuple(one.kind for one in result.open)
    return Outcome(status, tuple(notes), tuple(refused), constructs, why, kinds), diagnostics


model_of = cache(load_robot)
_RUNS: dict[tuple[int, str, str | None], tuple[ReadProgram, Cell | None, Record]] = {}
_KEPT = 8  # runs of sources; each target of a sample is compared with the same one


def first_run(read: ReadProgram, robot: str, cell: Cell | None, entry: str | None) -> Record:
    """The run of a source, made once for all the targets that it is compared with."""
    key = (id(read), robot, entry)
    known = _RUNS.get(key)
    if known is None or known[0] is not read or known[1] != cell:
        while len(_RUNS) >= _KEPT:
            del _RUNS[next(iter(_RUNS))]
        known = _RUNS[key] = (read, cell, recorded_run(read.program, model_of(robot), cell, entry))
    return known[2]


# ---- constructs: what the statements and expressions of a program are called

_SKIPPED = (ir.Nothing, ir.Label)
_CALLED = {
    ir.If: "if",
    ir.Switch: "switch",
    ir.For: "counting loop",
    ir.While: "while loop",
    ir.Repeat: "repeat loop",
    ir.Loop: "endless loop",
    ir.ExitLoop: "leave a loop",
    ir.NextPass: "next pass of a loop",
    ir.Goto: "jump",
    ir.Return: "return",
    ir.Wait: "wait for a time",
    ir.WaitForMotion: "wait for the robot",
    ir.LookAhead: "keep the look-ahead",
    ir.Pulse: "pulse on an output",
    ir.SetAfter: "output after a delay",
    ir.DeclareInterrupt: "interrupt on a condition",
    ir.ConnectInterrupt: "interrupt on a condition",
    ir.OrderInterrupt: "interrupt on a condition",
    ir.ControlInterrupt: "arm and disarm interrupts",
    ir.StopMotion: "stop the motion",
    ir.StartMotion: "go on with a stopped motion",
    ir.ClearMotion: "drop the motion",
    ir.StoreMotion: "put a path aside",
    ir.ResumeLevel: "leave an interrupt's level",
    ir.Raise: "raise an error",
    ir.Retry: "try the failed statement again",
    ir.TryNext: "go on behind the failed statement",
    ir.OnError: "error routine of a task",
    ir.Message: "message",
    ir.Dialog: "question to the operator",
    ir.Clock: "stop watch",
    ir.Critical: "critical section",
    ir.Meet: "tasks that wait for each other",
    ir.SetForNextMove: "setting for one move",
    ir.Trigger: "output or call on the path",
    ir.PathRule: "spline",
    ir.DefineTrigger: "output or call on the path",
    ir.MoveExternal: "move of external axes",
    ir.Spline: "spline",
    ir.Vendor: "statement of one controller",
    ir.CallRoutine: "call",
    ir.Do: "built-in procedure",
}


def _words(statement: ir.Statement) -> Iterator[str]:
    """The constructs that one statement shows."""
    match statement:
        case ir.Move(kind=kind, relative=relative):
            yield f"{kind} move" + ("" if relative is None else ", relative")
            if statement.search is not None:
                yield "search while moving"
            if statement.triggers:
                yield "output or call on the path"
            blend = type(statement.blend).__name__.removeprefix("Blend").lower()
            yield "stop" if statement.blend is None else f"corner: {blend}"
        case ir.Assign(target=ir.Signal(kind=kind)):
            yield f"set {kind.replace('_', ' ').removesuffix(' out')} output" if kind != "flag" else "set a flag"
        case ir.Assign(target=ir.System(name=name)):
            yield f"set {name.replace('_', ' ')}"
        case ir.Assign():
            yield "assignment"
        case ir.WaitUntil(timeout=timeout):
            yield "wait for a condition" + ("" if timeout is None else " with time-out")
        case ir.Halt(kind=kind):
            yield {"stop": "halt", "exit": "end the program", "cycle": "start the cycle again"}[kind]
        case ir.TaskControl(op=op):
            yield f"{op} a task"
        case _:
            word = _CALLED.get(type(statement))
            if word is not None:
                yield word


def _constructs(program: ir.Program, diagnostics: Diagnostics) -> dict[str, str]:
    """Each construct and the worst that was said of a statement that shows it."""
    said: dict[tuple[str, int], str] = {}
    for item in diagnostics:
        status = _status(item)
        if status is not None and item.origin.source is not None:
            key = (item.origin.file, item.origin.line)
            said[key] = _worst((said.get(key, EXACT), status))
    found: dict[str, str] = {}
    for module in program.modules:
        for routine in module.routines:
            for node in walk(routine.body, tuple(handler.body for handler in routine.handlers), routine.undo):
                if isinstance(node, _SKIPPED):
                    continue
                origin = getattr(node, "origin", None)
                if origin is None:
                    continue
                status = said.get((origin.file, origin.line), EXACT) if origin.source is not None else EXACT
                for word in _words(node):  # type: ignore[arg-type]
                    found[word] = _worst((found.get(word, EXACT), status))
            if routine.handlers:
                found["error handler"] = EXACT
            if routine.kind == "function":
                found["function"] = EXACT
    return found


def _status(item: Diagnostic) -> str | None:
    if item.severity == Severity.LOSS:
        return REFUSED
    return NOTED if item.severity == Severity.WARNING and item.code.name not in _HARMLESS else None


def _worst(statuses: Iterable[str]) -> str:
    return max(statuses, key=_ORDER.index)


# ---- the file and the page


def recorded() -> dict[str, dict[str, dict[str, object]]]:
    """sample -> target -> outcome, as it was found last."""
    found: dict[str, dict[str, dict[str, object]]] = json.loads(FILE.read_text("utf-8"))
    return found


def page(outcomes: dict[str, dict[str, dict[str, object]]]) -> str:
    """docs/support.md of the outcomes."""
    languages = sorted({sample.partition("-")[0] for sample in outcomes})
    targets = sorted({target for found in outcomes.values() for target in found})
    title = {name: registry.dialect(name).title for name in languages}
    lines = [
        "# What is supported",
        "",
        "This page is generated from the conformance run: every sample program of every language is executed, written",
        "in every target, read back with that target's own reader, executed again, and the two runs are compared.",
        "`python tests/conformance/outcomes.py` makes it.",
        "",
        "## Pairs",
        "",
        "Per pair, of all samples of the source: programs that are equal / alike (the same events in the same order,",
        "but measures such as joint speeds or corners deviate) / with a guarded stop.",
        "",
        "| from \\ to | " + " | ".join(targets) + " |",
        "|---|" + "---|" * len(targets),
    ]
    for language in languages:
        cells = [_cell(outcomes, language, target) for target in targets]
        lines.append(f"| {language} ({title[language]}) | " + " | ".join(cells) + " |")
    lines += ["", "## What translation refuses", "", *_table_of_refusals()]
    lines += ["", "## Refusals and differences", ""]
    lines += _refusals(outcomes)
    for language in languages:
        lines += ["", f"## {title[language]}", ""]
        lines += _construct_table(outcomes, language, targets)
    return "\n".join(lines) + "\n"


def _of(outcomes: dict[str, dict[str, dict[str, object]]], language: str) -> dict[str, dict[str, dict[str, object]]]:
    return {sample: found for sample, found in outcomes.items() if sample.partition("-")[0] == language}


def _cell(outcomes: dict[str, dict[str, dict[str, object]]], language: str, target: str) -> str:
    counts: defaultdict[str, int] = defaultdict(int)
    for found in _of(outcomes, language).values():
        if target in found:
            counts[str(found[target]["status"])] += 1
    text = f"{counts[EXACT] + counts[NOTED]} / {counts[ALIKE]} / {counts[REFUSED]}"
    text += f", {counts[UNDECIDED]} undecided" if counts[UNDECIDED] else ""
    return text + (f", {counts[DIFFERENT]} differ" if counts[DIFFERENT] else "")


def _table_of_refusals() -> list[str]:
    """The rows of the passes' table: what stops in a target that lacks it, why, and what the user can do."""
    lines = [
        "No target is given these where it lacks them. The report names the place, the output holds the target's stop",
        "there, and the rest of the file is translated. `...` stands for what the report names.",
        "",
        "| construct | why | by hand | report |",
        "|---|---|---|---|",
    ]
    for row in REFUSALS:
        cells = (row.what, _open(row.code.template), _open(row.code.help), f"`{row.code.name}`")
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def _open(template: str) -> str:
    """The words of a report, with `...` where it names something."""
    parts = (text + ("" if name is None else "...") for text, name, _, _ in Formatter().parse(template))
    return "".join(parts).replace("|", "\\|")


def _refusals(outcomes: dict[str, dict[str, dict[str, object]]]) -> list[str]:
    lines = ["| sample | target | what is refused |", "|---|---|---|"]
    for sample, found in sorted(outcomes.items()):
        for target, outcome in sorted(found.items()):
            told = "; ".join(_told(refusal) for refusal in outcome["refused"])  # type: ignore[attr-defined]
            if outcome["status"] == DIFFERENT:
                told = "differs: " + str(outcome.get("reason", "no reason is known"))
            if told:
                lines.append(f"| {sample} | {target} | {told} |")
    return lines


def _told(refusal: str) -> str:
    """`code: words` as the page shows it."""
    code, _, words = refusal.partition(": ")
    return f"{words.replace('|', chr(92) + '|')} (`{code}`)"


_SIGNS = {EXACT: "yes", NOTED: "note", REFUSED: "stop", DIFFERENT: "-"}


def _construct_table(outcomes: dict[str, dict[str, dict[str, object]]], language: str, targets: list[str]) -> list[str]:
    """Rows are constructs met in the language's samples. All of them are executed."""
    table: dict[str, dict[str, str]] = defaultdict(dict)
    for found in _of(outcomes, language).values():
        for target, outcome in found.items():
            for word, status in outcome["constructs"].items():  # type: ignore[attr-defined]
                table[word][target] = _worst((table[word].get(target, EXACT), status))
    others = [target for target in targets if target != language]
    lines = [
        "Every construct below is executed. `yes`: written exactly; `note`: written with a note; `stop`: refused by a",
        "guarded stop in the output, in at least one place where it was met; `-`: not compared.",
        "",
        "| construct | " + " | ".join(others) + " |",
        "|---|" + "---|" * len(others),
    ]
    for word in sorted(table):
        cells = [_SIGNS[table[word].get(target, DIFFERENT)] for target in others]
        lines.append(f"| {word} | " + " | ".join(cells) + " |")
    return lines


def results(name: str, targets: list[str]) -> dict[str, Outcome]:
    """One sample in these targets."""
    sys.path.insert(0, str(HERE))
    import test_conformance_samples as samples

    sample = next(sample for sample in samples.SAMPLES if samples.name_of(sample) == name)
    wanted, found = samples.expected(sample), {}
    for target in targets:
        try:
            outcome, _ = outcome_of(samples.programs_of(sample), target, wanted.robot, wanted.cell, wanted.entry)
        except RplError as error:
            outcome = Outcome(DIFFERENT, why=f"{type(error).__name__}: {error}")
        found[target] = outcome
    return found


def main(only: list[str]) -> None:
    """Run every sample in every target and write file and page. `page`: the page alone, nothing is run. With other
    words nothing is written: only samples whose name holds one of them are shown; `to:NAME`: only these targets;
    `write`: their rows are written nevertheless."""
    if only == ["page"]:
        PAGE.write_text(page(recorded()), "utf-8")
        return
    sys.path.insert(0, str(HERE))
    import test_conformance_samples as samples

    outcomes: dict[str, dict[str, dict[str, object]]] = {}
    targets = [word.removeprefix("to:") for word in only if word.startswith("to:")] or samples.TARGETS
    words = [word for word in only if word != "write" and not word.startswith("to:")]
    chosen = {samples.name_of(sample): sample for sample in samples.SAMPLES}
    names = [name for name in chosen if not words or any(word in name for word in words)]
    with ProcessPoolExecutor() as pool:
        for name, found in zip(names, pool.map(results, names, [targets] * len(names)), strict=True):
            for target, outcome in found.items():
                reason = samples.expected(chosen[name]).divergence(target)
                outcomes.setdefault(name, {})[target] = outcome.as_json() | ({"reason": reason} if reason else {})
                print(f"{name} -> {target}: {outcome.status}", *outcome.refused, sep="\n    ", flush=True)
                if outcome.status == DIFFERENT:
                    print("   ", outcome.why.replace("\n", "\n    "), flush=True)
    if only and "write" not in only:
        return
    if only:
        outcomes = recorded() | {name: recorded().get(name, {}) | found for name, found in outcomes.items()}
    FILE.write_text(json.dumps(dict(sorted(outcomes.items())), indent=1) + "\n", "utf-8")
    PAGE.write_text(page(outcomes), "utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
