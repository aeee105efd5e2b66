"""`rpl translate`: write programs in another controller's language, and prove on request that they mean the same."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

import click

from rpl import registry
from rpl.cli.files import BEFORE, force_option, kept_before, refuse_others, stale, write_files
from rpl.cli.output import (
    STANDARD_INPUT,
    arm_of,
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
    verbose_option,
    waiting,
)
from rpl.cli.proofs import answer, certificate_option, keep
from rpl.cli.sheets import sheet_can_be_written, sheet_option, write_sheet
from rpl.cli.verdicts import accepting, exploring, status_of, teaching
from rpl.diagnostics import Diagnostic, Diagnostics, Severity
from rpl.errors import InternalError, UsageError

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.project import ReadProgram
    from rpl.proof.certificate import Question
    from rpl.proof.teaching.pairs import Given
    from rpl.proof.tolerance import Accepted
    from rpl.proof.verdict import ProofResult
    from rpl.report.readiness import Readiness
    from rpl.translation import Translation
    from rpl.writing.namemap import NameMap
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
    "--target-backup",
    "backup",
    type=click.Path(exists=True, path_type=Path),
    metavar="PATH",
    help="Backup of the robot that will run the result (file, folder, archive): its names and numbers are respected.",
)
@click.option(
    "--map",
    "chosen",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Keep the names and numbers in this file (map.toml of an earlier run, edited or not) and add the new ones.",
)
@click.option(
    "--keep-taught",
    "keeping",
    is_flag=True,
    help="Keep what was taught anew in the files of DIR since they were written; values stand in the map.",
)
@click.option(
    "--option", "options", multiple=True, metavar="NAME=VALUE", help="An option of the target language; repeatable."
)
@click.option(
    "--templates",
    type=click.Path(file_okay=False, path_type=Path),
    metavar="DIR",
    help="Own macros for how statements look, in DIR/<target>/*.j2 (`rpl templates` lists them).",
)
@sheet_option
@click.option("--strict", is_flag=True, help="Take every approximation for an error.")
@exploring
@teaching
@accepting
@certificate_option
@force_option
@verbose_option
@json_option
def command(
    paths: Sequence[str],
    target: str,
    dialect: str | None,
    output: Path | None,
    proving: bool,
    chosen: Path | None,
    keeping: bool,
    options: Sequence[str],
    templates: Path | None,
    sheet: Path | None,
    strict: bool,
    accepted: Accepted,
    kept: Path | None,
    as_json: bool,
    **about: Any,
) -> int:
    """Write programs in another controller's language.

    What the target cannot say becomes a comment and the target's own stop, is listed, and gives exit status 3. Without
    -o the program is printed. The first line says whether the result is ready, workable or not, and how many moves and
    statements need you. With --prove, --explore, --teach or --certificate it has the verdict: equal, alike (exit
    status 3), different or undecided (1); --accept takes measures of the proof too.
    """
    from rpl.cell import read_cell
    from rpl.proof.cellnames import report_unknown_names
    from rpl.report.readiness import readiness

    own = _options(options)
    target = _target(target, own)
    _can_be_done((about["robot"], about["to_robot"]), paths, output, sheet, kept, keeping)
    house, earlier = _house(templates, target), _earlier(chosen, output if keeping else None)
    around = read_cell(about["cell"]) if about["cell"] is not None else None
    diagnostics = collector(sorted(accepted.kinds))
    read = read_paths(paths, dialect, diagnostics)
    if diagnostics.has_errors:
        return _refuse(read, diagnostics, as_json)
    arms = _arms(about, read)
    read, before = _begun_at(read, about["entry"]), len(diagnostics)
    with waiting("writing"):
        report_unknown_names([read.program], around, diagnostics)
        translation = _translated(read, target, arms, diagnostics, earlier, about.pop("backup"), own, around, house)
        translation = _with_floor(translation, target, output if keeping else None, earlier, diagnostics)
    if strict:
        _raise_approximations(diagnostics, before)
    if diagnostics.has_errors:
        return _refuse(read, diagnostics, as_json)
    proving = proving or _asks(about) or kept is not None
    written = _put(translation, target, output, (chosen, kept), proving, as_json, keeping)
    about |= {"a": paths[0], "b": str(output), "language_a": dialect, "language_b": target}
    asked = _question(accepted, diagnostics.items[before:], about)
    proof = _prove(read, translation, asked, output, kept) if proving else None
    ready = readiness(read, diagnostics, proof.verdict if proof is not None else "")
    if as_json:
        print_diagnostics(diagnostics)
        print_json(_document(translation, written, diagnostics, proof, ready))
    else:
        _print(translation, written, output, proof, ready, diagnostics)
    write_sheet(sheet, read, translation, diagnostics, ready, proof, target, arms)
    return _status(proof, diagnostics)


def _status(proof: ProofResult | None, diagnostics: Diagnostics) -> int:
    """The exit status: that of the proof, and where it is content that of the stops."""
    proved = status_of(proof) if proof is not None else OK
    return proved if proved != OK or not diagnostics.has_losses else GUARDED


def _arms(about: dict[str, Any], read: ReadProgram) -> tuple[str | None, str | None]:
    """The arms of the source, if need be as its backup names it, and of the result."""
    about["robot"] = about["robot"] or arm_of(read)
    return about["robot"], about["to_robot"]


def _can_be_done(
    arms: tuple[str | None, str | None],
    paths: Sequence[str],
    output: Path | None,
    sheet: Path | None,
    certificate: Path | None,
    keeping: bool,
) -> None:
    """Raises UsageError for what would fail at the end of long work."""
    robots_exist(*arms)
    _certifiable(certificate, paths, output)
    sheet_can_be_written(sheet)
    _keepable(keeping, output, certificate)


def _asks(about: Mapping[str, Any]) -> bool:
    """Is something asked that only a proof answers?"""
    return bool(about["explore"]) or about["teach"] is not None


def _house(templates: Path | None, target: str) -> Mapping[str, str] | None:
    """A plant's own templates for the target."""
    from rpl.writing.house import house_files

    return None if templates is None else house_files(templates, target, registry.target_names())


