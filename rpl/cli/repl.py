"""`rpl repl`: RPL statement by statement on the emulated robot.

The session is a program that grows by what is entered, run anew from its start each time: simulated time costs little,
runs are deterministic, so only what is new is shown, and `undo` is nothing but a shorter program.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import click

from rpl import ir
from rpl.cli.output import robot_named, robot_option, say
from rpl.diagnostics import Diagnostics, Severity
from rpl.errors import RplError
from rpl.proof.events import in_words
from rpl.proof.record import Happening, Record, Stretch
from rpl.source import source_from_text

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.emulator.model import RobotModel
    from rpl.project import ReadProgram
    from rpl.runtime.trace import Fault

NATIVE = "rpl"
_OPEN_BLOCK = "missing-block-end"
_PATIENCE_S = 3600.0
HELP = """\
Enter RPL statements; a block ends with its END. Each one runs at once on the emulated robot.
  EXPRESSION    show its value
  vars          every variable with its value
  where         joints and pose of the robot, and the time
  history       what was entered
  undo          take the last entry back, with all it did
  help, quit    (Ctrl-D leaves too; Ctrl-C ends what runs or is being entered, and the session goes on)"""


@dataclass(slots=True)
class Session:
    """What was entered so far, and what its run showed."""

    robot: RobotModel | None
    cell: Cell | None = None
    entries: list[str] = field(default_factory=list)
    record: Record | None = None

    def enter(self, entry: str) -> list[str] | None:
        """Run the session with one more entry and give the lines to show; None when a block is still open. An entry
        with an error or a fault is not kept."""
        read, diagnostics = self._read(entry)
        if any(item.code.name == _OPEN_BLOCK for item in diagnostics):
            return None
        errors = diagnostics.of(Severity.ERROR)
        if errors:
            value = self._value(entry)
            return [value] if value is not None else [f"{item.message}" for item in errors]
        record, fault = self._run(read)
        lines = [*_new_moves(self.record, record), *_new_happenings(self.record, record)]
        if record is not None and record.status in ("fault", "deadlock", "limit"):
            return [*lines, *_why(fault), f"{record.status}: the entry is taken back"]
        self.entries.append(entry)
        self.record = record
        return lines

    def undo(self) -> str:
        """Take the last entry back."""
        if not self.entries:
            return "nothing to undo"
        gone = self.entries.pop()
        read, _ = self._read("")
        self.record = self._run(read)[0] if self.entries else None
        return f"took back: {gone.splitlines()[0]}"

    def variables(self) -> list[str]:
        """One line per declared variable."""
        read, _ = self._read("")
        lines = []
        for module in read.program.modules:
            for declaration in module.declarations:
                if isinstance(declaration, ir.Variable):
                    lines.append(f"{declaration.name} = {self._value(declaration.name) or '(no value yet)'}")
        return lines or ["no variables yet"]

    def where(self) -> list[str]:
        """Joints, pose and time."""
        if self.robot is None:
            return ["no robot: start with --robot"]
        last = _stretches(self.record)[-1:] if self.record else []
        joints = last[0].joints if last else self.robot.home
        pose = last[0].poses[-1] if last else self.robot.forward(joints)
        x, y, z = (float(value) for value in pose[:3, 3])
        time_s = self.record.time_s if self.record else 0.0
        angles = ", ".join(f"{float(value):.3f}" for value in joints)
        return [f"joints {angles}", f"tool   {x:.3f}, {y:.3f}, {z:.3f} mm", f"time   {time_s:.3f} s"]

    def _read(self, entry: str) -> tuple[ReadProgram, Diagnostics]:
        from rpl.project import read_sources

        diagnostics = Diagnostics()
        text = "\n".join([*self.entries, entry, ""])
        return read_sources([source_from_text("session", text)], NATIVE, diagnostics), diagnostics

    def _run(self, read: ReadProgram) -> tuple[Record | None, Fault | None]:
        from rpl.proof.recording import record_of
        from rpl.simulation import run_program

        if not any(routine.name == "main" for module in read.program.modules for routine in module.routines):
            return None, None  # only declarations and routines so far
        result = run_program(read.program, self.robot, self.cell, None, _PATIENCE_S)
        return record_of(result, read.program, self.robot), result.fault

    def _value(self, expression: str) -> str | None:
        """The value of an expression as the session's next statement would see it; None when it is none."""
        if "\n" in expression.strip():
            return None
        read, diagnostics = self._read(f"MESSAGE value_text({expression.strip()})")
        if diagnostics.has_errors:
            return None
        record, _ = self._run(read)
        said = [event for event in _happenings(record) if event.kind == "message"]
        before = sum(event.kind == "message" for event in _happenings(self.record))
        return str(said[-1].value) if len(said) > before else None


