"""A wait for a place on the way (`WAIT DISTANCE(HERE, DEST) < 50`): outputs behind it, up to a stop, are actions on the
path; whatever else the program does there, it polls for the place beside the move, where it can."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 MOVES a
 BREAK
 SPEED 50 MMPS
 MOVES b
 WAIT DISTANCE(HERE,DEST) < 50
 SIGNAL 1
 d = DISTANCE(HERE,b)
 BREAK
 IF (d > 40) AND (d < 50.01) THEN
 SIGNAL 2
 END
.END
.LOCATIONS
a 330 -50 260 0 180 0
b 330 50 260 0 180 0
.END
"""


@pytest.mark.parametrize("target", ["rapid", "inform", "vplus", "rpl"])
def test_the_place_is_seen_on_the_way(target: str) -> None:
    source = read_sources([source_from_text("main.v2", PROGRAM)], "vplus", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, "adept_viper_s650", None, found)
    assert not [item.as_text() for item in found.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, "adept_viper_s650", None, translation.renamed.get("main", "main"))
    assert result.status == "finished" and sum(bool(value) for _, _, value in result.outputs) >= 2


def switched(between: str) -> str:
    """The program with other steps between the move and the stop."""
    return PROGRAM.replace("main()\n", "main()\n d = 45\n").replace(
        PROGRAM[PROGRAM.index(" WAIT") : PROGRAM.index(" BREAK\n IF")], between
    )


NEAR, NEARER = " WAIT DISTANCE(HERE,DEST) <= 50\n SIGNAL 1\n", " WAIT DISTANCE(HERE,DEST) <= 20\n SIGNAL -1\n"
ACTIONS = {
    "krl": ["TRIGGER WHEN PATH=-50 DELAY=0 DO $OUT[1]=TRUE", "TRIGGER WHEN PATH=-20 DELAY=0 DO $OUT[1]=FALSE", "LIN b"],
    "rapid": ["TriggL b,v50,rpl_trigger\\T2:=rpl_trigger2,fine,tool0;"],
    "tp": ["DB 50.0mm,DO[1]=ON DB 20.0mm,DO[1]=OFF"],
    "inform": ["DOUT OT#(1) ON", "DOUT OT#(1) OFF"],
    "urscript": ["set_standard_digital_out(0, True)", "set_standard_digital_out(0, False)"],
}


@pytest.mark.parametrize("target", ACTIONS)
def test_outputs_up_to_a_stop_are_actions_on_the_path(target: str) -> None:
    source = read_sources([source_from_text("main.v2", switched(NEAR + NEARER))], "vplus", Diagnostics())
    found = Diagnostics()
    done = translate_program(source, target, "adept_viper_s650", None, found)
    text = "".join(file.data.decode("latin-1") for file in done.files)
    places = [text.find(one) for one in ACTIONS[target]]
    assert -1 not in places and places == sorted(places), text
    assert not found.of(Severity.LOSS) and "polled-wait" not in {one.code.name for one in found}
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    named, arm = with_signal_names(back.program, done.program), "adept_viper_s650"
    begins = done.renamed.get("main", "main")
    assert prove_programs(source.program, named, arm, arm, None, entry="main", to_entry=begins).agrees


@pytest.mark.parametrize(
    "between",
    [
        NEARER + NEAR,  # the program is behind the first place when it looks for the second one
        NEAR + " n = n+1\n",
        " n = 50\n WAIT DISTANCE(HERE,DEST) <= n\n SIGNAL 1\n",
        NEAR + " MOVES a\n",
    ],
)
def test_other_steps_stay_steps(between: str) -> None:
    source = read_sources([source_from_text("main.v2", switched(between))], "vplus", Diagnostics())
    found = Diagnostics()
    translate_program(source, "krl", "adept_viper_s650", None, found)
    assert "concurrent-move" in {one.code.name for one in found.of(Severity.LOSS)}
