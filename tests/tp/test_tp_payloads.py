"""PAYLOAD[n]: its load is in the controller's variables ($PLST_GRP1), which a backup brings along.

M: centres in cm, inertias in kg cm2, as the pendant's screens of the same values have centimetres.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.report.sampling import driven_moves
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.translation import translate_program

LISTING = """/PROG  MAIN
/MN
   1:  PAYLOAD[2] ;
   2:  J P[1] 50% FINE ;
   3:  PAYLOAD[1:grip] ;
   4:  J P[2] 50% FINE ;
   5:  PAYLOAD[7] ;
   6:  J P[1] 50% FINE ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,
	J1= 0.000 deg,	J2= 0.000 deg,	J3= 0.000 deg,
	J4= 0.000 deg,	J5= -90.000 deg,	J6= 0.000 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,
	J1= 10.000 deg,	J2= 0.000 deg,	J3= 0.000 deg,
	J4= 0.000 deg,	J5= -90.000 deg,	J6= 0.000 deg
};
/END
"""
DUMP = """[*SYSTEM*]$PLST_GRP1  Storage: CMOS  Access: RO  : ARRAY[10] OF PLST_GRP_T
     Field: $PLST_GRP1[1].$COMMENT Access: RO: STRING[17] = 'grip'
     Field: $PLST_GRP1[1].$PAYLOAD Access: RO: REAL = 5.000000e+00
     Field: $PLST_GRP1[1].$PAYLOAD_X Access: RO: REAL = 0.000000e+00
     Field: $PLST_GRP1[1].$PAYLOAD_Y Access: RO: REAL = 2.000000e-01
     Field: $PLST_GRP1[1].$PAYLOAD_Z Access: RO: REAL = 1.500000e+01
     Field: $PLST_GRP1[1].$PAYLOAD_IX Access: RO: REAL = 4.000000e+02
     Field: $PLST_GRP1[1].$PAYLOAD_IY Access: RO: REAL = 3.000000e+02
     Field: $PLST_GRP1[1].$PAYLOAD_IZ Access: RO: REAL = 2.000000e+02
     Field: $PLST_GRP1[2].$PAYLOAD Access: RO: REAL = 7.500000e+00
     Field: $PLST_GRP1[2].$PAYLOAD_X Access: RO: REAL = -1.000000e+00
     Field: $PLST_GRP1[7].$PAYLOAD Access: RO: REAL = -9.999000e+03
[*SYSTEM*]$PLST_GRP2  Storage: CMOS  Access: RO  : ARRAY[1] OF PLST_GRP_T
     Field: $PLST_GRP2[1].$PAYLOAD Access: RO: REAL = 9.000000e+00
"""


def read(*texts: tuple[str, str]):  # type: ignore[no-untyped-def]
    diagnostics = Diagnostics()
    found = read_sources([source_from_text(name, text) for name, text in texts], "tp", diagnostics)
    assert not diagnostics.has_errors
    return found


def test_loads_of_a_backup_reach_the_moves() -> None:
    program = read(("MAIN.LS", LISTING), ("SYSMOTN.VA", DUMP)).program
    result = run_program(program, "fanuc_lrmate200id")
    assert result.status == "finished", result.fault
    first, second, third = (move.payloads for move in driven_moves(result))
    assert [one.mass for one in first] == [7.5]
    assert first[0].frame.position.x == pytest.approx(-10.0)
    assert [one.mass for one in second] == [5.0]
    assert second[0].inertias == pytest.approx((0.04, 0.03, 0.02))
    place = second[0].frame.position
    assert (place.x, place.y, place.z) == pytest.approx((0.0, 2.0, 150.0))
    assert third == second  # a schedule that nobody has filled in says nothing


def test_without_a_backup_the_controller_alone_knows_it() -> None:
    result = run_program(read(("MAIN.LS", LISTING)).program, "fanuc_lrmate200id")
    assert [move.payloads for move in driven_moves(result)] == [(), (), ()]


@pytest.mark.parametrize(
    ("target", "line"),
    [
        ("tp", "PAYLOAD[1:grip] ;"),
        ("rpl", "$load = load {mass: 5.0,"),
    ],
)
def test_a_known_load_is_written_where_it_can_be_said(target: str, line: str) -> None:
    diagnostics = Diagnostics()
    done = translate_program(
        read(("MAIN.LS", LISTING), ("SYSMOTN.VA", DUMP)), target, "fanuc_lrmate200id", None, diagnostics
    )
    text = "\n".join(file.data.decode("latin-1") for file in done.files)
    assert line in text
    assert not any(item.code.name == "tp-guarded-stop" for item in diagnostics)


def test_a_load_that_a_target_cannot_say_is_reported() -> None:
    diagnostics = Diagnostics()
    translate_program(read(("MAIN.LS", LISTING), ("SYSMOTN.VA", DUMP)), "krl", "fanuc_lrmate200id", None, diagnostics)
    assert {"tuning-left-out", "dropped-setting"} <= {item.code.name for item in diagnostics}
