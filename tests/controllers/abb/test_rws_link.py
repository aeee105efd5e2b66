"""The client of Robot Web Services against our virtual controller, in both generations."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rpl.controllers.link import LoginError, NotThereError, OtherControllerError, RefusedError
from rpl.controllers.vendors import vendor
from tests.controllers.hosting import hosted
from tests.controllers.serving import Served, served

pytest.importorskip("aiohttp", reason="the extra `rws` is not installed")
pytest.importorskip("cryptography", reason="the extra `rws` is not installed")

SAMPLE = Path(__file__).parents[3] / "samples/rapid/project"
MODULE = b"MODULE extra\r\n  PROC further()\r\n  ENDPROC\r\nENDMODULE\r\n"


@pytest.fixture(scope="module")
def controller(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served("abb", tmp_path_factory.mktemp("abb"), SAMPLE, "--robot", "abb_irb120_3_58") as found:
        yield found


def connected(controller: Served, folder: Path, generation: str, **more: Any) -> Any:
    from rpl.controllers.abb.client import connect

    who = {"user": "Default User", "given_password": "robot"} | more
    return connect(controller.profile(folder, options={"generation": generation}, **who))


@pytest.fixture(params=["1", "2"])
def link(request: pytest.FixtureRequest, controller: Served, tmp_path: Path) -> Iterator[Any]:
    found = connected(controller, tmp_path, request.param)
    yield found
    found.close()


def test_it_says_who_it_is_and_what_it_does(link: Any) -> None:
    identity, state = link.identity(), link.state()
    assert (identity.maker, identity.serial) == ("ABB", "20260001")
    assert identity.firmware.partition(".")[0] == {"1": "6", "2": "7"}[link.generation.number]
    assert (state.mode, state.running, state.motors_on, state.emergency_stop) == ("AUTO", False, True, False)
    assert state.program == "MainModule/main"


def test_files_are_listed_read_written_and_removed(link: Any) -> None:
    assert [one.name for one in link.files()] == ["expected.toml", "main.mod", "stations.mod", "tools.sys"]
    assert link.fetch("main.mod") == (SAMPLE / "main.mod").read_bytes()
    link.put("cell/new/extra.mod", MODULE)
    assert next((one.name, one.size) for one in link.files()) == ("cell/new/extra.mod", len(MODULE))
    assert link.fetch("cell/new/extra.mod") == MODULE
    link.delete("cell/new/extra.mod")
    with pytest.raises(NotThereError):
        link.fetch("cell/new/extra.mod")
    with pytest.raises(NotThereError):
        link.delete("cell/new/extra.mod")


def test_a_file_takes_the_place_of_another(link: Any) -> None:
    link.put("first.mod", b"old")
    link.put("first.mod.new", MODULE)
    link.rename("first.mod.new", "first.mod")
    assert link.fetch("first.mod") == MODULE
    link.delete("first.mod")
    with pytest.raises(NotThereError):
        link.fetch("first.mod.new")


def test_modules_are_loaded_under_mastership_and_replaced(link: Any) -> None:
    link.put("extra.mod", MODULE)
    with pytest.raises(RefusedError, match="mastership"):
        link.take_in(["extra.mod"])
    link.lock()
    try:
        link.take_in(["extra.mod"])
        link.take_in(["extra.mod"])
    finally:
        link.unlock()
    assert "extra" in link._modules("T_ROB1")
    link.delete("extra.mod")


def test_what_the_memory_holds_is_kept_before_it_is_replaced(link: Any, tmp_path: Path) -> None:
    link.put("extra.mod", MODULE)
    link.lock()
    try:
        link.take_in(["extra.mod"])
        taught = MODULE.replace(b"further", b"another")
        link.put("extra.mod", taught)
        link.take_in(["extra.mod"])
        assert link.memory("T_ROB1", "extra") == taught
        link.take_out(["extra.mod", "main.txt"])
        assert "extra" not in link._modules("T_ROB1")
    finally:
        link.unlock()
        link.delete("extra.mod")
    kept = sorted((tmp_path / ".rpl/memory/here/T_ROB1").iterdir())
    assert {path.read_bytes() for path in kept} >= {MODULE, taught}
    assert not [one for one in link.files() if "rpl_" in one.name]


def test_the_loader_says_what_is_wrong_with_a_text(link: Any) -> None:
    link.put("wrong.mod", b"MODULE wrong\r\n  PROC a(\r\n    MoveL ;\r\nENDMODULE\r\n")
    link.lock()
    try:
        with pytest.raises(RefusedError, match=r"wrong\.mod:\d+"):
            link.take_in(["wrong.mod"])
    finally:
        link.unlock()
    link.delete("wrong.mod")


def test_another_certificate_is_another_controller(controller: Served, tmp_path: Path) -> None:
    connected(controller, tmp_path, "2").close()
    keys = tmp_path / ".rpl/known_keys.toml"
    assert f'"tls 127.0.0.1:{controller.ports["rws2"]}" = "SHA256:' in keys.read_text(encoding="utf-8")
    keys.write_text(re.sub(r"SHA256:.", "SHA256:?", keys.read_text(encoding="utf-8")), encoding="utf-8")
    before = len(controller.told())
    with pytest.raises(OtherControllerError):
        connected(controller, tmp_path, "2")
    assert len(controller.told()) == before  # the password was not said to it


def test_only_one_is_master(controller: Served, tmp_path: Path) -> None:
    first, second = (connected(controller, tmp_path, generation) for generation in "12")
    first.lock()
    with pytest.raises(RefusedError, match="someone else"):
        second.lock()
    first.unlock()
    second.lock()
    second.close()  # what a session held is free when it ends
    first.lock()
    first.close()


@pytest.mark.parametrize("generation", ["1", "2"])
def test_nobody_comes_in_without_the_password(controller: Served, tmp_path: Path, generation: str) -> None:
    with pytest.raises(LoginError):
        connected(controller, tmp_path, generation, given_password="wrong")


TASKS = {"T_ROB1/one.mod": b"MODULE one\nENDMODULE\n", "T_ROB2/two.mod": b"MODULE two\nENDMODULE\n"}


def test_the_folder_or_the_profile_names_the_task(tmp_path: Path) -> None:
    with hosted("abb", {**TASKS, "extra.mod": MODULE}) as here:
        for tasks, name, wanted in (
            ((), "T_ROB2/two.mod", ("T_ROB2", "two")),
            (("T_ROB2",), "extra.mod", ("T_ROB2", "extra")),
            (("T_ROB2",), "T_ROB1/one.mod", ("T_ROB1", "one")),
        ):
            link = vendor("abb").connect(here.profile(tmp_path, tasks=tasks))
            link.lock()
            link.take_in([name])
            assert wanted[1] in link._modules(wanted[0])  # type: ignore[attr-defined]
            link.close()
        link = vendor("abb").connect(here.profile(tmp_path))
        with pytest.raises(RefusedError, match="T_ROB1, T_ROB2"):
            link.take_in(["extra.mod"])
        link.close()


def test_in_manual_mode_nobody_is_forced_to_give_the_mastership(tmp_path: Path) -> None:
    with hosted("abb", TASKS) as here:
        here.cabinet.mode = "manual"
        link = vendor("abb").connect(here.profile(tmp_path))
        assert link.state().mode == "MANR"
        with pytest.raises(RefusedError, match="pendant"):
            link.lock()
        link.close()
        assert not [one for one in here.cabinet.transcript.requests if "rmmp" in one.text]


@pytest.mark.parametrize("text", ["\u00fc", "\u6f22"])
def test_texts_of_the_second_generation_are_utf_8(tmp_path: Path, text: str) -> None:
    data = f"MODULE one\r\n  ! {text}\r\nENDMODULE\r\n".encode()
    with hosted("abb", {"one.modx": data}) as here:
        link = vendor("abb").connect(here.profile(tmp_path, options={"generation": "2"}))
        assert link.memory("T_ROB1", "one") == data  # type: ignore[attr-defined]
        link.close()


def test_nothing_was_started_selected_or_switched_on(controller: Served) -> None:
    assert not controller.kinds() & {"start", "select", "servo", "stop"}
    assert {"list", "read", "write", "delete", "lock", "load"} <= controller.kinds()
