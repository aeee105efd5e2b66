"""The rules of sending, whatever the protocol: all files or none, whatever fails; nothing is lost."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import pytest

from rpl.controllers import journal as journals
from rpl.controllers.journal import UnfinishedError
from rpl.controllers.planning import is_temporary, plan
from rpl.controllers.profile import Profile
from rpl.controllers.sending import NotSentError, Outcome, finish, send
from tests.controllers.failing import Controller, FailingLink, Killed, profile_in

OLD = {"a.src": b"old a\n", "a.dat": b"old a data\n", "other.src": b"other\n", "other.dat": b"o\n"}
NEW = {"a.src": b"new a\n", "a.dat": b"new a data\n", "b.src": b"b\n", "b.dat": b"b data\n"}
AFTER = {**OLD, **NEW}
HOW = ("before", "after", "refuse", "kill")


def folder_with(where: Path, files: Mapping[str, bytes]) -> Path:
    folder = where / "programs"
    folder.mkdir()
    for name, data in files.items():
        (folder / name).write_bytes(data)
    return folder


def transfer(controller: Controller, folder: Path, profile: Profile) -> Outcome:
    link = FailingLink(controller)
    planned = plan(link, profile, folder)
    assert not planned.against
    return send(link, lambda profile: FailingLink(controller), profile, planned)


def requests_of_a_transfer(tmp_path: Path, renames: bool) -> int:
    controller = Controller(dict(OLD), renames)
    where = tmp_path / f"count-{renames}"
    where.mkdir()
    outcome = transfer(controller, folder_with(where, NEW), profile_in(where / "state"))
    assert outcome.journal.step == "done"
    assert controller.files == AFTER
    assert controller.loaded == sorted(NEW)
    return controller.requests


@pytest.mark.parametrize("renames", [True, False])
@pytest.mark.parametrize("for_good", [False, True])
@pytest.mark.parametrize("how", HOW)
def test_whatever_fails_the_controller_has_the_old_or_the_new_set_or_a_journal_says(
    tmp_path: Path, how: str, for_good: bool, renames: bool
) -> None:
    if how == "kill" and for_good:
        pytest.skip("a process is killed once")
    total = requests_of_a_transfer(tmp_path, renames)
    ends = set()
    for number in range(1, total + 1):
        where = tmp_path / f"at-{number}"
        where.mkdir()
        folder, profile = folder_with(where, NEW), profile_in(where / "state")
        controller = Controller(dict(OLD), renames, number, how, for_good)
        ends.add(ended(controller, folder, profile))
    assert "old" in ends
    if how == "kill":
        assert "journal" in ends


def ended(controller: Controller, folder: Path, profile: Profile) -> str:
    """Send, and say how it ended; whatever a journal says can be finished forwards and backwards."""
    from rpl.controllers.link import LinkError

    try:
        transfer(controller, folder, profile)
    except LinkError:  # while it was only looked at
        assert controller.files == OLD
        assert journals.unfinished(profile.state_folder, profile.name) is None
        return "old"
    except (NotSentError, Killed):
        journal = journals.unfinished(profile.state_folder, profile.name)
        if journal is None:
            assert without_temporary(controller.files) == OLD
            assert controller.locked is False
            return "old" if controller.files == OLD else "old with what could not be removed"
        controller.fails = 0
        (journal.folder.parent / journals.LOCK).unlink(missing_ok=True)
        with pytest.raises(UnfinishedError, match="--roll-back"):
            transfer(controller, folder, profile)
        before, loaded = dict(controller.files), list(controller.loaded)
        finish(lambda profile: FailingLink(controller), profile, journal, True)
        assert controller.files == AFTER
        controller.files, controller.loaded = before, loaded
        journal.at(journal.step)  # as it was before it was finished
        finish(lambda profile: FailingLink(controller), profile, journal, False)
        assert controller.files == OLD
        assert not {"b.src", "b.dat"} & {*controller.loaded}
        return "journal"
    assert controller.files == AFTER
    return "new"


def without_temporary(files: Mapping[str, bytes]) -> dict[str, bytes]:
    return {name: data for name, data in files.items() if not is_temporary(name)}


@pytest.mark.parametrize("renames", [True, False])
@pytest.mark.parametrize("write", range(1, 5))
def test_a_truncated_write_is_seen_and_undone(tmp_path: Path, renames: bool, write: int) -> None:
    controller = Controller(dict(OLD), renames, truncates=write)
    with pytest.raises(NotSentError, match="holds what it held before"):
        transfer(controller, folder_with(tmp_path, NEW), profile_in(tmp_path / "state"))
    assert controller.files == OLD


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"is_running": True}, "runs a program"),
        ({"emergency_stop": True}, "emergency stop"),
    ],
)
def test_a_controller_that_does_not_stand_is_not_written_to(tmp_path: Path, change: dict[str, bool], said: str) -> None:
    controller = Controller(dict(OLD), **change)  # type: ignore[arg-type]
    planned = plan(FailingLink(controller), profile_in(tmp_path), folder_with(tmp_path, NEW))
    assert any(said in text for text in planned.against)
    assert controller.files == OLD


@pytest.mark.parametrize(
    ("files", "said"),
    [
        ({"a.src": b"x"}, "must travel with it"),
        ({"a.src": b"x\n\xff", "a.dat": b""}, "a.src:2: byte 0xff is none of utf-8"),
    ],
)
def test_what_may_not_be_sent_is_named(tmp_path: Path, files: dict[str, bytes], said: str) -> None:
    planned = plan(FailingLink(Controller(dict(OLD))), profile_in(tmp_path), folder_with(tmp_path, files))
    assert any(said in text for text in planned.against)


def test_what_would_change_and_what_is_wrong_is_told_by_meaning(tmp_path: Path) -> None:
    program = b"DEF a( )\nWAIT SEC 1\n%s\nEND\n"
    there, here = program % b"$OUT[1]=TRUE", program % b"$OUT[1]=FALSE\nFOR = 1"
    controller = Controller({"a.src": there, "a.dat": b"DEFDAT a\nENDDAT\n"})
    files = {"a.src": here, "a.dat": controller.files["a.dat"]}
    planned = plan(FailingLink(controller), profile_in(tmp_path), folder_with(tmp_path, files))
    assert not planned.against
    assert any("$OUT[1]" in line for line in planned.changes)
    assert any("a.src:" in line and "error" in line for line in planned.errors)


def test_files_of_safety_and_system_are_left_out_and_that_is_said(tmp_path: Path) -> None:
    folder, controller = folder_with(tmp_path, {**NEW, "$machine.dat": b"x", "notes.txt": b"x"}), Controller(dict(OLD))
    profile = profile_in(tmp_path / "state")
    planned = plan(FailingLink(controller), profile, folder)
    assert [text.partition(":")[0] for text in planned.left_out] == ["$machine.dat", "notes.txt"]
    assert "never sent" in planned.left_out[0]
    send(FailingLink(controller), lambda profile: FailingLink(controller), profile, planned)
    assert controller.files == AFTER


def test_another_controller_than_the_profile_names_is_refused(tmp_path: Path) -> None:
    profile = profile_in(tmp_path, identity={"serial": "2"})
    planned = plan(FailingLink(Controller(dict(OLD))), profile, folder_with(tmp_path, NEW))
    assert planned.against == ("serial is 1, and cell is to have 2",)


def test_another_controller_than_the_journal_names_is_not_finished(tmp_path: Path) -> None:
    profile = profile_in(tmp_path / "state")
    controller = Controller(dict(OLD), fails=12, how="kill")
    with pytest.raises(Killed):
        transfer(controller, folder_with(tmp_path, NEW), profile)
    journal = journals.unfinished(profile.state_folder, profile.name)
    assert journal is not None
    (journal.folder.parent / journals.LOCK).unlink(missing_ok=True)
    controller.serial, controller.fails = "2", 0
    before = dict(controller.files)
    with pytest.raises(NotSentError, match="another controller"):
        finish(lambda profile: FailingLink(controller), profile, journal, True)
    assert controller.files == before


def test_data_that_was_altered_in_the_journal_is_not_brought(tmp_path: Path) -> None:
    from rpl.errors import UsageError

    profile = profile_in(tmp_path / "state")
    controller = Controller(dict(OLD), fails=12, how="kill")
    with pytest.raises(Killed):
        transfer(controller, folder_with(tmp_path, NEW), profile)
    journal = journals.unfinished(profile.state_folder, profile.name)
    assert journal is not None
    (journal.folder / "old" / "a.src").write_bytes(b"something else")
    (journal.folder.parent / journals.LOCK).unlink(missing_ok=True)
    controller.fails = 0
    with pytest.raises(UsageError, match="not what was kept"):
        finish(lambda profile: FailingLink(controller), profile, journal, False)


def test_a_transfer_that_was_done_is_rolled_back_while_nobody_has_changed_it(tmp_path: Path) -> None:
    profile, controller = profile_in(tmp_path / "state"), Controller(dict(OLD))
    transfer(controller, folder_with(tmp_path, NEW), profile)
    journal = journals.last_done(profile.state_folder, profile.name)
    assert journal is not None
    controller.files["b.src"] = b"touched up on the floor\n"
    with pytest.raises(NotSentError, match="changed on the controller since"):
        finish(lambda profile: FailingLink(controller), profile, journal, False)
    assert controller.files["b.src"] == b"touched up on the floor\n"
    controller.files["b.src"] = NEW["b.src"]
    finish(lambda profile: FailingLink(controller), profile, journal, False)
    assert controller.files == OLD
    assert controller.loaded == ["a.dat", "a.src"]
    assert journals.last_done(profile.state_folder, profile.name) is None


def test_every_transfer_is_in_the_log_with_hashes(tmp_path: Path) -> None:
    profile = profile_in(tmp_path / "state")
    transfer(Controller(dict(OLD)), folder_with(tmp_path, NEW), profile)
    line = json.loads((tmp_path / "state" / journals.AUDIT).read_text("utf-8"))
    assert line["what"] == "sent"
    assert line["who"]
    assert {each["name"]: each["new"] for each in line["files"]} == {
        name: journals.hash_of(data) for name, data in NEW.items()
    }


KILLED_AT = """
import os, sys
from pathlib import Path
sys.path[:0] = [{root!r}]
from tests.controllers.failing import profile_in
from rpl.controllers.folder.client import FolderLink
from rpl.controllers.planning import plan
from rpl.controllers.sending import send
count = 0
def tell(text):
    global count
    count += 1
    if count == {number}:
        os._exit(9)
link = FolderLink(Path({there!r}))
profile = profile_in(Path({state!r}))
send(link, lambda profile: link, profile, plan(link, profile, Path({folder!r}), True), tell)
"""


def test_a_process_that_is_killed_leaves_what_another_can_finish(tmp_path: Path) -> None:
    """A real process, at each step that it tells of."""
    from rpl.controllers.folder.client import FolderLink

    folder = folder_with(tmp_path, NEW)
    for number in (1, 3, 6, 8):
        there, state = tmp_path / f"there-{number}", tmp_path / f"state-{number}"
        there.mkdir()
        for name, data in OLD.items():
            (there / name).write_bytes(data)
        script = KILLED_AT.format(
            root=str(Path(__file__).parents[2]), number=number, there=str(there), state=str(state), folder=str(folder)
        )
        ended = subprocess.run([sys.executable, "-c", script], env={**os.environ}, check=False)
        assert ended.returncode == 9
        profile = profile_in(state)
        journal = journals.unfinished(state, profile.name)
        assert journal is not None
        finish(lambda profile, there=there: FolderLink(there), profile, journal, number % 2 == 0)
        assert {path.name: path.read_bytes() for path in there.iterdir()} == (AFTER if number % 2 == 0 else OLD)
