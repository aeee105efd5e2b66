"""The interactive session: statements run at once, blocks are gathered, mistakes and faults are taken back."""

import pytest

from rpl.cli.main import run
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


def test_a_fault_is_told_with_its_message(session: Session) -> None:
    assert session.enter("var i : int") == []
    shown = session.enter("i = 1 DIV 0") or []
    assert shown == ["division-by-zero: division by zero (division_by_zero)", "fault: the entry is taken back"]
    (unread, last) = session.enter("move linear to {x: 9000, y: 0, z: 0, a: 0, b: 90, c: 0}") or []
    assert "reach" in unread and "taken back" in last
    waiting = session.enter("wait until di[3]") or []
    assert any("di[3]" in line for line in waiting), waiting


class Keyboard:
    """What is typed at a terminal, one line a call; an exception is raised where it stands."""

    def __init__(self, *typed: str | type[BaseException]) -> None:
        self.typed = list(typed)

    def __call__(self, prompt: str) -> str:
        if not self.typed:
            raise EOFError
        line = self.typed.pop(0)
        if isinstance(line, str):
            return line
        raise line

    def isatty(self) -> bool:
        return True


def typed(monkeypatch: pytest.MonkeyPatch, *lines: str | type[BaseException]) -> None:
    keyboard = Keyboard(*lines)
    monkeypatch.setattr("builtins.input", keyboard)
    monkeypatch.setattr("sys.stdin", keyboard)


def test_ctrl_c_takes_back_what_is_being_entered(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    typed(monkeypatch, "var i : int = 2", "for i = 1 to 3", KeyboardInterrupt, "i + 1")
    assert run(["repl"]) == 0
    out = capsys.readouterr().out
    assert "interrupted" in out and out.strip().endswith("3")


def test_ctrl_c_ends_what_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    typed(monkeypatch, "set do[1] to on", "wait 1000 s", "history")
    whole = Session.enter

    def interrupted(self: Session, entry: str) -> list[str] | None:
        if "wait" in entry:
            raise KeyboardInterrupt
        return whole(self, entry)

    monkeypatch.setattr(Session, "enter", interrupted)
    assert run(["repl"]) == 0
    out = capsys.readouterr().out
    assert "interrupted" in out and out.strip().endswith("set do[1] to on")
