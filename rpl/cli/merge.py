"""`rpl merge`: three versions of a program brought together, also as the merge driver of Git."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.files import force_option, write_files
from rpl.cli.output import (
    dialect_exists,
    from_option,
    json_option,
    print_diagnostics,
    print_json,
    print_text,
    say,
    verbose_option,
    waiting,
)
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.comparing.merging import MergedFile


@click.command("merge")
@click.argument("base")
@click.argument("a", metavar="OURS")
@click.argument("b", metavar="THEIRS")
@click.option("-o", "--output", "out", metavar="OUT", help="File or folder to write; OURS may be written over.")
@click.option(
    "--path", "name", metavar="P", help="What the file is called in the project, when its own name does not say."
)
@from_option
@force_option
@verbose_option
@json_option
def command(base: str, a: str, b: str, out: str | None, name: str | None, dialect: str | None, as_json: bool) -> int:
    """Bring two changed versions of a program together.

    OURS and THEIRS come from BASE: files, folders or archives. What one side changed is taken; where both changed the
    same point or statement otherwise, the file gets marks as Git writes them. Exit status 1 when something is left to
    decide.
    """
    from rpl.comparing.merging import merged
    from rpl.comparing.versions import files_of, is_archive

    language = dialect_exists(dialect)
    with waiting("merging"):
        versions = [files_of(path) for path in (base, a, b)]
        whole = any(Path(path).is_dir() or is_archive(path) for path in (base, a, b))
        if not whole:
            versions = [_alone(version, name or Path(a).name) for version in versions]
        found = merged(versions[0], versions[1], versions[2], language)
    if whole and out is None:
        raise UsageError("folders and archives need -o OUT, a folder")
    if out is not None:
        _write(found.files, Path(out), whole, Path(a))
    print_diagnostics(found.errors)
    if as_json:
        print_json(found.as_json())
        return 0 if found.clean else 1
    for one in found.files:
        for conflict in one.conflicts:
            say(f"{one.path}:{conflict.line}: conflict: {conflict.words}", err=True)
    if out is None:
        for one in found.files:
            if one.data is not None:
                print_text(one.data.decode("utf-8", "surrogateescape"))
    return 0 if found.clean else 1


def _alone(version: dict[str, bytes], name: str) -> dict[str, bytes]:
    """The one file of a version under the name that all three have."""
    return dict.fromkeys([name], next(iter(version.values()))) if version else {}


def _write(files: Sequence[MergedFile], out: Path, whole: bool, ours: Path) -> None:
    """Write what was merged. OURS may be written over; what is no longer there is removed from it."""
    places = {out / one.path if whole else out: one.data for one in files}
    over = ours.exists() and out.exists() and out.samefile(ours)
    if over and not whole:
        for path, data in places.items():
            path.write_bytes(data or b"")
        return
    kept = {path: data for path, data in places.items() if data is not None}
    write_files(kept, ours=[path for path in kept if over])
    for path in places.keys() - kept.keys():
        if over:
            path.unlink(missing_ok=True)
