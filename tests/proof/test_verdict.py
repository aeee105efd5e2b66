"""The verdict of two programs: which measures deviate although the events are the same, and when nothing is decided."""

import json
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.project import read_sources
from rpl.proof.prove import ProofResult, prove_programs
from rpl.proof.tolerance import Accepted, accepted_kinds
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
KRL = """DEF part()
BAS(#INITMOV,0)
$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}
$TOOL={X 0,Y 0,Z 50,A 0,B 0,C 0}
$VEL.CP=0.5
$VEL.ORI1=20
$ACC.CP=2
$LOAD.M=2
$APO.CDIS=20
BAS(#VEL_PTP,100)
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
$OUT[1]=TRUE
LIN {X 550,Y 0,Z 600,A 0,B 135,C 0} C_DIS
LIN {X 550,Y 200,Z 600,A 40,B 135,C 0}
PULSE($OUT[3],TRUE,0.3)
WAIT SEC 1
LIN {X 550,Y 0,Z 600,A 0,B 135,C 0} C_DIS
PTP {X 550,Y -150,Z 500,A 0,B 135,C 0} C_PTP
TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[2]=TRUE
LIN {X 550,Y -150,Z 350,A 0,B 135,C 0} C_DIS
LIN {X 600,Y -150,Z 350,A 0,B 135,C 0}
END
"""
CHANGES = {
    "path speed +20 %": ("$VEL.CP=0.5", "$VEL.CP=0.6", "path-speed"),
    "path speed tenfold": ("$VEL.CP=0.5", "$VEL.CP=1.99", "path-speed"),
    "path acceleration +20 %": ("$ACC.CP=2", "$ACC.CP=2.4", "acceleration"),
    "orientation speed tenfold": ("$VEL.ORI1=20", "$VEL.ORI1=200", "turning-speed"),
    "joint speed 100 to 10": ("#VEL_PTP,100", "#VEL_PTP,10", "joint-speed"),
    "pulse 0.3 to 0.9 s": ("TRUE,0.3", "TRUE,0.9", "pulse"),
    "corner of a path before a joint move": ("$APO.CDIS=20", "$APO.CDIS=60", "corner"),
    "corner by speed": ("Z 600,A 0,B 135,C 0} C_DIS\nPTP", "Z 600,A 0,B 135,C 0} C_VEL\nPTP", "corner"),
    "load 2 to 5 kg": ("$LOAD.M=2", "$LOAD.M=5", "load"),
    "a wait of a millisecond more": ("SEC 1\n", "SEC 1.001\n", "wait"),
    "an output at the other end of a move": ("DISTANCE=0", "DISTANCE=1", "place"),
    "the last 50 mm with the joints": ("LIN {X 600", "PTP {X 600", "path"),
}
# What a target leaves to its controller: both have to say a measure to be compared.
SILENT = {("rapid", "acceleration")}


