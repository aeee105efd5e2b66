"""When two listings are the same program."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.controllers.fanuc.listing import same_program
from rpl.controllers.fanuc.memory import rewritten
from rpl.controllers.fanuc.reports import Task, tasks

SAMPLES = Path(__file__).resolve().parents[3] / "samples/tp"
LISTINGS = sorted(path for path in SAMPLES.rglob("*.ls"))
PICK = (SAMPLES / "palletiser/pick.ls").read_bytes()


@pytest.mark.parametrize("path", LISTINGS, ids=lambda path: path.stem)
def test_a_listing_that_the_controller_writes_anew_is_the_same(path: Path) -> None:
    data = path.read_bytes()
    assert same_program(path.name, data, rewritten(path.name, data))


# What a controller changes by itself, as ROBOGUIDE was seen to do it.
SAME = [
    (b"WAIT    .20(sec) ;", b"WAIT   0.20(sec)   ;"),
    (b"DO[1:vacuum]=ON ;", b"DO[1]=ON ;"),
    (b"LINE_COUNT\t= 7;", b"LINE_COUNT = 9;"),
    (b"24-03-04  TIME 08:00:00;\nMODIFIED", b"25-03-04  TIME 09:00:00;\nMODIFIED"),
    (b"X =   420.000  mm,\tY =   220.000  mm,", b"X=420.0 mm,\n\tY = 220.000 mm,"),
]
OTHER = [
    (b"WAIT    .20(sec) ;", b"WAIT    .21(sec) ;"),
    (b"DO[1:vacuum]=ON ;", b"DO[2:vacuum]=ON ;"),
    (b"!One box", b"!One  crate"),
    (b"X =   420.000  mm", b"X =   420.001  mm"),
    (b"CNT50", b"FINE"),
    (b"PROTECT\t\t= READ_WRITE", b"PROTECT\t\t= READ"),
    (b"/END", b"/EN\x0b"),
    (b"'N U T, 0, 0, 0'", b"'F U T, 0, 0, 0'"),
    (b"UF : 0", b"UF : 1"),
    (b"P[1]", b"P[2]"),
]


@pytest.mark.parametrize(("old", "new"), SAME)
def test_what_the_controller_decides_is_no_difference(old: bytes, new: bytes) -> None:
    assert old in PICK
    assert same_program("PICK.LS", PICK, PICK.replace(old, new))


@pytest.mark.parametrize(("old", "new"), OTHER)
def test_what_the_program_says_is(old: bytes, new: bytes) -> None:
    assert old in PICK
    assert not same_program("PICK.LS", PICK, PICK.replace(old, new))


def test_half_a_file_is_not_the_same() -> None:
    assert not same_program("PICK.LS", PICK, PICK[: len(PICK) // 2])


def test_tasks_hold_what_is_on_their_stack() -> None:
    text = (
        "TASK STATES:\n   1  MAIN RUNNING @ 477 in PICK of PICK\n****** History Data ******\n"
        "Routine depth: 2  Routine: PICK\nLine:   477       Program: PICK   Type: TP\n"
        "Routine depth: 1  Routine: MAIN\nLine:    3       Program: MAIN   Type: TP\n"
        "   2  ZDTMSGTYPES status = ABORTED\n\nPROGRAM STATES:\nMAIN  TP\nTask: yes\n"
    )
    assert tasks(text) == [
        Task("MAIN", "RUNNING", 477, "PICK", ("MAIN", "PICK")),
        Task("ZDTMSGTYPES", "ABORTED", None, "", ()),
    ]
    assert tasks("no report") is None
