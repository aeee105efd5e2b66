"""Data that no file declares, into languages whose data has numbers: data of the kind that its use shows, and one stop
at the beginning that says what is missing."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "kuka_kr10r1100sixx"


def translated(target: str, *lines: str) -> tuple[str, dict[str, str]]:
    text = "DEF MAIN( )\n" + "\n".join(lines) + "\nEND\n"
    read = read_sources([source_from_text("MAIN.src", text)], "krl", Diagnostics())
    found = Diagnostics()
    done = translate_program(read, target, ARM, None, found)
    main = next(file for file in done.files if file.path.upper().startswith("MAIN."))
    told = {item.code.name: item.as_text() for item in found if item.severity is Severity.LOSS}
    return source_from_bytes(main.path, main.data).text, told


def test_a_tp_program_stops_once_and_names_what_is_missing() -> None:
    text, told = translated("tp", "WAIT FOR part_there", "LIN above_box", "grip=TRUE", "count=count+1")
    assert "WAIT (F[1:part_there])" in text
    assert "L PR[1:above_box]" in text
    assert "F[2:grip]=(ON)" in text
    assert "=R[1:count]+1" in text
    assert text.count("  PAUSE ;") == 1
    assert "!not declared, to be set first: ;" in text
    assert "part_there, above_box, grip, count" in told["undeclared-data"]
    assert set(told) == {"undeclared-data"}


def test_an_inform_job_stops_once() -> None:
    text, told = translated("inform", "WAIT FOR part_there", "LIN above_box", "grip=TRUE")
    assert text.count("\nPAUSE") == 1
    assert "MOVL P" in text
    assert set(told) == {"undeclared-data"}


def test_components_of_places_and_of_records() -> None:
    text, told = translated(
        "tp", "IF place.X<=-300 THEN", "LIN place", "ENDIF", "IF box.length==300 THEN", "$OUT[1]=TRUE", "ENDIF"
    )
    assert "L PR[1:place]" in text
    assert "R[1:box_length]=300" in text
    assert "place, box.length" in told["undeclared-data"]


# What stays refused where it stands: uses that do not agree, arrays, what goes to an unknown routine.
REFUSED = [
    ("LIN one", "one=TRUE"),
    ("one[3]=TRUE", "one[4]=FALSE"),
    ("unknown(one)", "one=TRUE"),
    ("one.a_part=3", "other=one"),
]


@pytest.mark.parametrize("lines", REFUSED, ids=range(len(REFUSED)))
def test_what_cannot_be_taken_is_refused_at_its_place(lines: tuple[str, str]) -> None:
    text, told = translated("tp", *lines)
    assert "undeclared-data" not in told
    assert told
    assert text.count("  PAUSE ;") >= 1


def test_a_counter_that_its_loop_declares_is_no_such_datum() -> None:
    text = "MODULE m\nPROC main()\nFOR i FROM 1 TO 3 DO\nIF i>2 THEN\nSetDO do1,1;\nENDIF\nENDFOR\nENDPROC\nENDMODULE\n"
    read = read_sources([source_from_text("m.mod", text)], "rapid", Diagnostics())
    found = Diagnostics()
    translate_program(read, "tp", None, None, found)
    assert "undeclared-data" not in {item.code.name for item in found}


def test_targets_with_names_write_the_name() -> None:
    _, told = translated("vplus", "LIN above_box", "grip=TRUE")
    assert "undeclared-data" not in told
