"""The Python API has the command line's words and does the same."""

from __future__ import annotations

from pathlib import Path

import rpl
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_bytes

HERE = Path(__file__).parent
ROBOT = "kuka_kr6r900sixx"


def test_read_run_translate_prove() -> None:
    program = rpl.read(HERE / "moves.src")
    assert rpl.run(program, ROBOT).status == "finished"
    written = rpl.translate(program, "rapid", ROBOT)
    assert not written.losses
    sources = [source_from_bytes(file.path, file.data) for file in written.files]
    back = read_sources(sources, "rapid", Diagnostics())
    assert rpl.prove(program, back, ROBOT).agrees


def test_a_changed_millimetre_is_refuted() -> None:
    program = rpl.read(HERE / "moves.src")
    changed = (HERE / "moves.src").read_text("utf-8").replace("Y -50, Z 350", "Y -51, Z 350")
    other = read_sources(
        [
            source_from_bytes("moves.src", changed.encode()),
            source_from_bytes("moves.dat", (HERE / "moves.dat").read_bytes()),
        ],
        "krl",
        Diagnostics(),
    )
    result = rpl.prove(program, other, ROBOT)
    assert not result.agrees
    assert result.difference is not None
    assert (result.difference.a.place.line, result.difference.b.place.line) != (0, 0)
