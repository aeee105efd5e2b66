"""`--teach`: taught data of two programs is moved alike and proved again; what does not mean the same is named."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from there_and_back import Journey, there_and_back

from rpl.cell import read_cell
from rpl.cli.main import run
from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.teaching.data import Datum, Taught, taught_data, with_taught
from rpl.proof.teaching.moving import Amount
from rpl.proof.teaching.outcome import Retaught
from rpl.proof.teaching.pairs import Given, given_by, paired
from rpl.proof.teaching.retaught import Teaching
from rpl.proof.verdict import ProofResult
from rpl.source import source_from_text

RAPID = """MODULE M
  TASK PERS tooldata tGrip:=[TRUE,[[0,0,150],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wobjJig:=[FALSE,TRUE,"",[[500,100,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pPick:=[[0,0,100],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pPlace:=[[50,-80,120],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ jHome,v500,fine,tGrip;
    MoveL Offs(pPick,0,0,100),v500,fine,tGrip\\WObj:=wobjJig;
    MoveL pPick,v100,fine,tGrip\\WObj:=wobjJig;
    SetDO doGrip,1;
    MoveL pPlace,v100,fine,tGrip\\WObj:=wobjJig;
  ENDPROC
ENDMODULE
"""
KRL = {
    "main.src": """DEF main()
  BAS(#INITMOV,0)
  $TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}
  $BASE=$NULLFRAME
  $VEL.CP=0.5
  PTP XHome
  LIN XPick:{X 0,Y 0,Z -100,A 0,B 0,C 0}
  LIN XPick
  LIN XPlace
END
""",
    "main.dat": """DEFDAT main
DECL E6AXIS XHome={A1 0,A2 -90,A3 90,A4 10,A5 60,A6 0,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}
DECL E6POS XPick={X 500,Y 100,Z 250,A 0,B 180,C 0,S 2,T 3}
DECL E6POS XPlace={X 450,Y 0,Z 300,A 0,B 180,C 10,S 2,T 3}
ENDDAT
""",
}
URSCRIPT = """def main():
  set_tcp(p[0,0,0.1,0,0,0])
  global table = p[0.4,-0.3,0.1,0,0,0]
  global frames = [p[0.4,0.2,0.1,0,0,0], p[0.3,0.3,0.1,0,0,0]]
  global home = [0,-1.4,1.5,-1.6,-1.5,0.1]
  global infeed = pose_trans(table, p[0.02,0,0.05,2.2,2.2,0.1])
  def side():
    local p1 = p[0.03,0.01,0.2,2.2,2.2,0.1]
    movel(pose_trans(frames[1], p1), a=1, v=0.2)
  end
  def other():
    local p1 = p[0.05,0.02,0.22,2.2,2.2,0.1]
    movel(pose_trans(frames[0], p1), a=1, v=0.2)
  end
  movej(home, a=1, v=1)
  movel(infeed, a=1, v=0.2)
  side()
  other()
end
"""
ARMS = {"rapid": "abb_irb1600_6_12", "krl": "kuka_kr6r900_2", "urscript": "ur10e"}
SOURCES: dict[str, Mapping[str, str]] = {"rapid": {"m.mod": RAPID}, "krl": KRL, "urscript": {"main.script": URSCRIPT}}


def read(files: Mapping[str, str], language: str) -> ReadProgram:
    found = Diagnostics()
    program = read_sources([source_from_text(name, text) for name, text in files.items()], language, found)
    assert not found.has_errors, [item.as_text() for item in found]
    return program


def given(journey: Journey) -> tuple[Given, ...]:
    """What the translation says about its names and numbers."""
    numbers = ((bank, number, name) for (bank, number), name in journey.written.registers.items())
    return given_by(journey.written.renamed.items(), numbers, taught_data(journey.program, set_numbers=True))


def taught(journey: Journey, amount: Amount | None = None) -> ProofResult:
    """The proof of a translation with re-teaching."""
    entry = journey.program.entry or journey.written.renamed.get("main", "main")
    asked = Teaching(1, amount or Amount(), given(journey))
    source = journey.source.program
    return prove_programs(source, journey.program, journey.robot, entry="main", to_entry=entry, teaching=asked)


def states(result: ProofResult) -> dict[str, str]:
    assert isinstance(result.taught, Retaught), result.as_text()
    return {one.datum.name: one.state for one in result.taught.outcomes}


@pytest.mark.parametrize("target", ["urscript", "vplus", "tp", "krl"])
def test_a_translation_of_named_data_holds(target: str) -> None:
    result = taught(there_and_back(SOURCES["rapid"], "rapid", target, ARMS["rapid"]))
    found = states(result)
    assert set(found) == {"tGrip", "wobjJig", "jHome", "pPick", "pPlace"}
    assert set(found.values()) == {"holds"}, result.as_text()
    assert result.agrees and result.taught is not None and result.taught.holds


@pytest.mark.parametrize("target", ["urscript", "vplus", "tp", "rapid"])
def test_points_of_a_data_list_hold(target: str) -> None:
    found = states(taught(there_and_back(KRL, "krl", target, ARMS["krl"])))
    assert {name: found[name] for name in ("XHome", "XPick", "XPlace")} == dict.fromkeys(
        ("XHome", "XPick", "XPlace"), "holds"
    )


@pytest.mark.parametrize("target", ["krl", "urscript"])
def test_a_number_that_the_controller_keeps_is_moved(target: str) -> None:
    kept = "  PERS num nAbove:=92.5;\n  PERS num nParts:=4;\n  PROC main"
    text = RAPID.replace("  PROC main", kept).replace("Offs(pPick,0,0,100)", "Offs(pPick,0,0,nAbove)")
    found = states(taught(there_and_back({"m.mod": text}, "rapid", target, ARMS["rapid"])))
    assert found["nAbove"] == "holds" and "nParts" not in found


def test_features_lists_and_local_waypoints_are_data_of_their_own() -> None:
    program = read(SOURCES["urscript"], "urscript").program
    found = {one.name: one.kind for one in taught_data(program)}
    frames = {"main.tool": "tool", "table": "frame", "frames[0]": "frame", "frames[1]": "frame"}
    assert found == frames | dict.fromkeys(("home", "infeed", "side.p1", "other.p1"), "point")
    result = prove_programs(program, program, ARMS["urscript"], teaching=Teaching())
    assert result.equal and set(states(result).values()) == {"holds"}, result.as_text()


def test_a_point_that_two_programs_keep_is_named() -> None:
    """FANUC programs have points of their own: both copies have to be taught."""
    again = "  PROC again()\n    MoveL pPick,v100,fine,tGrip\\WObj:=wobjJig;\n  ENDPROC\n"
    text = RAPID.replace("  ENDPROC\nENDMODULE", f"    again;\n  ENDPROC\n{again}ENDMODULE")
    result = taught(there_and_back({"m.mod": text}, "rapid", "tp", ARMS["rapid"]))
    found = states(result)
    assert found.pop("pPick") == "copied" and set(found.values()) == {"holds"}
    assert result.taught is not None and "pPick: 2 copies, MAIN.P" in result.as_text()
    assert result.verdict == "alike" and not result.taught.holds


def test_points_of_one_name_and_value_belong_to_the_program_that_is_called_alike() -> None:
    """Two jobs of the source have a point `chuck` each; so have the modules of the output."""
    (datum,) = [one for one in taught_data(read({"m.mod": RAPID}, "rapid").program) if one.name == "pPick"]

    def kept(name: str, label: str, routine: str, file: str) -> Datum:
        place = replace(datum.place, file=file)
        return replace(datum, name=name, variable=name, label=label, routine=routine, place=place)

    here = [kept("P2", "chuck", "EMPTY", "empty.ls"), kept("P3", "chuck", "FILL", "fill.ls")]
    there = [kept("chuck", "", "", "FILLModule.mod"), kept("chuck", "", "", "EMPTYModule.mod")]
    found = paired(here, there)
    assert [[copy.datum for copy in found[one]] for one in here] == [[there[1]], [there[0]]]
    joined = [kept("FILL_chuck", "", "", "CELL.mod"), kept("EMPTY_chuck", "", "", "CELL.mod")]
    found = paired(here, joined)
    assert [[copy.datum for copy in found[one]] for one in here] == [[joined[1]], [joined[0]]]
    again = [kept("C7", "", "FILL", "fill.jbi")]  # says nothing but its value
    assert [len(copies) for copies in paired(here, [*there, *again]).values()] == [1, 2]


def test_a_value_of_the_cell_that_the_output_says_itself_does_not_hide_what_is_taught(tmp_path: Path) -> None:
    """Both programs are run in one cell; a tool that the source leaves to its controller is data of the output, under
    the same name."""
    program = KRL["main.src"].replace("$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}", "$TOOL=Grip")
    left, said = ("DECL FRAME Grip", "DECL CONST FRAME Grip={X 0,Y 0,Z 150,A 0,B 0,C 0}")
    ours, theirs = (
        read({"main.src": program, "main.dat": KRL["main.dat"].replace("ENDDAT", f"{line}\nENDDAT")}, "krl").program
        for line in (left, said)
    )
    cell = tmp_path / "cell.toml"
    cell.write_text("[variables]\nGrip = { x = 0.0, y = 0.0, z = 150.0, a = 0.0, b = 0.0, c = 0.0 }\n", "utf-8")
    result = prove_programs(ours, theirs, ARMS["krl"], cell=read_cell(str(cell)), teaching=Teaching())
    assert states(result)["Grip"] == "holds", result.as_text()


def test_a_frame_that_begins_at_nothing_and_that_the_program_fills_is_not_taught() -> None:
    filled = '  PERS wobjdata wobjRun:=[FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n  PROC main()\n'
    text = RAPID.replace(
        "  PROC main()\n", filled + "    wobjRun.uframe.trans.x:=20;\n    wobjRun.oframe:=wobjJig.oframe;\n"
    )
    assert "wobjRun" not in {one.name for one in taught_data(read({"m.mod": text}, "rapid").program)}


# what is changed in the program that is compared with the RAPID one, and what of it does not hold any more
BROKEN = {
    "a literal in place of the named point": (
        ("MoveL pPlace,", "MoveL [[50,-80,120],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],"),
        {"pPlace": "missing"},
    ),
    "a literal, and the point is kept for another move": (
        ("MoveL pPick,", "MoveL [[0,0,100],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],"),
        {"pPick": "fails"},
    ),
    "a value that was worked out": (
        ("Offs(pPick,0,0,100)", "[[0,0,200],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"),
        {"pPick": "fails"},
    ),
    "another point for the same place": (
        ("MoveL pPick,", "MoveL pOther,"),
        {"pPick": "copied"},
    ),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_does_not_follow_is_named(name: str) -> None:
    (old, new), wanted = BROKEN[name]
    point = "  CONST robtarget pOther:=[[0,0,100],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    text = RAPID.replace("  PROC main", point + "  PROC main").replace(old, new)
    first, second = read({"m.mod": RAPID}, "rapid").program, read({"m.mod": text}, "rapid").program
    assert prove_programs(first, second, ARMS["rapid"]).equal
    result = prove_programs(first, second, ARMS["rapid"], teaching=Teaching())
    found = states(result)
    assert {name: state for name, state in found.items() if state != "holds"} == wanted
    assert result.verdict == ("different" if "fails" in wanted.values() else "alike")
    assert all(name in result.headline() for name in wanted)
    if result.verdict == "different":
        assert result.difference is not None and result.difference.b.place.text.startswith("Move")


@pytest.mark.parametrize("target", ["tp", "inform", "vplus"])
@pytest.mark.parametrize("source", ["rapid", "krl"])
def test_moving_by_nothing_keeps_the_verdict(source: str, target: str) -> None:
    journey = there_and_back(SOURCES[source], source, target, ARMS[source])
    result = taught(journey, Amount(0.0, 0.0, 0.0))
    assert result.agrees and "fails" not in states(result).values(), result.as_text()


@pytest.mark.parametrize("source", ["rapid", "krl", "urscript"])
def test_data_taught_as_it_was_is_the_same_data(source: str) -> None:
    program = read(SOURCES[source], source).program
    data = taught_data(program)
    again = taught_data(with_taught(program, {one: Taught(one.value) for one in data}))
    assert [(one.name, one.kind) for one in again] == [(one.name, one.kind) for one in data]
    assert prove_programs(program, with_taught(program, {one: Taught(one.value) for one in data}), ARMS[source]).equal


# a name in A with its comment, one in B with its comment, and how they are seen to be one
NAMES = [
    ("pPick", "", "pPick", "", "name"),
    ("pPick", "", "PPICK", "", "name"),
    ("pPick", "", "XPick", "", "part of the name"),
    ("pAbovePick", "", "P1", "above pick", "part of the name"),
    ("pPick", "", "P1", "pPick", "comment"),
    ("pAboveConveyorIn", "", "P1", "pAboveConveyor", "comment"),
    ("pPick", "", "P1", "", "value"),
    ("pPick", "", "pDrop", "", "value"),
    ("P1", "", "P2", "", "value"),
]


@pytest.mark.parametrize(("ours", "comment", "theirs", "label", "how"), NAMES)
def test_data_is_matched_by_name_comment_and_value(ours: str, comment: str, theirs: str, label: str, how: str) -> None:
    (datum,) = [one for one in taught_data(read({"m.mod": RAPID}, "rapid").program) if one.name == "pPick"]
    here = replace(datum, name=ours, variable=ours, label=comment)
    there = replace(datum, name=theirs, variable=theirs, label=label)
    assert [copy.how for copy in paired([here], [there])[here]] == [how]


def test_equal_values_of_two_data_match_nothing() -> None:
    (datum,) = [one for one in taught_data(read({"m.mod": RAPID}, "rapid").program) if one.name == "pPick"]
    here = [replace(datum, name=name, variable=name) for name in ("pIn", "pOut")]
    assert all(not copies for copies in paired(here, [replace(datum, name="P1", variable="P1")]).values())


def test_the_command_tells_and_its_certificate_holds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "m.mod").write_text(RAPID)
    kept, folder = str(tmp_path / "c.json"), str(tmp_path / "out")
    asked = ["translate", str(tmp_path / "m.mod"), "--to", "vplus", "--robot", ARMS["rapid"], "--teach", "-o", folder]
    run([*asked, "--certificate", kept, "--json"])
    found = json.loads(capsys.readouterr().out)["proof"]["taught"]
    assert found["holds"] and found["seed"] == 1
    assert {one["name"]: one["state"] for one in found["data"]}["pPick"] == "holds"
    certificate = json.loads(Path(kept).read_text())
    assert certificate["question"]["teach"] == 1 and certificate["result"]["taught"]["holds"]
    assert run(["prove", "--check", kept]) == 0
    assert capsys.readouterr().out.startswith("the certificate holds")


def test_two_programs_by_people_are_matched_by_their_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.mod").write_text(RAPID)
    (tmp_path / "b.mod").write_text(RAPID.replace("pPlace", "pDrop"))
    asked = ["prove", str(tmp_path / "a.mod"), str(tmp_path / "b.mod"), "--robot", ARMS["rapid"], "--teach"]
    assert run([*asked, "--seed", "7", "--teach-mm", "2"]) == 0
    assert "re-taught: 3 points, 1 tool, 1 frame mean the same (by up to 2 mm and" in capsys.readouterr().out


@pytest.mark.parametrize("more", [["--seed", "3"], ["--teach-mm", "2"], ["--teach", "--teach-mm", "-1"]])
def test_amounts_without_teaching_are_refused(
    more: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "m.mod").write_text(RAPID)
    assert run(["prove", str(tmp_path / "m.mod"), str(tmp_path / "m.mod"), *more]) == 2
    assert "--teach" in capsys.readouterr().err


def test_a_point_may_have_any_name_and_a_load_is_no_place() -> None:
    """A point at the loader was passed by in silence, as if it were the centre of a load."""
    points = RAPID.replace("pPick", "pLoad").replace("pPlace", "LOAD_PRSS_P1")
    load = "  PERS loaddata loadPart:=[2,[0,0,50],[1,0,0,0],0,0,0];\n  PROC main()\n    GripLoad loadPart;\n"
    text = points.replace("  PROC main()\n", load)
    read = read_sources([source_from_text("M.mod", text)], "rapid", Diagnostics())
    assert [one.name for one in taught_data(read.program)] == ["tGrip", "wobjJig", "jHome", "pLoad", "LOAD_PRSS_P1"]
    load = "{M 2,CM {X 0,Y 0,Z 50,A 0,B 0,C 0},J {X 0,Y 0,Z 0}}"
    krl = f"DEFDAT main\nDECL LOAD LOAD_DATA[2]\nLOAD_DATA[1]={load}\nENDDAT\n"
    listed = read_sources(
        [source_from_text("main.src", "DEF main()\n$LOAD=LOAD_DATA[1]\nEND\n"), source_from_text("main.dat", krl)],
        "krl",
        Diagnostics(),
    )
    assert taught_data(listed.program) == ()
