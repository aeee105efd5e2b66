"""`rpl translate` without a proof: what is written where, and what each exit status says."""

import json
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.writing.namemap import read_map

PROGRAM = """DEF demo()
INT i
FOR i=1 TO 3
  $OUT[i]=TRUE
ENDFOR
END
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "demo.src"
    path.write_text(PROGRAM)
    return path


def test_a_single_file_is_printed(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["translate", str(program), "--to", "krl"]) == 0
    assert "$OUT[i]=TRUE" in capsys.readouterr().out


def test_a_folder_is_written(program: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "new" / "out"
    assert run(["translate", str(program), "--to", "krl", "-o", str(folder), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert {"files", "diagnostics", "losses", "proof"} <= set(document)
    assert document["proof"] is None
    assert document["losses"] == []
    (file,) = document["files"]
    assert Path(file["written"]).read_text("latin-1").startswith("DEF demo")


def test_without_a_folder_json_carries_the_text(program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["translate", str(program), "--to", "rpl", "--json"]) == 0
    (file,) = json.loads(capsys.readouterr().out)["files"]
    assert "FOR i = 1 TO 3" in file["text"]


def test_nothing_is_written_from_a_program_with_errors(
    program: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program.write_text(PROGRAM.replace("ENDFOR", "ENDFORR )"))
    folder = tmp_path / "out"
    assert run(["translate", str(program), "--to", "krl", "-o", str(folder), "--json"]) == 1
    out, err = capsys.readouterr()
    assert not folder.exists()
    assert json.loads(out)["files"] == []
    assert "nothing was written" in err


def test_a_folder_that_cannot_be_written_is_a_usage_error(
    program: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "taken").write_text("")
    assert run(["translate", str(program), "--to", "krl", "-o", str(tmp_path / "taken" / "in")]) == 2
    assert "cannot write" in capsys.readouterr().err


@pytest.mark.parametrize("option", [["--robot", "nobody"], ["--to-robot", "nobody"], ["--from", "nobody"]])
def test_unknown_names(program: Path, option: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["translate", str(program), "--to", "krl", *option]) == 2
    assert "nobody" in capsys.readouterr().err


LONG_NAMES = """DEF first_program()
put_down_the_part()
put_down_the_box()
END
DEF put_down_the_part()
$OUT[1]=TRUE
END
DEF put_down_the_box()
$OUT[2]=TRUE
END
"""


def test_an_option_of_the_target(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Old controllers take program names of 8 characters."""
    path = tmp_path / "first_program.src"
    path.write_text(LONG_NAMES)
    out = tmp_path / "out"
    wanted = ["translate", str(path), "--to", "tp", "-o", str(out), "--option", "names=8", "--prove", "--json"]
    assert run(wanted) == 0
    assert json.loads(capsys.readouterr().out)["proof"]["equal"]
    names = sorted(one.stem for one in out.glob("*.LS"))
    assert names == ["FIRST_PR", "PUT_DOWN", "PUT_DO_2"]
    assert "CALL PUT_DOWN " in (out / "FIRST_PR.LS").read_text()


@pytest.mark.parametrize(
    ("given", "answer"),
    [
        ("nams=8", "there is names: longest program name"),
        ("names=9", "8 characters"),
        ("names", "NAME=VALUE"),
    ],
)
def test_an_option_that_is_none(given: str, answer: str, program: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["translate", str(program), "--to", "tp", "--option", given]) == 2
    assert answer in capsys.readouterr().err


COUNTS = """DEF counts()
DECL INT {names}
{lines}
$OUT[1]=TRUE
END
"""


def counts(path: Path, *names: str) -> Path:
    path.write_text(
        COUNTS.format(names=",".join(names), lines="\n".join(f"{name}=1\n{name}={name}+1" for name in names))
    )
    return path


def numbers(file: Path) -> dict[str, tuple[str, int]]:
    return {name.lower(): at for at, name in read_map(file).numbers.items()}


