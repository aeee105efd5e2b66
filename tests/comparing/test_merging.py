"""Two changed versions of a program come together; what both changed otherwise is left to people, told by meaning."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.comparing import differences
from rpl.comparing.aligning import gaps
from rpl.comparing.merging import CONFLICT, MERGED, OURS, REMOVED, THEIRS, Merged, merged
from rpl.diagnostics import Diagnostics
from rpl.project import read_program, read_sources
from rpl.source import source_from_bytes

SAMPLES = Path(__file__).parents[2] / "samples"


def sample(path: str) -> bytes:
    return (SAMPLES / path).read_bytes()


def one(name: str, base: bytes, ours: bytes, theirs: bytes) -> Merged:
    return merged({name: base}, {name: ours}, {name: theirs})


# A point of the floor (old, new) and an edit of the office (old, new) in one file of each language.
TENDING = "machine_tending/machine_tending"
CASES = [
    (f"rapid/{TENDING}.mod", (b"[[300,50,300]", b"[[304,50,300]"), (b"    Load;\n", b"    Load;\n    Stop;\n")),
    ("tp/machine_tending/tending.ls", (b"X =   420.000", b"X =   424.000"), (b"  10:  DO[3:gripper]=ON ;\n", b"")),
    ("inform/machine_tending/TEND.JBI", (b"C00003=250.000", b"C00003=254.000"), (b"TIMER T=0.20", b"TIMER T=0.50")),
    (f"urscript/{TENDING}.script", (b"p[-0.1, -0.4", b"p[-0.104, -0.4"), (b"sleep(0.5)", b"sleep(0.7)")),
    (f"vplus/{TENDING}.v2", (b"TRANS(300,", b"TRANS(304,"), (b"tries = 0", b"tries = 1")),
    (f"krl/{TENDING}.dat", (b"X 680.0", b"X 684.0"), (b"LASTALARM=0", b"LASTALARM=1")),
    ("rpl/palletiser/palletiser.rpl", (b"{x: 350, y: 60", b"{x: 354, y: 60"), (b"rows: INT = 2", b"rows: INT = 3")),
    ("val3/machine_tending/tending.dtx", (b'x="400"', b'x="404"'), (b'x="300"', b'x="290"')),
]  # fmt: skip


@pytest.mark.parametrize(("path", "touch", "edit"), CASES, ids=[path.partition("/")[0] for path, *_ in CASES])
def test_a_touch_up_and_an_edit_come_together(path: str, touch: tuple[bytes, bytes], edit: tuple[bytes, bytes]) -> None:
    base, name = sample(path), Path(path).name
    ours, theirs, both = base.replace(*touch, 1), base.replace(*edit, 1), base.replace(*touch, 1).replace(*edit, 1)
    assert len({base, ours, theirs, both}) == 4
    found = one(name, base, ours, theirs)
    (file,) = found.files
    assert found.clean and file.outcome == MERGED and file.data is not None
    language = path.partition("/")[0]
    read = [read_sources([source_from_bytes(name, data)], language, Diagnostics()) for data in (file.data, both)]
    told = differences(*read)
    assert told.same and not told.counts


def test_a_listing_is_numbered_again_and_keeps_the_date_of_ours() -> None:
    base = sample("tp/machine_tending/tending.ls")
    ours = base.replace(b"X =   420.000", b"X =   424.000")
    theirs = base.replace(b"  10:  DO[3:gripper]=ON ;", b"  10:  DO[3:gripper]=ON ;\n  11:  DO[9]=ON ;")
    theirs = theirs.replace(b"MODIFIED\t= DATE 24-03-04", b"MODIFIED\t= DATE 26-11-29")
    (file,) = one("tending.ls", base, ours, theirs).files
    assert file.outcome == MERGED and file.data is not None
    lines = file.data.decode().splitlines()
    numbers = [int(line.partition(":")[0]) for line in lines if line.partition(":")[0].strip().isdigit()]
    assert numbers == list(range(1, 36)) and "LINE_COUNT\t= 35;" in lines
    assert "  11:  DO[9]=ON ;" in lines and "MODIFIED\t= DATE 24-03-04  TIME 08:00:00;" in lines


def test_one_point_changed_otherwise_by_both_is_a_conflict_told_in_millimetres() -> None:
    base = sample("tp/machine_tending/tending.ls")
    ours, theirs = (base.replace(b"X =   420.000", b"X =   " + new) for new in (b"424.000", b"432.500"))
    (file,) = one("tending.ls", base, ours, theirs).files
    assert file.outcome == CONFLICT and file.data is not None
    assert [each.words for each in file.conflicts] == ["P3: ours moved 4.00 mm (x +4), theirs moved 12.50 mm (x +12.5)"]
    lines = file.data.decode().splitlines()
    at = [lines.index(mark) for mark in ("<<<<<<< ours", "=======", ">>>>>>> theirs")]
    assert at[0] + 1 == file.conflicts[0].line
    assert lines[at[0] + 1].startswith('P[3:"load"]{') and lines[at[1] + 1].startswith('P[3:"load"]{')


PLACE = "Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}\n"
DATA = f"DEFDAT two\nDECL E6POS XA={{X 1.0,{PLACE}DECL E6POS XB={{X 2.0,{PLACE}ENDDAT\n"


def test_points_on_lines_side_by_side_do_not_meet() -> None:
    ours, theirs = DATA.replace("X 1.0", "X 1.5"), DATA.replace("X 2.0", "X 2.5")
    (file,) = one("two.dat", DATA.encode(), ours.encode(), theirs.encode()).files
    assert (file.outcome, file.data) == (MERGED, DATA.replace("X 1.0", "X 1.5").replace("X 2.0", "X 2.5").encode())


def test_new_points_of_both_sides_are_both_taken() -> None:
    new = [f"DECL E6POS X{name}={{X 9.0,{PLACE}" for name in "CD"]
    ours, theirs = (DATA.replace("ENDDAT", one + "ENDDAT") for one in new)
    (file,) = one("two.dat", DATA.encode(), ours.encode(), theirs.encode()).files
    assert (file.outcome, file.data) == (MERGED, DATA.replace("ENDDAT", "".join(new) + "ENDDAT").encode())


def test_what_one_side_changed_is_that_side_to_the_byte() -> None:
    base = sample("rapid/machine_tending/machine_tending.mod")
    other = base.replace(b"v500", b"v400").replace(b"\n", b"\r\n")
    for ours, theirs, outcome in ((base, other, THEIRS), (other, base, OURS), (other, other, OURS)):
        (file,) = one("m.mod", base, ours, theirs).files
        assert (file.outcome, file.data) == (outcome, other)


def test_a_merge_that_cannot_be_read_is_not_done() -> None:
    base = b"DEF demo()\nHALT\nHALT\nHALT\nHALT\nEND\n"
    ours = base.replace(b"DEF demo()\n", b"DEF demo()\nINT i\n", 1).replace(
        b"HALT\nHALT\nHALT\nHALT\n", b"FOR i=1 TO 2\nHALT\nHALT\nHALT\nHALT\nENDFOR\n"
    )
    theirs = base.replace(b"HALT\nHALT\nHALT\nHALT\nEND", b"HALT\nHALT\nHALT\nHALT\nINT late\nWHILE TRUE\nHALT\nEND")
    found = one("demo.src", base, ours, theirs)
    assert not found.clean


def test_files_that_one_side_added_or_removed() -> None:
    text = b"DEF a()\nHALT\nEND\n"
    found = merged(
        {"a.src": text, "b.src": text}, {"a.src": text, "c.src": text}, {"a.src": text, "b.src": text, "d.src": text}
    )
    outcomes = {file.path: file.outcome for file in found.files}
    assert outcomes == {"a.src": "same", "b.src": REMOVED, "c.src": OURS, "d.src": THEIRS} and found.clean
    changed = merged({"b.src": text}, {}, {"b.src": text.replace(b"HALT", b"WAIT SEC 1")})
    assert not changed.clean and changed.files[0].conflicts[0].words == "b.src: ours removed it, theirs changed it"


def test_folders_are_merged_file_by_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    base = {path.name: path.read_bytes() for path in (SAMPLES / "krl/machine_tending").iterdir()}
    ours = dict(base) | {"machine_tending.dat": base["machine_tending.dat"].replace(b"X 680.0", b"X 684.0")}
    theirs = dict(base) | {"machine_tending.src": base["machine_tending.src"].replace(b"WAIT SEC 0.3", b"WAIT SEC 0.5")}
    for side, files in (("base", base), ("ours", ours), ("theirs", theirs)):
        (tmp_path / side).mkdir()
        for name, data in files.items():
            (tmp_path / side / name).write_bytes(data)
    words = [str(tmp_path / side) for side in ("base", "ours", "theirs")]
    assert run(["merge", *words, "-o", str(tmp_path / "out"), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert {file["file"]: file["outcome"] for file in document["files"]}["machine_tending.dat"] == "ours"
    written = {name: (tmp_path / "out" / name).read_bytes() for name in base}
    assert written == {**theirs, "machine_tending.dat": ours["machine_tending.dat"]}
    assert run(["merge", *words]) == 2


def test_a_count_of_positions_is_made_right_again() -> None:
    base = sample("inform/machine_tending/TEND.JBI")
    line = base[base.index(b"C00003=") :].partition(b"\n")[0] + b"\n"
    new = line.replace(b"C00003", b"C00004")
    ours = base.replace(line, line + new).replace(b"///NPOS 4,", b"///NPOS 5,")
    theirs = base.replace(b"TIMER T=0.20", b"TIMER T=0.50")
    (file,) = one("TEND.JBI", base, ours, theirs).files
    assert file.data is not None and b"///NPOS 5,0,0,0,0,0" in file.data
    read = read_sources([source_from_bytes("TEND.JBI", file.data)], "inform", Diagnostics())
    assert sum(report.opaque for report in read.files) == 0


def test_gaps_put_back_give_the_other_list() -> None:
    a, b = list("abcabcxabc" * 30), list("abcyabcabc" * 28)
    done: list[str] = []
    at = 0
    for i, i_end, j, j_end in gaps(a, b):
        done += a[at:i] + b[j:j_end]
        at = i_end
    assert done + a[at:] == b


def test_the_merged_program_reads_as_both_wanted(tmp_path: Path) -> None:
    base = sample("urscript/machine_tending/machine_tending.script")
    ours, theirs = base.replace(b"p[-0.1, -0.4", b"p[-0.104, -0.4"), base.replace(b"sleep(0.5)", b"sleep(0.7)")
    for name, data in (("base", base), ("ours", ours), ("theirs", theirs)):
        (tmp_path / f"{name}.script").write_bytes(data)
    out = tmp_path / "out.script"
    words = [str(tmp_path / f"{name}.script") for name in ("base", "ours", "theirs")]
    assert run(["merge", *words, "-o", str(out)]) == 0
    assert out.read_bytes() == ours.replace(b"sleep(0.5)", b"sleep(0.7)")
    assert not any(report.opaque for report in read_program([out]).files)
