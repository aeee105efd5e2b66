"""The override as a factor of speeds, where a controller's programs cannot set it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.refusing import refused

ARM = "kuka_kr6r900sixx"
HEAD = "DEF T()\nINT N\nBAS(#INITMOV,0)\n$VEL.CP=0.2\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\n"
WAY = "LIN_REL {Z -60}\nLIN_REL {Z 60}\n"
# The program, and the moves' durations in relation to those at full speed.
CASES = {
    "known": f"{WAY}$OV_PRO=50\n{WAY}$OV_PRO=100\n{WAY}",
    "in a loop": f"FOR N=1 TO 3\n$OV_PRO=50\n{WAY}$OV_PRO=100\n{WAY}ENDFOR\n",
    "in a called routine": f"{WAY}SLOW()\n{WAY}$OV_PRO=100\n{WAY}",
    "never set": f"IF $OV_PRO==100 THEN\n$OUT[1]=TRUE\nENDIF\n{WAY}",
}
TAIL = "END\nDEF SLOW()\n$OV_PRO=40\n" + WAY + "END\n"


def durations(program: object) -> tuple[list[float], list[object]]:
    result = run_program(program, ARM, None, "T", controller="plain")  # type: ignore[arg-type]
    assert result.status == "finished", result.fault
    moves = [event.data["duration"] for event in result.trace if event.kind == "move"]
    return [float(str(one)) for one in moves], [value for _, _, value in result.outputs]


@pytest.mark.parametrize("name", CASES)
def test_moves_take_as_long(name: str) -> None:
    text = HEAD + CASES[name] + (TAIL if "SLOW" in CASES[name] else "END\n")
    read = read_sources([source_from_text("t.src", text)], "krl", Diagnostics())
    diagnostics = Diagnostics()
    translation = translate_program(read, "inform", ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    told = {item.code.name for item in diagnostics}
    assert ("override-in-speeds" in told) == (name != "never set")
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "inform", Diagnostics())
    (ours, out), (theirs, out_there) = durations(read.program), durations(back.program)
    assert theirs[1:] == pytest.approx(ours[1:], abs=0.06)  # accelerations differ
    assert out == out_there


def test_known_values_need_no_variable() -> None:
    read = read_sources([source_from_text("t.src", HEAD + CASES["known"] + "END\n")], "krl", Diagnostics())
    files = translate_program(read, "inform", ARM, None, Diagnostics()).files
    text = b"".join(f.data for f in files).decode()
    assert "V=100.0" in text and "V=200.0" in text and "V=D" not in text


# The program, and the lines that are refused
REFUSED = {
    "a setting that is worked out": (f"N=50\n$OV_PRO=N*2\n{WAY}", [("override-hangs-on-run", 7)]),
    "a move behind two settings": (
        "IF $IN[1] THEN\n$OV_PRO=50\nENDIF\nLIN_REL {Z -60}\n$OV_PRO=100\nLIN_REL {Z 60}\n",
        [("override-hangs-on-run", 9)],
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_the_run_decides_is_refused(name: str) -> None:
    text, wanted = REFUSED[name]
    assert refused(HEAD + text + "END\n", "krl", "inform", ARM, "t.src") == wanted