def _earlier(chosen: Path | None, kept: Path | None) -> NameMap:
    """The names and numbers that are kept; none where there is no such file yet. kept: a folder whose map counts where
    no other is chosen."""
    from rpl.writing.namemap import FILE_NAME, NameMap, read_map

    home = chosen if chosen is not None else kept / FILE_NAME if kept is not None else None
    return read_map(home) if home is not None and home.exists() else NameMap()


def _keepable(keeping: bool, output: Path | None, certificate: Path | None) -> None:
    """Raises UsageError where nothing can be kept, or where a proof would be about other values than the files have."""
    if keeping and output is None:
        raise UsageError("--keep-taught keeps what was taught in the files of a folder: name it with -o")
    if keeping and certificate is not None:
        raise UsageError(
            "--certificate is about the source's points, and --keep-taught writes others: prove --teach "
            "says whether they mean the same"
        )


def _with_floor(
    translation: Translation, target: str, output: Path | None, earlier: NameMap, diagnostics: Diagnostics
) -> Translation:
    """The translation with what was taught anew in the folder, and a map that tells the values; without a folder as it
    is."""
    from rpl.proof.teaching.floor import with_floor

    if output is None:
        return translation
    floor = with_floor(translation.files, target, output, earlier.taught, diagnostics)
    return replace(translation, files=floor.files, map=replace(translation.map, taught=floor.values))


def _translated(
    read: ReadProgram,
    target: str,
    arms: tuple[str | None, str | None],
    diagnostics: Diagnostics,
    earlier: NameMap,
    backup: Path | None,
    own: Mapping[str, str],
    around: Cell | None,
    house: Mapping[str, str] | None,
) -> Translation:
    from rpl.ir.standing import NOTHING
    from rpl.standing import read_standing
    from rpl.translation import translate_program

    return translate_program(
        read,
        target,
        *arms,
        diagnostics,
        earlier,
        own,
        given=around.variables if around is not None else None,
        mechanisms=around.mechanisms if around is not None else (),
        analog=around.analog if around is not None else (),
        templates=house,
        there=read_standing(backup, target) if backup is not None else NOTHING,
    )