def _happenings(record: Record | None) -> list[Happening]:
    if record is None:
        return []
    every = [event for happenings in record.tasks.values() for event in happenings if event.kind != "end"]
    return sorted(every, key=lambda event: event.t)


def _stretches(record: Record | None) -> list[Stretch]:
    return [stretch for motion in record.motion.values() for stretch in motion] if record else []


def _new_happenings(before: Record | None, after: Record | None) -> Iterator[str]:
    for event in _happenings(after)[len(_happenings(before)) :]:
        if event.kind == "fault":
            continue  # told with its message
        yield str(event.value) if event.kind == "message" else in_words(event)


def _why(fault: Fault | None) -> list[str]:
    """What ended the run, in the words of the fault."""
    if fault is None:
        return []
    return [line for line in f"{fault.code}: {fault.message}".splitlines() if line]


def _new_moves(before: Record | None, after: Record | None) -> Iterator[str]:
    for stretch in _stretches(after)[len(_stretches(before)) :]:
        x, y, z = (float(value) for value in stretch.poses[-1, :3, 3])
        took = float(stretch.times[-1] - stretch.times[0])
        yield f"{stretch.motion} move to {x:.3f}, {y:.3f}, {z:.3f} mm in {took:.3f} s"


@click.command("repl")
@robot_option
@click.option("--cell", metavar="F.toml", help="Surroundings: inputs over time, answers of the operator, parts.")
def command(robot: str | None, cell: str | None) -> int:
    """Try RPL statements one by one on an emulated robot. Enter `help` there for more."""
    from rpl.proof.prove import load_cell

    session = Session(robot_named(robot), load_cell(cell))
    terminal = sys.stdin.isatty()
    if terminal:
        _remember_lines()
        say("RPL on an emulated robot; help shows the commands, quit leaves")
    failed = False
    for entry in _entries(session, terminal):
        for line in entry:
            say(line)
        failed = failed or any("taken back" in line for line in entry)
    return 1 if failed and not terminal else 0


def _remember_lines() -> None:
    """Line editing and recall with the arrow keys, where the system has them."""
    try:
        import readline
    except ModuleNotFoundError:
        return
    readline.set_history_length(1000)


def _entries(session: Session, terminal: bool) -> Iterator[list[str]]:
    """Ask for lines, gather blocks, obey; gives the lines to show for each entry."""
    lines: list[str] = []
    while True:
        try:
            line = input(("  ... " if lines else "rpl> ") if terminal else "")
            lines, shown = _obeyed(session, lines, line, terminal)
        except EOFError:
            if terminal:
                say()
            return
        except KeyboardInterrupt:
            if not terminal:
                raise
            lines, shown = [], ["", "interrupted: what was not finished is taken back (quit or Ctrl-D leaves)"]
        if shown is None:
            return
        yield shown


def _obeyed(session: Session, before: list[str], line: str, terminal: bool) -> tuple[list[str], list[str] | None]:
    """One more line: the lines of a block that is still open, and what to show; None for that when it says to leave."""
    word = line.strip().lower()
    if not before and word in ("quit", "exit"):
        return [], None
    if not before and (not word or word in _COMMANDS):
        return [], _COMMANDS[word](session) if word else []
    lines = [*before, line]
    try:
        shown = session.enter("\n".join(lines))
    except RplError as error:
        shown = [str(error)]
    if shown is not None:
        return [], shown
    if terminal and not word:
        return [], ["the block was not ended: taken back"]
    return lines, []


_COMMANDS: dict[str, Callable[[Session], list[str]]] = {
    "help": lambda session: HELP.splitlines(),
    "vars": Session.variables,
    "where": Session.where,
    "history": lambda session: list(session.entries) or ["nothing was entered yet"],
    "undo": lambda session: [session.undo()],
}
