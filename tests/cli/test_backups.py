"""Backups as they come: files of the controller beside programs, programs in two forms, the arm that they name."""

import gzip
import io
import json
import tarfile
import zipfile
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_program

LISTING = "/PROG  MAIN\n/ATTR\nDEFAULT_GROUP = 1,*,*,*,*;\n/MN\n   1:  DO[1]=ON ;\n/POS\n/END\n"
MODULE = "MODULE {0}\n  PROC main()\n    SetDO do1, 1;\n  ENDPROC\nENDMODULE\n"
SAVED = (
    '<?xml version="1.0"?><URProgram name="pick"><children><MainProgram><children><Script type="Code"><cachedContents>'
    "set_standard_digital_out(0, True)</cachedContents></Script></children></MainProgram></children></URProgram>"
)
SCRIPT = "def pick():\n  set_standard_digital_out(0, True)\nend\n"
ZEROS = b"\x00\x01\x02\x03" * 64

UR = {
    "programs/pick.urp": gzip.compress(SAVED.encode()),
    "programs/pick.script": SCRIPT.encode(),
    "programs/only.urp": gzip.compress(SAVED.replace("pick", "only").encode()),
    "programs/default.installation": gzip.compress(b'<?xml version="1.0"?><Installation/>'),
    "programs/default.variables": b"counted=3\n",
}
FANUC = {"MAIN.LS": LISTING.encode(), "MAIN.TP": ZEROS, "SYSVARS.SV": ZEROS, "LOST.TP": ZEROS}
KUKA = {
    "am.ini": b"[Archive]\nName=cell\n",
    "KRC/R1/Program/main.src": b"DEF main()\n$OUT[1]=TRUE\nEND\n",
    "KRC/R1/Mada/$machine.dat": b'DEFDAT $MACHINE\nCHAR $TRAFONAME[32]\n$TRAFONAME[]="#KR6R900SIXX C4"\nENDDAT\n',
}
ABB = {
    "BACKINFO/backinfo.txt": b">>SYSTEM_ID:\nplain text\n",
    "RAPID/TASK1/PROGMOD/Main.mod": MODULE.format("first").encode(),
    "RAPID/TASK1/SYSMOD/base.sys": b"MODULE BASE(SYSMODULE)\n  PERS num counted:=0;\nENDMODULE\n",
    "RAPID/TASK2/PROGMOD/Watch.mod": MODULE.format("second").encode(),
    "HOME/notes.txt": b"buy milk\n",
    "SYSPAR/MOC.cfg": b'MOC:CFG_1.0:6:0::\n#\nROBOT:\n\n      -name "ROB_1" -use_robot_type "IRB1200_5_0.9"\n',
}


def folder(root: Path, files: dict[str, bytes]) -> Path:
    for name, data in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return root


def zipped(root: Path, files: dict[str, bytes]) -> Path:
    path = root / "backup.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path


def tarred(root: Path, files: dict[str, bytes]) -> Path:
    path = root / "backup.tgz"
    with tarfile.open(path, "w:gz") as archive:
        for name, data in files.items():
            entry = tarfile.TarInfo(name)
            entry.size = len(data)
            archive.addfile(entry, io.BytesIO(data))
    return path


@pytest.mark.parametrize("packed", [folder, zipped, tarred])
def test_a_program_that_is_there_as_script_and_saved_is_read_once(packed: object, tmp_path: Path) -> None:
    assert callable(packed)
    diagnostics = Diagnostics()
    read = read_program([packed(tmp_path, UR)], diagnostics=diagnostics)
    assert [Path(report.path).name for report in read.files] == ["pick.script", "only.urp"]
    assert not diagnostics.of(Severity.WARNING) and not diagnostics.has_errors
    aside = {Path(item.origin.file).name for item in diagnostics if item.code.name == "file-set-aside"}
    assert aside == {"pick.urp", "default.installation", "default.variables"}


def test_a_binary_program_without_its_listing_is_missed(tmp_path: Path) -> None:
    diagnostics = Diagnostics()
    read = read_program([folder(tmp_path, FANUC)], diagnostics=diagnostics)
    assert [Path(report.path).name for report in read.files] == ["MAIN.LS"]
    (missed,) = diagnostics.of(Severity.WARNING)
    assert (missed.code.name, Path(missed.origin.file).name) == ("program-without-text", "LOST.TP")
    assert "LOST.LS" in missed.code.help.format(**dict(missed.arguments))


def test_what_a_backup_names_is_the_arm_of_each_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pinocchio", reason="arms need the package pin")
    backup = str(folder(tmp_path / "backup", KUKA))
    said = "the arm is kuka_kr6r900sixx: $machine.dat calls it KR6R900SIXX C4"
    assert run(["run", backup]) == 0
    assert said in capsys.readouterr().err
    assert run(["translate", backup, "--to", "rapid", "-o", str(tmp_path / "out")]) in (0, 3)
    assert said in capsys.readouterr().err
    assert run(["prove", backup, backup]) == 0
    assert said in capsys.readouterr().err
    assert run(["run", backup, "--robot", "kuka_kr10r900_2"]) == 0
    assert said not in capsys.readouterr().err


def test_a_backup_of_several_tasks_is_one_project(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["project", str(zipped(tmp_path, ABB)), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {one["name"]: one["task"] for one in found["programs"]} == {
        "TASK1.first.main": "TASK1",
        "TASK2.second.main": "TASK2",
    }
    assert [one["robot"] for one in found["arms"]] == ["abb_irb1200_5_90"]
    aside = {one["file"] for one in found["diagnostics"] if one["code"] == "file-set-aside"}
    assert {Path(one).name for one in aside} == {"backinfo.txt"}