def _certifiable(kept: Path | None, paths: Sequence[str], output: Path | None) -> None:
    """Raises UsageError when a certificate is asked for and nobody could do the proof again."""
    if kept is None:
        return
    if output is None:
        raise UsageError("--certificate names the files of the result: give a folder with -o")
    if len(paths) != 1 or STANDARD_INPUT in paths:
        raise UsageError("--certificate takes one PATH: a file, a folder or an archive that can be read again")
    refuse_others([kept])


def _alone(kept: Path | None, output: Path | None, files: Sequence[OutputFile], target: str) -> None:
    """Raises UsageError when the folder of a result with a certificate holds what would be read as part of it."""
    from rpl.project import read_program

    if kept is None or output is None or not output.exists():
        return
    own = {output / PurePosixPath(file.path) for file in files}
    others = [one.path for one in read_program([output], target, Diagnostics()).sources if Path(one.path) not in own]
    if others:
        raise UsageError(
            f"a certificate needs a folder of its own, and {', '.join(others)} would be read with the result"
        )


def _question(accepted: Accepted, written: Sequence[Diagnostic], about: dict[str, Any]) -> Question:
    """What the proof of a translation is asked. `written`: what was said while it was made; `about`: programs, arms
    and surroundings."""
    from rpl.proof.certificate import Question
    from rpl.proof.deviations import KINDS

    return Question(
        accept=tuple(sorted(accepted.kinds & KINDS.keys())),
        path_mm=accepted.path_mm,
        corner_mm=accepted.corner_mm,
        time_share=accepted.time_share,
        approximations=_approximations(written),
        **about,
    )


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
    return replace(read, reduced=replace(read.reduced, entry=found.name))


def _options(written: Sequence[str]) -> dict[str, str]:
    """`name=value` each."""
    found: dict[str, str] = {}
    for one in written:
        name, sign, value = one.partition("=")
        if not sign or not name.strip():
            raise UsageError(f"--option takes NAME=VALUE, not {one!r}")
        found[name.strip()] = value.strip()
    return found


def _refuse(read: ReadProgram, diagnostics: Diagnostics, as_json: bool) -> int:
    """Nothing is written from a program with errors."""
    from rpl.report.readiness import readiness

    ready = readiness(read, diagnostics, written=False)
    say(f"rpl: {ready.as_text()}", err=True)
    print_diagnostics(diagnostics)
    if as_json:
        items = [item.as_json() for item in diagnostics]
        empty = {"files": [], "diagnostics": items, "losses": [], "proof": None}
        print_json(empty | {"readiness": ready.as_json()})
    return NO


def _raise_approximations(diagnostics: Diagnostics, first: int) -> None:
    for index in range(first, len(diagnostics.items)):
        if diagnostics.items[index].severity == Severity.WARNING:
            diagnostics.items[index] = replace(diagnostics.items[index], severity=Severity.ERROR)


def _put(
    translation: Translation,
    target: str,
    output: Path | None,
    named: tuple[Path | None, Path | None],
    proving: bool,
    as_json: bool,
    keeping: bool,
) -> list[dict[str, object]]:
    """Write the result into its folder; without one give the text of what is printed."""
    alone = output is None and not as_json
    shown = _printed(translation, target, proving) if alone else translation.files
    _alone(named[1], output, translation.files, target)
    shown = shown if output is None else (*shown, *translation.setup)
    return _write(shown, output, translation.map, named, keeping)


def _write(
    files: Sequence[OutputFile],
    output: Path | None,
    given: NameMap,
    named: tuple[Path | None, Path | None],
    keeping: bool,
) -> list[dict[str, object]]:
    """Write the files, with the map of names and numbers beside them or in the place that is `named` for it; give their
    text when no folder is named. The second of `named` is the certificate, which is written later. keeping: what was
    taught anew in the files that are there is in the new ones already, so these take their place."""
    from rpl.writing.namemap import FILE_NAME, map_text

    chosen, kept = named
    home = chosen if chosen is not None else output / FILE_NAME if output is not None else None

    for file in files:
        inside = PurePosixPath(file.path)
        if inside.is_absolute() or ".." in inside.parts:
            raise UsageError(f"the name {file.path!r} leads out of the output folder: nothing is written under it")
    told = given.names or given.numbers or given.taught
    beside = {home: map_text(given).encode("utf-8")} if home is not None and told else {}
    if output is None:
        write_files(beside, ours=(chosen,))
        return [{"path": file.path, "text": _text(file)} for file in files]
    written = {output / PurePosixPath(file.path): file.data for file in files}
    written |= beside
    changed = kept_before(list(written)) if keeping else ()
    write_files(written, ours=(chosen, *changed))
    for path in changed:
        say(f"rpl: {path} as it was is in {path.parent / BEFORE}", err=True)
    own = [path for path in written if path.is_relative_to(output)]
    for old in stale(output, [*own, *([kept] if kept is not None else [])]):
        say(f"warning: {old} is left of an earlier translation", err=True)
    return [{"path": _inside(path, output), "written": str(path)} for path in written]


