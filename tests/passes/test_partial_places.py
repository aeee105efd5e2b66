"""Targets that leave components out: what they keep of the move before is written where it is known.

A KRL program runs on one arm; its translation runs on the same arm and must go the same way.
"""

from __future__ import annotations

import pytest

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.places.partialplaces import partial_places
from rpl.passes.typing import normalise
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr6r900sixx"
DATA = """DEFDAT a
DECL POS XP={X 500.0,Y 0.0,Z 320.0,A 180.0,B 0.0,C 180.0,S 2,T 2}
DECL POS XQ={X 500.0,Y 0.0,Z 320.0,A 180.0,B 0.0,C 180.0,S 2,T 2}
ENDDAT
"""
HEAD = "DEF a()\nDECL REAL H\nDECL INT I\nBAS(#INITMOV,0)\n$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.2\n"
REST = """END
DEF away()
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
END
DEF waits()
WAIT SEC 0.1
END
"""
SUBMIT = "DEF sps()\nWAIT FOR $IN[9]\nEND\n"


def filled(lines: str) -> list[bool]:
    """Of each move whose target is written by components: is it a whole place behind the pass, as numbers or as a copy
    of the place before in which these components are set?"""
    sources = [source_from_text("a.src", f"{HEAD}{lines}\n{REST}"), source_from_text("a.dat", DATA)]
    program = normalise(read_sources(sources, "krl", Diagnostics()).program, Diagnostics())
    context = Context("krl", "rapid", registry.target("rapid").capabilities(), Diagnostics())
    before = [node.target for node in walk(program) if isinstance(node, ir.Move)]
    after = [node.target for node in walk(partial_places(program, context)) if isinstance(node, ir.Move)]
    parts = [isinstance(one, ir.Aggregate) and one.type_name != "joints" for one in before]
    whole = [
        isinstance(one, ir.Name) or {"x", "y", "z", "a", "b", "c"} <= {name for name, _ in one.entries}
        for one, asked in zip(after, parts, strict=True)
        if asked and isinstance(one, ir.Name | ir.Aggregate)
    ]
    assert len(whole) == sum(parts)
    return whole


CASES = {
    "behind data": ("PTP XP\nLIN {Y 50.0}\nLIN {X 480.0}", [True, True]),
    "other statements": ("PTP XP\nWAIT SEC 0.1\nwaits()\n$VEL.CP=0.1\nIF $IN[1] THEN\nENDIF\nLIN {Y 50.0}", [True]),
    "the place is assigned": ("PTP XQ\nXQ.X=490.0\nLIN {Y 50.0}", [False]),
    "a routine that drives": ("PTP XP\naway()\nLIN {Y 50.0}", [False]),
    "another frame": ("PTP XP\n$BASE.X=10.0\nLIN {Y 50.0}", [False]),
    "one branch drives": ("PTP XP\nIF $IN[1] THEN\nLIN {Z 300.0}\nENDIF\nLIN {Y 50.0}", [True, False]),
    "around a loop": ("PTP XP\nFOR I=1 TO 2\nLIN {Y 50.0}\nLIN XP\nENDFOR\nLIN {Y 40.0}", [False, False]),
    "a computed component": (
        "H=300.0\nPTP XP\nLIN {Z H}\nLIN {X 500.0,Y 9.0,Z 310.0}\nLIN {Z H}\nLIN {Y 5.0}",
        [True, True, True, True],  # the copy of the taught place keeps what H was
    ),
    "steps": (
        "PTP XP\nLIN_REL {X 10.0}\nLIN {Y 50.0}\nLIN_REL {X 10.0} #TOOL\nLIN {Y 40.0}",
        [False, True, False, False],
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_left_out_is_written_where_it_is_known(name: str) -> None:
    lines, expected = CASES[name]
    assert filled(lines) == expected


MOVES = """PTP XP
LIN {Y 60.0,Z 300.0}
LIN XP
CIRC {X 530.0,Y 30.0},{X 500.0,Y 60.0}
PTP XP
CIRC {X 530.0,Y 30.0},{X 500.0,Y 60.0},CA 270.0
$OUT[1]=TRUE
H=30.0
XQ.Y=10.0
PTP XQ
CIRC {X 530.0,Y 10.0+H},{X 500.0,Y 40.0+H},CA 80.0
WAIT SEC 0
$OUT[2]=TRUE
"""


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform"])
def test_places_of_some_components_are_driven_to_in_every_language(target: str) -> None:
    """Also with a submit program beside: the motion program starts where nothing calls it."""
    files = {"a.src": HEAD + MOVES + REST, "a.dat": DATA, "sps.sub": SUBMIT}
    read = read_sources([source_from_text(*item) for item in files.items()], "krl", Diagnostics())
    told = Diagnostics()
    written = translate_program(read, target, ARM, None, told)
    again = Diagnostics()
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, again)
    named = with_signal_names(back.program, written.program)
    result = prove_programs(read.program, named, ARM, ARM, None, entry="a", to_entry=written.renamed.get("a", "a"))
    assert not again.has_errors
    assert result.agrees, result.as_text()
    assert "arc-angle-lost" not in {item.code.name for item in told}
