"""The interactive session: statements run at once, blocks are gathered, mistakes and faults are taken back."""

import pytest

from rpl.cli.repl import Session
from rpl.emulator.model import load_robot


@pytest.fixture
def session() -> Session:
    return Session(load_robot("kuka_kr6r900sixx"))


def test_statements_values_and_variables(session: Session) -> None:
    assert session.enter("var i : int = 2") == []
    assert session.enter("i = i + 3") == []
    assert session.enter("i * 2") == ["10"]
    assert session.variables() == ["i = 5"]


def test_blocks_are_gathered_until_they_end(session: Session) -> None:
    assert session.enter("var i : int") == []
    assert session.enter("for i = 1 to 2") is None
    shown = session.enter("for i = 1 to 2\nset do[i] to on\nend for")
    assert shown == ["output do[1] becomes TRUE", "output do[2] becomes TRUE"]


def test_a_move_is_shown_and_undone(session: Session) -> None:
    before = session.where()
    (line,) = session.enter("move to joints {j1: 10, j2: -90, j3: 90, j4: 0, j5: 45, j6: 0}") or []
    assert line.startswith("joint move to ")
    assert session.where()[0].startswith("joints 10.000, -90.000")
    session.undo()
    assert session.where() == before


def test_mistakes_leave_the_session_as_it_was(session: Session) -> None:
    assert session.enter("set do[1] to on") == ["output do[1] becomes TRUE"]
    assert session.enter("set do[1] to )") not in (None, [])
    far = session.enter("move linear to {x: 9000, y: 0, z: 0, a: 0, b: 90, c: 0}") or []
    assert "taken back" in far[-1]
    assert session.entries == ["set do[1] to on"]
