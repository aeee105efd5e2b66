"""What the memory of a virtual ABB controller holds behind loading, and what becomes of a session that nobody uses."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rpl.controllers.link import NotThereError, RefusedError
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.faults import Faults
from rpl.controllers.virtual.store import Store
from tests.controllers.hosting import Hosted, hosted

pytest.importorskip("aiohttp", reason="the extra `rws` is not installed")
pytest.importorskip("cryptography", reason="the extra `rws` is not installed")

MAIN = b'MODULE Main\r\n  PERS num kept := 1;\r\n  PROC main()\r\n    TPWrite "here";\r\n  ENDPROC\r\nENDMODULE\r\n'
POINTS = "MODULE Points\r\n  PERS num nCount := {};\r\n  PERS num {} := 5;\r\n{}ENDMODULE\r\n"


def points(count: int, name: str = "nOther", more: str = "") -> bytes:
    return POINTS.format(count, name, more).encode()


@pytest.fixture(scope="module")
def here() -> Iterator[Hosted]:
    with hosted("abb", {"Main.mod": MAIN}) as found:
        yield found


@pytest.fixture
def link(here: Hosted, tmp_path: Path) -> Iterator[Any]:
    from rpl.controllers.abb.client import connect

    profile = here.profile(tmp_path, user="Default User", given_password="robot", options={"generation": "1"})
    made = connect(profile)
    made.lock()
    try:
        yield made
    finally:
        made.unlock()
        made.close()


def value(link: Any, path: str) -> str:
    from rpl.controllers.abb.answers import checked, one

    answer = checked(link.session.get(f"/rw/rapid/symbol/data/RAPID/{path}"), path)
    return one(answer, "rap-data")["value"]


def loaded(link: Any, data: bytes) -> None:
    link.put("Points.mod", data)
    link.take_in(["Points.mod"])


def test_data_of_a_loaded_module_are_there_at_once(here: Hosted, link: Any) -> None:
    loaded(link, points(3))
    assert value(link, "T_ROB1/Points/nCount") == "3" and value(link, "T_ROB1/Points/nOther") == "5"
    here.cabinet.set_variable("Main.kept", lambda old: 7)
    here.cabinet.set_variable("Points.nCount", lambda old: 9)
    loaded(link, points(4, "nNew"))
    assert value(link, "T_ROB1/Points/nCount") == "4" and value(link, "T_ROB1/Points/nNew") == "5"
    with pytest.raises(NotThereError):
        value(link, "T_ROB1/Points/nOther")
    assert value(link, "T_ROB1/Main/kept") == "7"  # another module keeps what it has
    link.take_out(["Points.mod"])
    with pytest.raises(NotThereError):
        value(link, "T_ROB1/Points/nCount")
    assert value(link, "T_ROB1/Main/kept") == "7"


def test_where_modules_do_not_fit_together_nothing_old_is_told(link: Any) -> None:
    user = (
        b"MODULE User\r\n  PERS num nMine := 0;\r\n  PROC use()\r\n    nMine := nOther;\r\n  ENDPROC\r\nENDMODULE\r\n"
    )
    loaded(link, points(3))
    link.put("User.mod", user)
    link.take_in(["User.mod"])
    assert value(link, "T_ROB1/Points/nOther") == "5"
    loaded(link, points(3).replace(b"num nOther := 5", b'string nOther := "x"'))
    with pytest.raises(NotThereError):
        value(link, "T_ROB1/Points/nOther")
    link.take_out(["User.mod"])
    assert value(link, "T_ROB1/Points/nOther") == '"x"'
    link.take_out(["Points.mod"])


def test_without_main_data_are_told_and_nothing_starts(tmp_path: Path) -> None:
    from rpl.controllers.abb.client import connect

    lonely = points(3, more="  PROC place()\r\n  ENDPROC\r\n")
    with hosted("abb", {"Points.mod": lonely}) as here:
        profile = here.profile(tmp_path, user="Default User", given_password="robot", options={"generation": "1"})
        link = connect(profile)
        assert value(link, "T_ROB1/Points/nCount") == "3"
        assert link.session.post("/rw/rapid/execution?action=start").status == 403
        assert here.cabinet.phase == "stopped"
        link.close()


# ---- sessions


def front(time_scale: float = 1.0) -> Any:
    from rpl.controllers.abb.inside import Inside
    from rpl.controllers.abb.server import Front, Held
    from rpl.controllers.abb.subscriptions import Subscriptions

    inside = Inside(Cabinet("abb", "rapid", None, Store(Faults()), time_scale=time_scale))
    made = Front(inside.cabinet, inside, Subscriptions(inside), "rws")
    for name, began in (("old", 0.0), ("new", 1400.0)):
        made.sessions[name] = Held(began, began)
    return made


# Time scale, when the old session was used last, when one looks; which sessions are there then.
SESSIONS = [
    (1.0, 0.0, 299.0, {"old", "new"}),
    (1.0, 0.0, 301.0, {"new"}),
    (1.0, 1490.0, 1499.0, {"old", "new"}),  # used, but as old as a session may get
    (1.0, 1490.0, 1501.0, {"new"}),
    (10.0, 0.0, 29.0, {"old", "new"}),
    (10.0, 0.0, 31.0, {"new"}),
    (1000.0, 0.0, 9.0, {"old", "new"}),  # never sooner than that
]


@pytest.mark.parametrize(("scale", "used", "now", "left"), SESSIONS)
def test_a_session_ends_by_itself_and_its_mastership_is_free(
    scale: float, used: float, now: float, left: set[str]
) -> None:
    made = front(scale)
    made.sessions["old"].used = used
    made.inside.take("rapid", "old")
    made.sweep(now)
    assert set(made.sessions) == left
    assert ("rapid" in made.inside.masters) == ("old" in left)
    if "old" not in left:
        made.inside.take("rapid", "new")


def test_who_listens_keeps_the_session() -> None:
    from rpl.controllers.abb.subscriptions import Group

    made = front()
    made.subscriptions.groups[1] = Group(1, "old", (), {}, is_heard=True)
    made.subscriptions.groups[2] = Group(2, "new", (), {})
    made.sessions["new"].used = made.sessions["new"].began = 0.0
    made.sweep(2000.0)
    assert set(made.sessions) == {"old"} and set(made.subscriptions.groups) == {1}


def test_a_killed_client_holds_the_mastership_until_its_session_ends(here: Hosted, tmp_path: Path) -> None:
    from rpl.controllers.abb.client import connect

    profile = here.profile(tmp_path, user="Default User", given_password="robot", options={"generation": "1"})
    killed, other = connect(profile), connect(profile)
    killed.lock()
    killed.session.close()  # without a logout
    with pytest.raises(RefusedError, match="five minutes"):
        other.lock()
    other.close()
    again = connect(profile)
    again.session.cookies = dict(killed.session.cookies)
    again.unlock()
    again.close()
