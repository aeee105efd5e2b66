"""`rpl translate --report`: the page about a translation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.files import refuse_others
from rpl.cli.output import followed_options, robot_named, waiting, write_file
from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.project import ReadProgram
    from rpl.proof.verdict import ProofResult
    from rpl.report.readiness import Readiness
    from rpl.translation import Translation

_HTML, _MARKDOWN = (".html", ".htm"), (".md",)

sheet_option = click.option(
    "--report",
    "sheet",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.html|F.md",
    help="Write a page: source and result side by side, notes, what to do at the cell.",
)


def sheet_can_be_written(path: Path | None) -> None:
    """Raises UsageError, before anything is read, for a page of another kind or one that is somebody else's."""
    if path is None:
        return
    if path.suffix.lower() not in (*_HTML, *_MARKDOWN):
        raise UsageError(f"--report writes .html or .md, not {path.name}")
    refuse_others([path])


def write_sheet(
    path: Path | None,
    read: ReadProgram,
    translation: Translation,
    diagnostics: Diagnostics,
    ready: Readiness,
    proof: ProofResult | None,
    target: str,
    robots: tuple[str | None, str | None],
) -> None:
    """Write the page, if one is asked for."""
    if path is None:
        return
    from rpl import registry
    from rpl.report.sheet import Facts, page

    first, second = robots
    facts = Facts(
        read,
        translation,
        tuple(diagnostics),
        ready,
        (", ".join(registry.dialect(name).title for name in read.dialects), registry.target(target).title),
        (_title(first), _title(second or first)),
        proof.as_text().splitlines() if proof is not None else (),
        _measured(proof),
        followed_options(),
    )
    with waiting("writing the page"):
        text = page(facts, path.suffix.lower() in _MARKDOWN)
    write_file(path, text.encode("utf-8"))


def _title(robot: str | None) -> str:
    model = robot_named(robot)
    return " ".join(word for word in (model.maker, model.title) if word) if model is not None else ""


def _measured(proof: ProofResult | None) -> dict[tuple[str, int], list[str]] | None:
    """Deviations by the place in the source, the worst of each kind there."""
    if proof is None:
        return None
    from rpl.proof.deviations import KINDS

    worst: dict[tuple[str, int], dict[str, float]] = {}
    for one in proof.deviations:
        kinds = worst.setdefault((one.a.place.file, one.a.place.line), {})
        kinds[one.kind] = max(one.amount, kinds.get(one.kind, 0.0))
    return {
        place: [f"{kind} {amount:.4g} {KINDS[kind][1]}".rstrip() for kind, amount in kinds.items()]
        for place, kinds in worst.items()
    }