def _inside(path: Path, output: Path) -> str:
    """The path from the folder that is written, or as it is for a file elsewhere."""
    return path.relative_to(output).as_posix() if path.is_relative_to(output) else str(path)


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


def _text(file: OutputFile) -> str:
    from rpl.source import decode

    return decode(file.data)[0]


def _prove(
    read: ReadProgram, translation: Translation, asked: Question, output: Path | None, kept: Path | None
) -> ProofResult:
    """Read the written files back and compare the runs of both programs. With a certificate (`kept`) they are read from
    the folder, as `rpl prove --check` does it."""
    from rpl.project import read_program, read_sources
    from rpl.proof.wiring import kept_names, names_lacking
    from rpl.simulation import entry_name
    from rpl.source import source_from_bytes

    again, target = Diagnostics(), str(asked.language_b)
    if kept is None or output is None:
        sources = [source_from_bytes(file.path, file.data) for file in translation.files]
        back = read_sources(sources, target, again)
    else:
        back = read_program([output], target, again)
    errors = again.of(Severity.ERROR)
    if errors:
        raise InternalError(f"what was written cannot be read back: {errors[0].as_text()}")
    entry = entry_name(read.program, asked.entry)
    # A script begins with itself, also where the first routine is called besides and stands in it as one of many.
    to_entry = back.program.entry or translation.renamed.get(entry, entry) if entry else None
    signals = names_lacking(back.program, translation.program)
    names = kept_names(translation.renamed, translation.registers, back.program) if asked.explore else {}
    question = replace(
        asked,
        entry=entry,
        to_entry=to_entry,
        signals=signals,
        names=tuple(sorted(names.items())),
        taught=_given(translation, back) if asked.teach is not None else (),
    )
    result = answer(question, (read, back))
    if kept is not None:
        keep(kept, question, (read, back), result)
    return result


def _given(translation: Translation, back: ReadProgram) -> tuple[Given, ...]:
    """Which taught data of the result the translation made of which of the source."""
    from rpl.proof.teaching.data import taught_data
    from rpl.proof.teaching.pairs import given_by

    numbers = ((bank, number, name) for (bank, number), name in translation.registers.items())
    return given_by(translation.renamed.items(), numbers, taught_data(back.program, set_numbers=True))


def _document(
    translation: Translation,
    written: Sequence[dict[str, object]],
    diagnostics: Diagnostics,
    proof: ProofResult | None,
    ready: Readiness,
) -> dict[str, object]:
    return {
        "files": list(written),
        "diagnostics": [item.as_json() for item in diagnostics],
        "losses": [item.as_json() for item in translation.losses],
        "renamed": dict(translation.renamed),
        "proof": proof.as_json() if proof is not None else None,
        "readiness": ready.as_json(),
    }


def _print(
    translation: Translation,
    written: Sequence[dict[str, object]],
    output: Path | None,
    proof: ProofResult | None,
    ready: Readiness,
    diagnostics: Diagnostics,
) -> None:
    """What needs somebody comes first, then the places, the worst first, the proof and what was written."""
    say(ready.as_text(), err=output is None)
    print_diagnostics(diagnostics)
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


# Warnings that concern a name or a file and no meaning.
_NO_APPROXIMATIONS = frozenset(("signal-number-chosen", "skipped-file", "cell-unknown-variable"))


def _approximations(written: Sequence[Diagnostic]) -> tuple[tuple[str, int], ...]:
    """What was written in another way on purpose and nobody accepts: codes in alphabetical order, and how often."""
    warned = (item.code.name for item in written if item.severity == Severity.WARNING)
    return tuple(sorted(Counter(name for name in warned if name not in _NO_APPROXIMATIONS).items()))
