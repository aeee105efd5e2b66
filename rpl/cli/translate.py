"""`rpl translate`: write programs in another controller's language, and prove on request that they mean the same."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import click

from rpl import registry
from rpl.cli.files import force_option, stale, write_files
from rpl.cli.output import (
    collector,
    from_option,
    json_option,
    paths_argument,
    print_diagnostics,
    print_json,
    print_text,
    read_paths,
    robot_option,
    robots_exist,
    say,
    waiting,
)
from rpl.cli.verdicts import accepting, exploring, status_of
from rpl.diagnostics import Diagnostic, Diagnostics, Severity
from rpl.errors import InternalError, UsageError

if TYPE_CHECKING:
    from rpl.project import ReadProgram
    from rpl.proof.tolerance import Accepted
    from rpl.proof.verdict import ProofResult
    from rpl.translation import Translation
    from rpl.writing.target import OutputFile

OK, NO, GUARDED = 0, 1, 3


@click.command("translate")
@paths_argument
@click.option("--to", "target", required=True, metavar="D", help="Language to write.")
@from_option
@robot_option
@click.option("--to-robot", metavar="R2", help="Arm that will run the result; else the same.")
@click.option(
    "-o", "--output", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", help="Folder to write."
)
@click.option("--entry", metavar="NAME", help="Routine that the program begins with; else as for run.")
@click.option("--prove", "proving", is_flag=True, help="Run both programs and compare what they do.")
@click.option("--cell", metavar="F.toml", help="Values of data that the controller keeps; surroundings for the proof.")
@click.option(
    "--registers",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Numbers of data that an earlier translation wrote (registers.csv); they are kept.",
)
@click.option(
    "--option", "options", multiple=True, metavar="NAME=VALUE", help="An option of the target language; repeatable."
)
@click.option("--strict", is_flag=True, help="Take every approximation for an error.")
@exploring
@accepting
@force_option
@json_option
def command(
    paths: Sequence[str],
    target: str,
    dialect: str | None,
    robot: str | None,
    to_robot: str | None,
    output: Path | None,
    entry: str | None,
    proving: bool,
    cell: str | None,
    registers: Path | None,
    options: Sequence[str],
    strict: bool,
    accepted: Accepted,
    explore: bool,
    as_json: bool,
) -> int:
    """Write programs in another controller's language.

    What the target cannot say becomes a comment and the target's own stop, is listed, and gives exit status 3. Without
    -o the program is printed. With --prove or --explore the first line is the verdict: equal, alike (exit status 3),
    different or undecided (1); --accept takes measures of the proof too.
    """
    from rpl.cell import read_cell
    from rpl.proof.cellnames import report_unknown_signals
    from rpl.translation import translate_program
    from rpl.writing.registers import read_registers

    own = _options(options)
    target = _target(target, own)
    robots_exist(robot, to_robot)
    kept = read_registers(registers) if registers is not None else None
    around = read_cell(cell) if cell is not None else None
    diagnostics = collector(sorted(accepted.kinds))
    read = read_paths(paths, dialect, diagnostics)
    if diagnostics.has_errors:
        return _refuse(diagnostics, as_json)
    read, before = _begun_at(read, entry), len(diagnostics)
    with waiting("writing"):
        report_unknown_signals(read.program, around, diagnostics)
        given = around.variables if around is not None else None
        beside = around.mechanisms if around is not None else ()
        levels = around.analog if around is not None else ()
        translation = translate_program(read, target, robot, to_robot, diagnostics, kept, own, given, beside, levels)
    if strict:
        _raise_approximations(diagnostics, before)
    if diagnostics.has_errors:
        return _refuse(diagnostics, as_json)
    proving, alone = proving or explore, output is None and not as_json
    shown = _printed(translation, target, proving) if alone else translation.files
    written = _write(shown, output, _registers(translation))
    proof = _prove(read, translation, target, (robot, to_robot), cell, accepted, entry, explore) if proving else None
    proof = proof and replace(proof, approximations=_approximations(diagnostics.items[before:]))
    print_diagnostics(diagnostics)
    if as_json:
        print_json(_document(translation, written, diagnostics, proof))
    else:
        _print(translation, written, output, proof, len(diagnostics.of(Severity.WARNING)))
    proved = status_of(proof) if proof is not None else OK
    return proved if proved != OK or not diagnostics.has_losses else GUARDED


def _target(word: str, options: dict[str, str]) -> str:
    """The name of the language to write. Raises UsageError for an unknown one, and for options that it has not."""
    found = registry.target_called(word)
    found.capabilities_under(options)
    return found.name


def _begun_at(read: ReadProgram, entry: str | None) -> ReadProgram:
    """The program beginning with that routine. Raises UsageError with the candidates when there is none."""
    if entry is None:
        return read
    from rpl.linking import link
    from rpl.simulation import find_entry

    found = find_entry(read.program, link(read.program), entry)
    return replace(read, program=replace(read.program, entry=found.name))


def _options(written: Sequence[str]) -> dict[str, str]:
    """`name=value` each."""
    found: dict[str, str] = {}
    for one in written:
        name, sign, value = one.partition("=")
        if not sign or not name.strip():
            raise UsageError(f"--option takes NAME=VALUE, not {one!r}")
        found[name.strip()] = value.strip()
    return found


def _refuse(diagnostics: Diagnostics, as_json: bool) -> int:
    """Nothing is written from a program with errors."""
    print_diagnostics(diagnostics)
    if as_json:
        items = [item.as_json() for item in diagnostics]
        print_json({"files": [], "diagnostics": items, "losses": [], "proof": None})
    say("rpl: nothing was written: the errors come first", err=True)
    return NO


def _raise_approximations(diagnostics: Diagnostics, first: int) -> None:
    for index in range(first, len(diagnostics.items)):
        if diagnostics.items[index].severity == Severity.WARNING:
            diagnostics.items[index] = replace(diagnostics.items[index], severity=Severity.ERROR)


def _write(files: Sequence[OutputFile], output: Path | None, registers: bytes | None) -> list[dict[str, object]]:
    """Write the files, with the numbers that data has got beside them; give their text when no folder is named."""
    from rpl.writing.registers import FILE_NAME

    for file in files:
        inside = PurePosixPath(file.path)
        if inside.is_absolute() or ".." in inside.parts:
            raise UsageError(f"the name {file.path!r} leads out of the output folder: nothing is written under it")
    if output is None:
        return [{"path": file.path, "text": _text(file)} for file in files]
    written = {output / PurePosixPath(file.path): file.data for file in files}
    if registers is not None:
        written[output / FILE_NAME] = registers
    write_files(written)
    for old in stale(output, list(written)):
        say(f"warning: {old} is left of an earlier translation", err=True)
    return [{"path": path.relative_to(output).as_posix(), "written": str(path)} for path in written]


def _printed(translation: Translation, target: str, proving: bool) -> Sequence[OutputFile]:
    """What is printed without a folder: the one program among the files. Those that only belong to it (lists of data,
    our own library) are named on stderr. Raises UsageError where there are several programs."""
    files = translation.files
    programs = [file for file in files if not _of_library(file)]
    data = {module.name.lower() for module in translation.program.modules if not module.routines}
    programs = [file for file in programs if PurePosixPath(file.path).stem.lower() not in data]
    if target in registry.dialect_names():
        for file in tuple(programs):
            lists = (
                {name.lower() for name in registry.dialect(target).companions(file.path)} if file in programs else ()
            )
            programs = [other for other in programs if other.path.lower() not in lists]
    if len(programs) > 1 and not proving:
        names = ", ".join(file.path for file in programs)
        raise UsageError(f"{len(programs)} programs would be written ({names}): name a folder with -o")
    shown = programs or files
    others = [file.path for file in files if file not in shown]
    if others:
        say(f"rpl: to what is printed belong {', '.join(others)}: -o DIR writes them too", err=True)
    return shown


def _of_library(file: OutputFile) -> bool:
    """Written for the program from our own library (the prefix of names that translations make)."""
    return PurePosixPath(file.path).name.lower().startswith("rpl_")


def _registers(translation: Translation) -> bytes | None:
    """The numbers that data has got, if any."""
    from rpl.writing.registers import registers_text

    if not translation.registers:
        return None
    return registers_text(translation.registers, translation.register_types).encode("utf-8")


def _text(file: OutputFile) -> str:
    from rpl.source import decode

    return decode(file.data)[0]


def _prove(
    read: ReadProgram,
    translation: Translation,
    target: str,
    arms: tuple[str | None, str | None],
    cell: str | None,
    accepted: Accepted,
    entry: str | None = None,
    explore: bool = False,
) -> ProofResult:
    """Read the written files back and compare the runs of both programs."""
    from rpl.project import read_sources
    from rpl.proof.explore import Budget
    from rpl.proof.prove import load_cell, prove_programs
    from rpl.proof.wiring import with_signal_names
    from rpl.simulation import entry_name
    from rpl.source import source_from_bytes

    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    again = Diagnostics()
    back = read_sources(sources, target, again)
    errors = again.of(Severity.ERROR)
    if errors:
        raise InternalError(f"what was written cannot be read back: {errors[0].as_text()}")
    with waiting("proving"):
        again_named = with_signal_names(back.program, translation.program)
        entry = entry_name(read.program, entry)
        # A script begins with itself, also where the first routine is called besides and stands in it as one of many.
        to_entry = back.program.entry or translation.renamed.get(entry, entry) if entry else None
        return prove_programs(
            read.program,
            again_named,
            arms[0],
            arms[1] or arms[0],
            load_cell(cell),
            entry=entry,
            to_entry=to_entry,
            accepted=accepted,
            budget=Budget() if explore else None,
        )


def _document(
    translation: Translation,
    written: Sequence[dict[str, object]],
    diagnostics: Diagnostics,
    proof: ProofResult | None,
) -> dict[str, object]:
    return {
        "files": list(written),
        "diagnostics": [item.as_json() for item in diagnostics],
        "losses": [item.as_json() for item in translation.losses],
        "renamed": dict(translation.renamed),
        "proof": proof.as_json() if proof is not None else None,
    }


def _print(
    translation: Translation,
    written: Sequence[dict[str, object]],
    output: Path | None,
    proof: ProofResult | None,
    warnings: int,
) -> None:
    """The verdict first, if there is one; then what was written and how much of it is not as it was."""
    if proof is not None:
        say(proof.as_text(), err=output is None)
    if output is None:
        for row in written:
            print_text(str(row["text"]))
    else:
        for row in written:
            say(f"wrote {row['written']}")
        for old, new in translation.renamed.items():
            say(f"renamed {old} to {new}")
        say(_summary(len(translation.losses), warnings))


# Warnings that concern a name or a file and no meaning.
_NO_APPROXIMATIONS = frozenset(("signal-number-chosen", "skipped-file"))


def _approximations(written: Sequence[Diagnostic]) -> tuple[tuple[str, int], ...]:
    """What was written in another way on purpose and nobody accepts: codes in alphabetical order, and how often."""
    warned = (item.code.name for item in written if item.severity == Severity.WARNING)
    return tuple(sorted(Counter(name for name in warned if name not in _NO_APPROXIMATIONS).items()))


def _summary(losses: int, warnings: int) -> str:
    """How much of a translation is not as it was in the source."""
    said = [f"{losses} losses, listed above: what could not be said stops the program there"] if losses else []
    said += [f"{warnings} approximations or remarks, listed above"] if warnings else []
    return "; ".join(said) if said else "every statement was written"
