"""Tool and frame in force at the moves of a program, where the ways to them differ."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.framesinforce import FramesInForce
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

HEAD = "VAR p: POSE = {x: 1, y: 0, z: 0, a: 0, b: 0, c: 0}\nVAR on: BOOL = FALSE\nVAR i: INT = 1\n"
MOVE = "MOVE LINEAR TO p"


def base(x: float) -> str:
    return f"$base = {{x: {x}, y: 0, z: 0, a: 0, b: 0, c: 0}}"


def bases(lines: str, more: str = "") -> list[float | None]:
    """x of the frame at each move, in the order of the text; None where the run decides."""
    text = f"{HEAD}PROCEDURE main()\n{lines}\nEND PROCEDURE\n{more}"
    diagnostics = Diagnostics()
    program = read_sources([source_from_text("main.rpl", text)], "rpl", diagnostics).program
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    flow = FramesInForce(program)
    found = []
    for node in walk(*program.modules):
        if isinstance(node, ir.Move):
            frames = flow.frames.get(id(node))
            found.append(frames.base.position.x if frames is not None and frames.base is not None else None)
    return found


def test_a_label_is_reached_with_what_its_jumps_bring() -> None:
    lines = f"{base(5)}\nLABEL again\n{MOVE}\nIF on THEN\nGOTO again\nEND IF"
    assert bases(lines) == [5.0]
    assert bases(lines.replace("GOTO", f"{base(6)}\nGOTO")) == [None]


def test_a_loop_left_in_the_middle() -> None:
    assert bases(f"{base(5)}\nWHILE TRUE\nIF on THEN\n{base(6)}\nEXIT\nEND IF\nEND WHILE\n{MOVE}") == [None]


def test_a_counter_of_a_loop_is_not_what_it_was_before() -> None:
    frame = "$base = {x: i, y: 0, z: 0, a: 0, b: 0, c: 0}"
    assert bases(f"i = 3\n{frame}\n{MOVE}\nFOR i = 1 TO 2\n{frame}\n{MOVE}\nEND FOR") == [3.0, None]


@pytest.mark.parametrize("end", ["RETRY", "TRY NEXT"])
def test_a_handler_that_goes_on_in_the_routine(end: str) -> None:
    lines = f"{base(5)}\n{MOVE}\n{MOVE}\nON ERROR\n{base(6)}\n{end}"
    assert bases(lines) == [None if end == "RETRY" else 5.0, None]


@pytest.mark.parametrize("change", ["raised(i)", 'ASK "How many?" INTO i KIND number', "i = 7"])
def test_a_variable_that_a_called_routine_changes(change: str) -> None:
    frame = "$base = {x: i, y: 0, z: 0, a: 0, b: 0, c: 0}"
    more = f"PROCEDURE other()\n{change}\nEND PROCEDURE\nPROCEDURE raised(REFERENCE n: INT)\nn = n + 4\nEND PROCEDURE\n"
    found = bases(f"i = 3\n{frame}\n{MOVE}\nother()\n{frame}\n{MOVE}", more)
    assert found == [3.0, 7.0 if change == "i = 7" else None]


def test_a_choice_of_frames_by_what_a_called_wait_tells() -> None:
    more = "PROCEDURE other()\nWAIT UNTIL di[1] TIMEOUT 1 s FLAG on\nEND PROCEDURE\n"
    assert bases(f"on = FALSE\n{base(5)}\nother()\nIF on THEN\n{base(6)}\nEND IF\n{MOVE}", more) == [None]


@pytest.mark.parametrize("arming", ["DECLARE INTERRUPT 3 WHEN on DO other()", "TRAP ERRORS WITH other"])
def test_a_reaction_that_sets_the_frame(arming: str) -> None:
    more = f"PROCEDURE other()\n{base(6)}\nEND PROCEDURE\n"
    assert bases(f"{arming}\n{base(5)}\n{MOVE}", more) == [None]


INTERRUPTED = """VAR p: POSE = {x: 500, y: 50, z: 400, a: 0, b: 180, c: 0}
VAR t1: POSE = {x: 0, y: 0, z: 25, a: 0, b: 0, c: 0}
VAR t2: POSE = {x: 0, y: 0, z: 35, a: 0, b: 0, c: 0}
PROCEDURE main()
    DECLARE INTERRUPT 3 WHEN digital_in[1] DO away()
    INTERRUPT ON 3
    MOVE LINEAR TO p SPEED 200 mm/s TOOL t1
    MOVE LINEAR TO offset(p, 20, 0, 0) SPEED 200 mm/s TOOL t1
END PROCEDURE
PROCEDURE away()
    STOP MOTION
    MOVE LINEAR TO p SPEED 100 mm/s TOOL t2
    START MOTION
END PROCEDURE
"""


def test_a_modal_target_sets_again_what_an_interrupt_may_have_set() -> None:
    read = read_sources([source_from_text("main.rpl", INTERRUPTED)], "rpl", Diagnostics())
    written = translate_program(read, "krl", "kuka_kr6r900sixx", None, Diagnostics())
    main = next(one for one in written.files if one.path.endswith("main.src")).data.decode()
    assert main.count("$TOOL=TOOL_DATA[1]") == 2
