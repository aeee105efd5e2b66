"""Taught points of programs that keep them themselves stand where the target's people look for them."""

from __future__ import annotations

import pytest
from there_and_back import entry_of

from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.kept_frames import tool_one

POSITION = """P[{number}]{{
   GP1:
\tUF : 0, UT : 1,\tCONFIG : 'N U T, 0, 0, 0',
\tX =   {x}.000  mm,\tY =     0.000  mm,\tZ =   300.000  mm,
\tW =  -180.000 deg,\tP =     0.000 deg,\tR =     0.000 deg
}};
"""
PROGRAM = """/PROG  {name}
/ATTR
/MN
   1:  UFRAME_NUM=0 ;
   2:  UTOOL_NUM=1 ;
   3:J P[1] 50% FINE ;
   4:  PR[1]=P[2] ;
   5:  PR[1,3]=PR[1,3]+20 ;
   6:L PR[1] 200mm/sec FINE ;
{more}/POS
"""


def source(name: str, more: str = "") -> str:
    points = "".join(POSITION.format(number=n, x=x) for n, x in ((1, 400), (2, 450)))
    return PROGRAM.format(name=name, more=more) + points + "/END\n"


PLACES = {
    "krl": ("DECL E6POS P1={", "DECL E6POS P2={"),
    "rapid": ("  LOCAL CONST robtarget P1:=", "  LOCAL CONST robtarget P2:="),
    "vplus": (".LOCATIONS", "\r\np1 ", "\r\np2 "),
}
ARM = "fanuc_lrmate200id"


@pytest.mark.parametrize("target", PLACES)
def test_they_are_data_of_the_module(target: str) -> None:
    own = read_sources([source_from_text("pick.ls", source("PICK")), tool_one()], "tp", Diagnostics())
    translation = translate_program(own, target, ARM, None, Diagnostics())
    files = translation.files
    written = "\n".join(file.data.decode("latin-1") for file in files)
    assert all(one in written for one in PLACES[target]), written
    back = read_sources([source_from_bytes(f.path, f.data) for f in files], target, Diagnostics())
    result = run_program(back.program, load_robot(ARM), entry=entry_of(translation, "PICK"))
    assert result.status == "finished", result.fault


def test_names_that_two_programs_have_stay_apart_where_all_share_their_names() -> None:
    sources = [
        source_from_text("pick.ls", source("PICK", "   7:  CALL PLACE ;\n")),
        source_from_text("place.ls", source("PLACE")),
    ]
    own = read_sources(sources, "tp", Diagnostics())
    (file,) = translate_program(own, "vplus", ARM, None, Diagnostics()).files
    text = file.data.decode("ascii")
    assert "\r\npick_p1 " in text and "\r\nplace_p1 " in text
