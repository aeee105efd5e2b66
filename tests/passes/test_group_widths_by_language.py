"""Groups of signals whose width only their own controller knows: as wide as their language has them where the program
works with their numbers, eight bits where it only names small ones; where groups have a size, in parts of that size.
"""

from __future__ import annotations

import pytest

from rpl import registry
from rpl.cell import Cell, Input
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

_ROBOT = "fanuc_lrmate200id"
_LISTING = """/PROG  GROUPS
/ATTR
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  WAIT GI[1]=5 ;
   2:  R[1]=GI[3]-500 ;
   3:  WAIT GI[2]>400 ;
   4:  IF GI[2]<>455,JMP LBL[1] ;
   5:  IF (GI[2]=455),DO[101]=(ON) ;
   6:  DO[102]=(R[1]=(-45)) ;
   7:  R[2]=R[1]+1045 ;
   8:  GO[2]=R[2] ;
   9:  DO[103]=(GO[2]=1000) ;
  10:  GO[1]=7 ;
  11:  LBL[1] ;
/POS
/END
"""
_TARGETS = ["krl", "rapid", "tp", "urscript", "vplus", "inform"]


def _written(target: str) -> tuple[str, list[str], list[str]]:
    """The text, the codes of what is reported, and the outputs that a run of it switches on."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("GROUPS.LS", _LISTING)], "tp", diagnostics)
    written = translate_program(read, target, _ROBOT, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    program = with_signal_names(back.program, written.program)
    cell = Cell(inputs=(Input(1.0, "GI[1]", 5), Input(0.0, "GI[3]", 455), Input(2.0, "GI[2]", 455)))
    entry = program.entry or written.renamed.get("GROUPS", "GROUPS")
    result = run_program(program, _ROBOT, in_words_of(cell, read.program, program), entry, 20.0)
    assert result.fault is None
    on = [name for _, name, value in result.outputs if value is True]
    text = "\n".join(file.data.decode() for file in written.files)
    return text, [item.code.name for item in diagnostics], on


@pytest.mark.parametrize("target", _TARGETS)
def test_numbers_beyond_eight_bits_come_through(target: str) -> None:
    _, codes, on = _written(target)
    spell = registry.dialect(target).signal_name
    named = [{f"do{number}", spell("digital_out", number)} for number in (101, 102, 103)]
    assert all(names & set(on) for names in named)
    assert not {"group-too-narrow", f"{target}-guarded-stop"} & set(codes)


def test_a_group_of_codes_keeps_eight_bits() -> None:
    text, _, _ = _written("krl")
    assert "SIGNAL gi1 $IN[33] TO $IN[40]" in text or "SIGNAL gi1 $IN[1] TO $IN[8]" in text
    assert "SIGNAL go1 $OUT[17] TO $OUT[24]" in text or "SIGNAL go1 $OUT[1] TO $OUT[8]" in text


def test_sixteen_signals_are_two_bytes() -> None:
    text, _, _ = _written("inform")
    assert "DIN B099 IG#(" in text
    assert "IN#(" not in text.replace("DIN B099", "")