def program_of(text: str, language: str = "krl") -> object:
    diagnostics = Diagnostics()
    name = {"krl": "part.src", "rapid": "part.mod", "urscript": "part.script"}[language]
    read = read_sources([source_from_text(name, text)], language, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return read


def written(text: str, target: str) -> object:
    translation = translate_program(program_of(text), target, ROBOT, None, Diagnostics())  # type: ignore[arg-type]
    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    return read_sources(sources, target, Diagnostics()).program


def kinds(result: ProofResult) -> set[str]:
    found = {one.kind for one in result.deviations}
    return found | ({result.difference.kind} if result.difference is not None else set())


def proved(a: str, b: object, accepted: Accepted = Accepted()) -> ProofResult:  # noqa: B008  a frozen value
    return prove_programs(program_of(a).program, b, ROBOT, accepted=accepted)  # type: ignore[attr-defined,arg-type]


def test_a_program_is_equal_to_itself() -> None:
    result = proved(KRL, program_of(KRL).program)  # type: ignore[attr-defined]
    assert (result.verdict, result.deviations) == ("equal", ())
    assert result.headline().startswith("equal: everything that was compared lies within 0.01 mm")


@pytest.mark.parametrize("change", CHANGES)
def test_what_changes_is_told_within_one_controller(change: str) -> None:
    old, new, kind = CHANGES[change]
    assert old in KRL
    result = proved(KRL, program_of(KRL.replace(old, new)).program)  # type: ignore[attr-defined]
    assert result.verdict in ("alike", "different"), result.as_text()
    assert kind in kinds(result) | ({"corner"} if result.difference is not None else set()), result.as_text()


@pytest.mark.parametrize("target", ["rapid", "urscript"])
@pytest.mark.parametrize("change", CHANGES)
def test_what_changes_is_told_across_controllers(change: str, target: str) -> None:
    """Against the translation of the program as it was: what was compared before now deviates more, or anew."""
    old, new, kind = CHANGES[change]
    text = KRL if target == "rapid" else "\n".join(line for line in KRL.splitlines() if "TRIGGER" not in line)
    if old not in text or (target, kind) in SILENT:
        pytest.skip("the target cannot say it, and its translation is refused there or names it")
    other = written(text, target)
    before, behind = proved(text, other), proved(text.replace(old, new), other)
    assert before.agrees, before.as_text()
    assert behind.verdict in ("alike", "different"), behind.as_text()
    if behind.difference is None:
        told = [
            {(one.kind, one.a.place.line, round(one.amount, 6)) for one in result.deviations}
            for result in (before, behind)
        ]
        assert told[0] != told[1], f"nothing else is told: {before.as_text()}\n{behind.as_text()}"


def test_an_accepted_measure_is_equal_and_named() -> None:
    faster = program_of(KRL.replace("#VEL_PTP,100", "#VEL_PTP,50")).program  # type: ignore[attr-defined]
    result = proved(KRL, faster, Accepted(accepted_kinds(("joint-speed", "time"))))
    assert result.verdict == "equal", result.as_text()
    assert "accepted: joint speeds differ by up to 50 %" in result.headline()
    assert proved(KRL, faster, Accepted(accepted_kinds(("time",)))).verdict == "alike"


def test_a_limit_accepts_what_stays_below_it() -> None:
    moved = program_of(KRL.replace("X 600,Y -150", "X 600.4,Y -150")).program  # type: ignore[attr-defined]
    assert proved(KRL, moved).verdict == "different"
    half = proved(KRL, moved, Accepted(path_mm=0.5))
    assert half.verdict == "equal" and "tool paths up to 0.4 mm apart" in half.headline(), half.as_text()
    assert half.max_path_mm == pytest.approx(0.4, abs=0.01)
    assert proved(KRL, moved, Accepted(path_mm=0.3)).verdict == "different"


def test_words_that_are_no_measure_are_refused() -> None:
    with pytest.raises(UsageError, match="no measure of a proof"):
        accepted_kinds(("speed",))


@pytest.mark.parametrize(
    ("text", "robot", "reason"),
    [
        (KRL.replace("{A1 0,", "{A1 999,"), ROBOT, "fault"),
        (KRL.replace("WAIT SEC 1", "WAIT FOR $IN[1]"), ROBOT, "never comes"),
        ("DEF part()\nLOOP\nWAIT SEC 10\nENDLOOP\nEND\n", ROBOT, "limit"),
        (KRL, None, "--robot"),
        ("DEF part()\nIF $IN[1] THEN\nPTP {A1 10}\nENDIF\nEND\n", ROBOT, "nothing moved"),
        ("DEF part()\nDECL INT i\ni=1\nEND\n", ROBOT, "nothing that can be seen"),
    ],
)
def test_runs_that_show_too_little_decide_nothing(text: str, robot: str | None, reason: str) -> None:
    program = program_of(text).program  # type: ignore[attr-defined]
    result = prove_programs(program, program, robot)
    assert result.verdict == "undecided", result.as_text()
    assert reason in result.reason and not result.equal
    assert result.headline().startswith("undecided: ")


def test_a_program_without_moves_needs_no_robot() -> None:
    program = program_of("DEF part()\n$OUT[1]=TRUE\nEND\n").program  # type: ignore[attr-defined]
    assert prove_programs(program, program).verdict == "equal"


@pytest.mark.parametrize(
    ("old", "new", "options", "status"),
    [
        ("", "", [], 0),
        ("#VEL_PTP,100", "#VEL_PTP,50", [], 3),
        ("#VEL_PTP,100", "#VEL_PTP,50", ["--accept", "joint-speed", "--accept", "time"], 0),
        ("X 600,", "X 601,", [], 1),
        ("{A1 0,", "{A1 999,", [], 1),
        ("", "", ["--corner-mm", "-1"], 2),
    ],
)
def test_only_equal_programs_exit_with_nought(
    old: str, new: str, options: list[str], status: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, text in (("a", KRL), ("b", KRL.replace(old, new) if old else KRL)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "part.src").write_text(text)
    assert run(["prove", str(tmp_path / "a"), str(tmp_path / "b"), "--robot", ROBOT, "--json", *options]) == status
    if status != 2:
        shown = json.loads(capsys.readouterr().out)
        assert shown["equal"] == (shown["verdict"] == "equal") == (status == 0)
        assert bool(shown["deviations"]) == ("VEL_PTP" in old)
