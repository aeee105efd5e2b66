"""Statements over the socket of interpreter mode, against a program that waits in `interpreter_mode()`."""

from __future__ import annotations

import re
import socket
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from tests.controllers.hosting import Hosted, hosted

pytest.importorskip("asyncssh", reason="the extra `ssh` is not installed")

PROGRAM = """def waits():
  global count = 3
  def twice(x):
    return 2 * x
  end
  movej([0, -1.57, -1.57, -1.57, 1.57, 0], a=10, v=3)
  interpreter_mode({arguments})
  set_standard_digital_out(7, True)
  write_output_integer_register(5, count)
  {further}
  while True:
    sync()
  end
end
"""
WAITED_S = 60.0


class Client:
    """A plain socket; one answer for each line."""

    def __init__(self, here: Hosted) -> None:
        self.stream = socket.create_connection(("127.0.0.1", here.endpoints.ports["interpreter"]), WAITED_S)
        self.file = self.stream.makefile("r", encoding="utf-8")

    def __call__(self, line: str) -> str:
        self.stream.sendall(f"{line}\n".encode())
        return self.file.readline().rstrip("\n")

    def executed(self) -> int:
        return int(self("statelastexecuted").split(":")[1])


def until(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + WAITED_S
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.005)


@contextmanager
def waiting(arguments: str = "", further: str = "") -> Iterator[tuple[Hosted, Client]]:
    """A controller whose program has come to its `interpreter_mode()`."""
    program = PROGRAM.format(arguments=arguments, further=further).encode()
    with hosted("ur", {"waits.script": program}, robot="ur5e") as here:
        assert not here.cabinet.select(["waits.script"])
        here.cabinet.start()
        until(lambda: here.cabinet.signal("interpreter_mode") is True)
        yield here, Client(here)


@pytest.fixture
def here_and_ask() -> Iterator[tuple[Hosted, Client]]:
    with waiting() as found:
        yield found


def test_without_a_program_nothing_is_taken() -> None:
    with hosted("ur", {}, robot="ur5e") as here:
        ask = Client(here)
        assert ask("movej([0, 0, 0, 0, 0, 0])").startswith("discard: ")
        assert ask("statelastinterpreted") == "state: 0: statelastinterpreted"


def test_statements_run_one_by_one_with_the_program_s_own(here_and_ask: tuple[Hosted, Client]) -> None:
    here, ask = here_and_ask
    assert ask("set_standard_digital_out(1, True)") == "ack: 1: set_standard_digital_out(1, True)"
    assert ask("x = twice(count)") == "ack: 2: x = twice(count)"
    assert ask("count = count + x") == "ack: 3: count = count + x"
    assert ask("movej([0.1, -1.57, -1.57, -1.57, 1.57, 0], a=10, v=3)").startswith("ack: 4: ")
    assert ask("set_standard_digital_out(2, count == 9)").startswith("ack: 5: ")
    until(lambda: here.cabinet.signal("do3") is True)
    assert ask("statelastinterpreted") == "state: 5: statelastinterpreted"
    assert ask("statelastexecuted") == "state: 5: statelastexecuted"
    assert ask("stateunexecuted") == "state: 0: stateunexecuted"
    assert here.cabinet.signal("do2") is True and not here.cabinet.signal("do8")
    assert here.cabinet.joints is not None and here.cabinet.joints[0] == pytest.approx(5.7296, abs=1e-3)
    assert ask("end_interpreter()") == "ack: 6: end_interpreter()"
    until(lambda: _register(here) == 9)
    assert here.cabinet.signal("do8") is True
    assert ask("statelastcleared") == "state: 6: statelastcleared"


def _register(here: Hosted) -> object:
    from rpl.controllers.ur.registers import OUTPUT, REGISTERS

    return REGISTERS[OUTPUT]["output_int_register_5"].value(here.cabinet)


def test_what_cannot_be_read_is_discarded_with_the_reason(here_and_ask: tuple[Hosted, Client]) -> None:
    _, ask = here_and_ask
    for wrong in ("movej(", "movej(1, 2, 3, 4, 5, 6, 7)", "nobody()", "y = nothing + 1"):
        said = ask(wrong)
        assert said.startswith("discard: ") and said.endswith(f": {wrong}")
    assert ask("x = 1") == "ack: 1: x = 1"


def test_a_function_and_a_block_on_one_line(here_and_ask: tuple[Hosted, Client]) -> None:
    here, ask = here_and_ask
    assert ask("def on(n): set_standard_digital_out(n, True) end").startswith("ack: 1: ")
    assert ask("i = 2").startswith("ack: 2: ")
    assert ask("while i < 5: on(i) i = i + 1 end").startswith("ack: 3: ")
    until(lambda: ask.executed() == 3 and here.cabinet.signal("do5") is True)
    assert [bool(here.cabinet.signal(f"do{n}")) for n in range(1, 8)] == [False, False, True, True, True, False, False]


