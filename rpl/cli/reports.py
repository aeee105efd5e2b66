"""Reports that `rpl run` writes beside its result."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.output import write_file

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.project import ReadProgram
    from rpl.simulation import RunResult

plot_option = click.option(
    "--plot",
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="F.html",
    help="Write a page about the run that opens without a network: path, joints, signals, margins, moves.",
)


def drawing_library_for(plot: Path | None) -> str:
    """What the page needs, looked for before the run: a missing package is said at once, not after an hour."""
    if plot is None:
        return ""
    from rpl.report.page import drawing_library

    return drawing_library()


def write_plot(
    plot: Path | None,
    library: str,
    result: RunResult,
    read: ReadProgram,
    model: RobotModel | None,
    controller: str = "",
) -> None:
    """Write the page, if one is asked for."""
    if plot is None:
        return
    from rpl import registry
    from rpl.report.document import Heading, run_document
    from rpl.report.page import page

    fault = result.fault
    place = f"{fault.origin.file}:{fault.origin.line}: " if fault is not None and fault.origin.source else ""
    heading = Heading(
        files=tuple(source.path for source in read.sources),
        language=", ".join(registry.dialect(name).title for name in read.dialects),
        robot=" ".join(word for word in (model.maker, model.title) if word) if model is not None else "",
        controller=controller,
        moves=result.moves,
        fault=f"{place}{fault.code}: {fault.message}" if fault is not None else "",
    )
    write_file(plot, page(run_document(result, model, heading), library).encode("utf-8"))
