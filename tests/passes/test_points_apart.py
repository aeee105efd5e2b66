"""Points of one name in several routines are data of a program whose routines share their names."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

LISTING = """/PROG  {name}
/MN
   1:  L P[1{said}] 200mm/sec FINE    ;
{rest}/POS
P[1{said}]{{
   GP1:
	UF : 0, UT : 1,		CONFIG : 'N U T, 0, 0, 0',
	X = {x} mm,	Y = 0 mm,	Z = 300 mm,
	W = 180 deg,	P = 0 deg,	R = 0 deg
}};
/END
"""


def head(target: str, *said: str) -> str:
    first = LISTING.format(name="PICK", said=said[0], x=400, rest="   2:  CALL PLACE    ;\n")
    second = LISTING.format(name="PLACE", said=said[1], x=500, rest="")
    sources = [source_from_text("pick.ls", first), source_from_text("place.ls", second)]
    files = translate_program(read_sources(sources, "tp", Diagnostics()), target, None, None, Diagnostics()).files
    return "".join(one.data.decode() for one in files if not one.path.endswith(".toml"))


@pytest.mark.parametrize(
    ("said", "names"),
    [(("", ""), ("pick_p1", "place_p1")), ((":on belt", ":on pallet"), ("on_belt", "on_pallet"))],
)
def test_points_by_their_comment_or_their_routine(said: tuple[str, str], names: tuple[str, str]) -> None:
    script, program = head("urscript", *said), head("vplus", *said)
    for name, x in zip(names, (400, 500), strict=True):
        assert f"global {name} = p[{x / 1000:g}, 0, 0.3, " in script and f"movel({name}, " in script
        assert f"\r\n{name} {x} 0 300 " in program and f"MOVES {name}\r\n" in program