def test_what_was_defined_is_cleared(here_and_ask: tuple[Hosted, Client]) -> None:
    here, ask = here_and_ask
    ask("def on(): set_standard_digital_out(0, True) end")
    assert ask("clear_interpreter()") == "ack: 2: clear_interpreter()"
    assert ask("set_standard_digital_out(3, True)").startswith("ack: 3: ")  # taken when it has been cleared
    assert ask("statelastcleared") == "state: 2: statelastcleared"
    until(lambda: here.cabinet.signal("do4") is True)
    assert ask("on()").startswith("discard: ")  # nobody knows it any more
    assert not here.cabinet.signal("do1")


def test_what_waits_can_be_skipped_and_a_move_aborted(here_and_ask: tuple[Hosted, Client]) -> None:
    here, ask = here_and_ask
    ask("movej([2.0, -1.57, -1.57, -1.57, 1.57, 0], a=1, v=0.1)")
    ask("set_standard_digital_out(4, True)")
    ask("set_standard_digital_out(5, True)")
    until(lambda: here.cabinet.joints is not None and here.cabinet.joints[0] > 0.01)
    assert (ask.executed(), ask("stateunexecuted")) == (1, "state: 2: stateunexecuted")
    assert ask("skipbuffer").startswith("ack: ")
    assert ask("abort").startswith("ack: ")
    until(lambda: not here.cabinet.is_within)
    assert here.cabinet.joints is not None and here.cabinet.joints[0] < 100.0
    assert not here.cabinet.signal("do5") and not here.cabinet.signal("do6")
    assert ask("set_standard_digital_out(6, True)").startswith("ack: 4: ")
    until(lambda: here.cabinet.signal("do7") is True)


@pytest.mark.parametrize(
    ("arguments", "taken"),
    [("", False), ("clearQueueOnEnter=True", False), ("clearQueueOnEnter=False", True), ("False, True", True)],
)
def test_what_came_before_the_mode(arguments: str, taken: bool) -> None:
    again = f"while get_standard_digital_in(0) == False:\n    sync()\n  end\n  interpreter_mode({arguments})"
    with waiting(further=again) as (here, ask):
        ask("end_interpreter()")
        until(lambda: here.cabinet.signal("do8") is True)
        assert ask("set_standard_digital_out(1, True)").startswith("ack: ")  # the program runs, and does not wait
        here.cabinet.set_signal("di1", True)
        until(lambda: here.cabinet.signal("interpreter_mode") is True)
        ask("set_standard_digital_out(2, True)")
        until(lambda: here.cabinet.signal("do3") is True)
        assert bool(here.cabinet.signal("do2")) is taken


@pytest.mark.parametrize(("arguments", "stays"), [("", False), ("clearOnEnd=False", True), ("True, False", True)])
def test_what_stays_behind_the_mode(arguments: str, stays: bool) -> None:
    with waiting(arguments, "interpreter_mode()") as (here, ask):
        ask("x = 4")
        ask("end_interpreter()")
        until(lambda: here.cabinet.signal("do8") is True and here.cabinet.signal("interpreter_mode") is True)
        assert ask("set_standard_digital_out(2, x == 4)").startswith("ack: " if stays else "discard: ")
        assert ask("set_standard_digital_out(3, True)").startswith("ack: ")
        until(lambda: here.cabinet.signal("do4") is True)
        assert bool(here.cabinet.signal("do3")) is stays


def test_a_fault_in_a_statement_ends_the_program(here_and_ask: tuple[Hosted, Client]) -> None:
    here, ask = here_and_ask
    assert ask("movej([9, 9, 9, 9, 9, 9])").startswith("ack: ")
    until(lambda: here.cabinet.phase == "stopped")
    assert here.cabinet.messages
    assert ask("x = 1").startswith("discard: ")


def test_the_mode_is_entered_from_the_secondary_port_too() -> None:
    """As clients do that have no program on the controller: one line there, statements here, answers by the pattern of
    the client in Universal Robots' article."""
    pattern = re.compile(r"(\w+):\W+(\d+)?")
    with hosted("ur", {}, robot="ur5e") as here:
        with socket.create_connection(("127.0.0.1", here.endpoints.ports["secondary"]), WAITED_S) as secondary:
            secondary.sendall(b"interpreter_mode(clearQueueOnEnter = True, clearOnEnd = True)\n")
            until(lambda: here.cabinet.signal("interpreter_mode") is True)
        ask = Client(here)
        said = [ask(line) for line in ("q = [0.1, -1.57, -1.57, -1.57, 1.57, 0]", "movej(q, a=10, v=3)")]
        assert [found[1] + str(found[2]) for one in said if (found := pattern.match(one))] == ["ack1", "ack2"]
        until(lambda: ask.executed() == 2 and not here.cabinet.is_within)
        assert here.cabinet.joints is not None and here.cabinet.joints[0] == pytest.approx(5.7296, abs=1e-3)
        ask("end_interpreter()")
        until(lambda: here.cabinet.phase == "stopped")
