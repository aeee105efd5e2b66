"""Shared by the tests of programs of other languages in TP: written, read back, both run, both do the same."""

from __future__ import annotations

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOTS = {"krl": "kuka_kr6r900sixx", "urscript": "ur5e", "vplus": "adept_viper_s650", "inform": "motoman_gp8"}


def same_in_tp(language: str, text: str, cell: str = "") -> tuple[dict[str, str], list[str]]:
    """The listings by file name and the codes reported, after checking that they do the same."""
    robot = ROBOTS.get(language, "fanuc_lrmate200id")
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(f"p.{language}", text)], language, diagnostics)
    written = translate_program(read, "tp", robot, None, diagnostics)
    losses = [one for one in written.losses if one.code.name != "tp-text-case"]  # the texts here differ in more
    refused = [one.as_text() for one in diagnostics if one.severity >= Severity.ERROR or one in losses]
    assert not refused, refused
    files = [source_from_bytes(file.path, file.data) for file in written.files]
    back = with_signal_names(read_sources(files, "tp", Diagnostics()).program, written.program)
    entry = entry_name(read.program)
    to_entry = written.renamed.get(entry or "", entry)
    around = parse_cell(cell) if cell else None
    proof = prove_programs(read.program, back, robot, cell=around, entry=entry, to_entry=to_entry)
    assert proof.agrees, proof.as_text()
    shown = {file.path: file.data.decode("ascii") for file in written.files if file.path.endswith(".LS")}
    return shown, [item.code.name for item in diagnostics]
