"""Pulses of TP last 0.1 to 25.5 s in tenths (measured on a controller: reference/fanuc-measured.md, "V 17")."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.ir.walk import walk
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

LISTING = "/PROG  A\n/ATTR\n/MN\n   1:  DO[1]=PULSE,{length}sec ;\n/POS\n/END\n"
MODULE = "MODULE m\nPROC main()\nPulseDO\\PLength:={length},do1;\nENDPROC\nENDMODULE\n"


@pytest.mark.parametrize(("written", "kept"), [("25.5", 25.5), ("0.5", 0.5), ("0.25", 0.3), ("0.04", 0.4)])
def test_lengths_as_the_controller_keeps_them(written: str, kept: float) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("A.LS", LISTING.format(length=written))], "tp", diagnostics)
    assert not diagnostics.has_errors
    (pulse,) = (node for node in walk(*read.program.modules) if isinstance(node, ir.Pulse))
    assert isinstance(pulse.duration, ir.RealLiteral | ir.Quantity), pulse.duration
    value = pulse.duration.value if isinstance(pulse.duration, ir.RealLiteral) else pulse.duration.value.value
    assert value == kept


def test_a_longer_one_is_refused() -> None:
    diagnostics = Diagnostics()
    read_sources([source_from_text("A.LS", LISTING.format(length="25.6"))], "tp", diagnostics)
    assert diagnostics.has_errors


@pytest.mark.parametrize(("length", "text"), [("0.3", "PULSE,0.3sec"), ("25.5", "PULSE,25.5sec"), ("2", "PULSE,2sec")])
def test_lengths_that_can_be_written(length: str, text: str) -> None:
    written, diagnostics = translated(length)
    assert text in written
    assert not diagnostics.of(Severity.LOSS)
    assert not [one for one in diagnostics.of(Severity.WARNING) if one.code.name == "tp-pulse-rounded"]


def test_a_length_between_the_tenths_is_rounded_and_said() -> None:
    written, diagnostics = translated("0.25")
    assert "PULSE,0.3sec" in written
    assert [one for one in diagnostics.of(Severity.WARNING) if one.code.name == "tp-pulse-rounded"]


@pytest.mark.parametrize("length", ["25.6", "40", "0.01"])
def test_other_lengths_are_losses(length: str) -> None:
    written, diagnostics = translated(length)
    assert diagnostics.of(Severity.LOSS)
    assert f"PULSE,{length}" not in written


def translated(length: str) -> tuple[str, Diagnostics]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", MODULE.format(length=length))], "rapid", Diagnostics())
    files = translate_program(read, "tp", "abb_irb1200_5_90", None, diagnostics).files
    return "\n".join(file.data.decode("latin-1") for file in files), diagnostics
