"""What a project holds: programs and calls, what is missing, who writes and reads signals, points, frames, tools."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.inventory.contents import Contents, contents
from rpl.project import read_sources
from rpl.source import source_from_text

KRL = {
    "cell.dat": "DEFDAT cell\nSIGNAL doGrip $OUT[3]\nDECL FRAME Table={X 1,Y 2,Z 3,A 0,B 0,C 0}\n"
    "DECL E6POS XPick={X 1,Y 2,Z 3,A 0,B 90,C 0,S 2,T 35}\nENDDAT\n",
    "cell.src": "DEF cell()\n$BASE=Table\nPTP XPick\nPick(2)\nLost()\nPULSE($OUT[5],TRUE,0.5)\nIF $IN[7] THEN\n"
    "Pick(1)\nENDIF\nEND\n"
    "DEF Pick(level:IN)\nDECL INT level\ndoGrip=TRUE\nWAIT FOR doGrip\nIF level>1 THEN\nPick(level-1)\n"
    "ENDIF\nEND\nDEF Spare(level:IN)\nDECL INT level\n$OUT[level]=TRUE\nEND\nDEF Other()\n$OUT[4]=far\nEND\n",
}


def found(files: dict[str, str], dialect: str) -> Contents:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(path, text) for path, text in files.items()], dialect, diagnostics)
    return contents(read, diagnostics)


def test_programs_and_calls() -> None:
    programs = {one.name: one for one in found(KRL, "krl").programs}
    assert list(programs) == ["cell", "Pick", "Spare", "Other"]
    assert programs["cell"].calls == ("Pick",) and programs["cell"].missing == ("Lost",)
    assert programs["cell"].moves == 1 and programs["cell"].place == "cell.src:1"
    assert programs["Pick"].called_by == ("cell",)  # a routine that calls itself is called by nobody for that
    assert [name for name, one in programs.items() if one.entry] == ["cell"]  # Other is a subprogram of its file


def test_what_nobody_calls_and_cannot_be_started_is_unused() -> None:
    assert [one.name for one in found(KRL, "krl").unused] == ["Spare", "Other"]


def test_what_is_missing_has_its_places() -> None:
    missing = {(one.kind, one.name): one.places for one in found(KRL, "krl").missing}
    assert missing == {("routine", "Lost"): ("cell.src:5",), ("datum", "far"): ("cell.src:24",)}


def test_signals_by_writers_and_readers() -> None:
    signals = {(one.kind, one.number, one.name): (one.writers, one.readers) for one in found(KRL, "krl").signals}
    assert signals == {
        ("digital in", "7", ""): ((), ("cell",)),
        ("digital out", "computed", ""): (("Spare",), ()),
        ("digital out", "3", "doGrip"): (("Pick",), ("Pick",)),
        ("digital out", "4", ""): (("Other",), ()),
        ("digital out", "5", ""): (("cell",), ()),
    }


def test_points_frames_and_tools() -> None:
    data = {one.name: (one.kind, one.place, one.used_by) for one in found(KRL, "krl").data}
    assert data == {"Table": ("work object", "cell.dat:3", ("cell",)), "XPick": ("point", "cell.dat:4", ("cell",))}


def test_tasks_traps_and_functions() -> None:
    text = (
        "MODULE m\nVAR intnum i;\nPROC main()\nCONNECT i WITH tStop;\nISignalDI diStop,1,i;\nrun size(2);\nENDPROC\n"
        "PROC run(num n)\nWaitTime n;\nENDPROC\nFUNC num size(num n)\nRETURN n;\nENDFUNC\n"
        "TRAP tStop\nStop;\nENDTRAP\nENDMODULE\n"
    )
    programs = {one.name: one for one in found({"m.mod": text}, "rapid").programs}
    assert programs["main"].calls == ("tStop", "run", "size")
    assert [(one.kind, one.called_by) for one in programs.values()] == [
        ("procedure", ()),
        ("procedure", ("main",)),
        ("function", ("main",)),
        ("trap", ("main",)),
    ]


def test_the_same_for_machines() -> None:
    document = found(KRL, "krl").as_json()
    assert document["languages"] == ["krl"] and document["entries"] == ["cell"]
    assert document["unused"] == ["Spare", "Other"]
    assert [(one["file"], one["dialect"], one["opaque"]) for one in document["files"]] == [
        ("cell.dat", "krl", 0),
        ("cell.src", "krl", 0),
    ]


def test_what_a_text_or_an_error_may_call_is_not_unused() -> None:
    text = (
        'MODULE m\nPERS string job:="later";\nPROC main()\n%job%;\nENDPROC\nPROC later()\nWaitTime 1;\nENDPROC\n'
        "PROC never(num n)\nWaitTime n;\nENDPROC\nENDMODULE\n"
    )
    contents_found = found({"m.mod": text}, "rapid")
    assert [one.name for one in contents_found.entries] == ["main"]
    assert [one.name for one in contents_found.unused] == ["never"]
    assert [one.name for one in contents_found.programs if one.by_text] == ["later"]


def test_routines_of_one_name_stay_apart() -> None:
    body = "PROC main()\nnear;\nENDPROC\nLOCAL PROC near()\nSet do1;\nENDPROC\nENDMODULE\n"
    other = "MODULE b\nPROC second()\nnear;\nENDPROC\nLOCAL PROC near()\nSet do2;\nENDPROC\nENDMODULE\n"
    contents_found = found({"a.mod": f"MODULE a\n{body}", "b.mod": other}, "rapid")
    assert {one.name: one.calls for one in contents_found.programs} == {
        "main": ("a.near",), "a.near": (), "second": ("b.near",), "b.near": (),
    }  # fmt: skip
    assert [one.writers for one in contents_found.signals] == [("a.near",), ("b.near",)]


def test_what_people_start() -> None:
    """Not what takes arguments, not a subprogram of a file, and not a task that runs by itself."""
    files = {
        "pick.src": "DEF pick()\nPTP {A1 0}\nEND\nGLOBAL DEF helper()\nPTP {A1 0}\nEND\n",
        "grip.src": "DEF grip(n :IN)\nINT n\n$OUT[n]=TRUE\nEND\n",
        "sps.sub": "DEF SPS()\nLOOP\n$OUT[9]=$IN[9]\nENDLOOP\nEND\n",
    }
    assert [one.name for one in found(files, "krl").entries] == ["pick"]
    module = 'MODULE m\nPROC one()\nTPWrite "1";\nENDPROC\nPROC two()\nTPWrite "2";\nENDPROC\nENDMODULE\n'
    assert [one.name for one in found({"m.mod": module}, "rapid").entries] == ["one", "two"]  # PP to Routine