def test_numbers_of_an_earlier_translation_are_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A variable more in front does not move the others."""
    first, second, anew = tmp_path / "first", tmp_path / "second", tmp_path / "anew"
    program = counts(tmp_path / "counts.src", "parts", "boxes")
    assert run(["translate", str(program), "--to", "tp", "-o", str(first)]) == 0
    before = numbers(first / "map.toml")
    counts(program, "added", "boxes", "parts")
    kept = ["--map", str(first / "map.toml")]
    assert run(["translate", str(program), "--to", "tp", "-o", str(anew)]) == 0
    assert run(["translate", str(program), "--to", "tp", "-o", str(second), *kept, "--prove"]) == 0
    after = numbers(first / "map.toml")
    assert not (second / "map.toml").exists()
    assert {name: after[name] for name in before} == before
    assert after["added"] not in before.values()
    assert numbers(anew / "map.toml") != after
    bank, number = before["boxes"]
    assert f"{bank}[{number}:boxes]={bank}[{number}:boxes]+1" in (second / "COUNTS.LS").read_text()


def test_a_map_that_is_not_there_yet_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, chosen = counts(tmp_path / "counts.src", "parts"), tmp_path / "kept" / "line.toml"
    assert run(["translate", str(program), "--to", "tp", "--map", str(chosen)]) == 0
    assert numbers(chosen) == {"parts": ("R", 1)}


def test_names_and_numbers_of_an_edited_map_are_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, chosen = counts(tmp_path / "counts.src", "parts"), tmp_path / "map.toml"
    chosen.write_text('target = "tp"\n[names]\ncounts = "COUNT_ALL"\n[numbers.R]\n12 = "parts"\n')
    out = tmp_path / "out"
    assert run(["translate", str(program), "--to", "tp", "-o", str(out), "--map", str(chosen), "--prove"]) == 0
    assert "R[12:parts]=R[12:parts]+1" in (out / "COUNT_ALL.LS").read_text()
    assert read_map(chosen).names == {"counts": "COUNT_ALL"}


def test_a_number_that_the_source_says_is_told_where_the_map_says_another(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program, chosen = tmp_path / "grip.src", tmp_path / "map.toml"
    program.write_text("DEF grip()\nSIGNAL grip $OUT[5]\ngrip=TRUE\nEND\n")
    chosen.write_text('target = "tp"\n[numbers.digital_out]\n7 = "grip"\n')
    assert run(["translate", str(program), "--to", "tp", "--map", str(chosen)]) == 0
    assert "map-not-kept the map gives grip the number 7 of digital_out; it has 5" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "answer"),
    [
        ("", "map.toml: target: a map begins"),
        ('target = "tp"\n[numbers.R]\nx = "parts"\n', "map.toml:3: x: a line has"),
        ('target = "tp"\n[names]\ncounts = "MOVE 7"\n', "map.toml:3: counts: 'MOVE 7' is no name that a program"),
    ],
)
def test_a_map_that_is_none(text: str, answer: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, given = counts(tmp_path / "counts.src", "parts"), tmp_path / "map.toml"
    given.write_text(text)
    assert run(["translate", str(program), "--to", "tp", "--map", str(given)]) == 2
    assert answer in capsys.readouterr().err


def test_a_script_is_proved_from_its_own_beginning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A program whose name a register may hold stands in the script as one of its routines."""
    lines = (
        "R[1]=1 ;\nR[2]=0 ;\nSR[1]='PART' ;\nSR[2]=R[1] ;\nSR[3]=SR[1]+SR[2] ;\nCALL SR[3] ;\n"
        "DO[1]=(R[1]=1 AND R[2]=7) ;"
    )
    for name, body in (("MAIN", lines), ("PART1", "R[2]=7 ;"), ("PART2", "R[2]=8 ;")):
        (tmp_path / f"{name}.LS").write_text(f"/PROG {name}\n/ATTR\n/MN\n{body}\n/POS\n/END\n")
    wanted = ["translate", str(tmp_path), "--to", "urscript", "-o", str(tmp_path / "out"), "--prove", "--json"]
    wanted += ["--accept", "digits-in-texts"]
    assert run(wanted) == 0
    assert json.loads(capsys.readouterr().out)["proof"]["equal"]


def test_one_program_is_printed_and_what_belongs_to_it_named(capsys: pytest.CaptureFixture[str]) -> None:
    sample = str(Path(__file__).parents[2] / "samples/krl/palletiser/palletiser.src")
    assert run(["translate", sample, "--to", "krl"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("&ACCESS") and "DEFDAT" not in out
    assert "to what is printed belong Palletiser.dat: -o DIR" in err


def test_several_programs_need_a_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "two.src"
    program.write_text(TWO)
    assert run(["translate", str(program), "--to", "tp"]) == 2
    assert "2 programs would be written (A.LS, B.LS): name a folder with -o" in capsys.readouterr().err


def test_the_entry_is_that_of_the_proof(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without one it cannot be told which of the two is the program."""
    program = tmp_path / "two.src"
    move = "PTP {A1 10,A2 -80,A3 95,A4 0,A5 30,A6 0}\n"
    program.write_text(TWO.replace("$OUT[2]", move + "$OUT[2]"))
    arguments = ["translate", str(program), "--to", "krl", "--robot", "kuka_kr6r900sixx", "--prove", "--json"]
    assert run(arguments) == 2
    assert "name one with --entry" in capsys.readouterr().err
    assert run([*arguments, "--entry", "b"]) == 0
    assert json.loads(capsys.readouterr().out)["proof"] is not None


TWO = "DEF a()\n$OUT[1]=TRUE\nEND\nDEF b()\n$OUT[2]=TRUE\nEND\n"


@pytest.mark.parametrize(("entry", "output"), [("a", 0), ("B", 1)])
def test_the_entry_begins_what_is_written_and_the_proof(
    entry: str, output: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program, folder = tmp_path / "two.src", tmp_path / "out"
    program.write_text(TWO)
    arguments = ["translate", str(program), "--to", "urscript", "-o", str(folder), "--json"]
    assert run([*arguments, "--entry", entry]) == 0
    assert json.loads(capsys.readouterr().out)["losses"] == []
    assert [file.name for file in folder.glob("*.*t")] == [f"{entry.lower()}.script"]
    assert run(["run", str(folder), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["outputs"] == [[0.0, f"digital_out[{output}]", True]]
    assert run([*arguments, "--entry", "c"]) == 2
    assert "there is no routine c: candidates are a, b" in capsys.readouterr().err
