"""Other jobs: how they are called, by name, text or number; and jobs that run beside this one."""

from __future__ import annotations

import re

from rpl import ir
from rpl.reading.shapes import StatementError

from .data import Statements
from .kinds import JOINTS, TARGET
from .operands import tags_of
from .operator import Operator
from .syntax import Command, Given, Group, JobName, Operand, Word

_NUMBERED_JOB = re.compile(r"L?S\d+", re.IGNORECASE)


class Tasks(Operator):
    """Instructions about other jobs."""

    # ---- calls

    def is_text_variable(self, job: JobName) -> bool:
        """`JOB:S000`: a job named by a text, unless there is a job of that name."""
        return job.by is not None or (
            _NUMBERED_JOB.fullmatch(job.name) is not None and job.name.upper() not in self.shared.project.jobs
        )

    def arguments(self, command: Command, name: str) -> tuple[ir.Argument, ...]:
        """What is given to the job of this name, `ARGF a ARGF b` or `(a, b)`."""
        given: list[Operand] = [item.value for item in command.items if isinstance(item, Given)]
        given.extend(next((item.values for item in command.items if isinstance(item, Group)), ()))
        called = self.shared.project.jobs.get(name)
        if called is not None:  # what the job does not ask for is left out
            given = given[: called.arguments()]
        return tuple(ir.Argument(self.argument(item, name, n)) for n, item in enumerate(given, 1))

    def numbered_call(self, value: ir.Expression, arguments: tuple[ir.Argument, ...]) -> ir.Statement:
        """`CALL B000`, `CALL IG#(2)`: the job whose name is the number. M: 0 calls none, an unknown one is an alarm."""
        origin = self.origin
        if isinstance(value, ir.Signal) and value.last is None:
            raise StatementError("CALL needs JOB:NAME or a number", 0)
        cases = [ir.Case((ir.IntLiteral(0),), (), origin=origin)]
        for job in self.shared.project.jobs.values():
            if job.name.isdigit() and int(job.name):
                call = ir.CallRoutine(job.name, arguments[: job.arguments()], origin=origin)
                cases.append(ir.Case((ir.IntLiteral(int(job.name)),), (call,), origin=origin))
        alarm = ir.Message("error", ir.TextLiteral("undefined job"), origin=origin)
        return ir.Switch(value, tuple(cases), (alarm, ir.Halt(origin=origin)), origin=origin)

    def on_call(self, command: Command) -> Statements:
        job = self.needs(command, 1)[0]
        name = job.name.upper() if isinstance(job, JobName) else ""
        arguments = self.arguments(command, name)
        if not isinstance(job, JobName):
            value = self.value(job)
            if not self.is_text(value):
                return (self.numbered_call(value, arguments),)
            return (ir.CallRoutine("", arguments, value, origin=self.origin),)
        if self.is_text_variable(job):
            if job.by is not None:
                by = self.final(job.by)
            else:
                bank, number = ("LS", job.name[2:]) if job.name[0] in "Ll" else ("S", job.name[1:])
                by = self.variable(ir.Index(ir.Name(bank), (ir.IntLiteral(int(number)),), origin=self.origin))
            return (ir.CallRoutine("", arguments, by, origin=self.origin),)
        return (ir.CallRoutine(self.job_name(job.name), arguments, origin=self.origin),)

    def job_name(self, name: str) -> str:
        known = self.shared.project.jobs.get(name.upper())
        return known.name if known is not None else name

    def argument(self, operand: Operand, job: str, number: int) -> ir.Expression:
        if not self.is_position(operand):
            return self.value(operand)
        value, kind = self.position(operand)
        if kind.form in (JOINTS, TARGET) and (job, ("ARGUMENT", number)) in self.shared.project.unified:
            return self.as_target(value, kind)
        return value

    # ---- jobs beside

    def task_of(self, command: Command) -> str:
        word = next((item.text for item in command.items if isinstance(item, Word) and item.text.startswith("SUB")), "")
        return word if word not in ("", "SUB") else "SUB1"

    def on_pstart(self, command: Command) -> Statements:
        job = next((item for item in command.items if isinstance(item, JobName)), None)
        if job is None:
            raise StatementError("PSTART needs JOB:NAME", len(command.word))
        task = self.job_name(job.name)
        known = self.shared.parallel.setdefault(self.task_of(command), [])
        if task not in known:
            known.append(task)
        arguments = self.arguments(command, job.name.upper())
        return (ir.TaskControl("start", task, arguments, origin=self.origin),)

    def on_pwait(self, command: Command) -> Statements:
        """PWAIT SUBn: until the job that PSTART gave to that task has ended; any of them where there are several."""
        tasks = self.shared.parallel.get(self.task_of(command), [])
        return tuple(ir.TaskControl("join", task, origin=self.origin) for task in tasks)

    def on_tsync(self, command: Command) -> Statements:
        """TSYNC n [SNUM=m]: m tasks (two) wait here for each other. Each arrival is counted; the count that fills a
        round lets everybody of it go on."""
        number = self.needs(command, 1)[0]
        if not isinstance(number, ir.IntLiteral):
            raise StatementError("TSYNC needs a number", len(command.word))
        counts: ir.Expression = ir.IntLiteral(2)
        for tag, relation in tags_of(command.items):
            if tag == "SNUM":
                counts = self.value(relation.right)
        arrived = ir.Name(f"TSYNC{number.value}", origin=self.origin)
        mine = ir.Name("TSYNC_ROUND", origin=self.origin)
        self.shared.used.scalar(arrived.id, ir.IntType(), self.origin)
        self.used.scalar(mine.id, ir.IntType(), self.origin)
        more = ir.Binary("+", arrived, ir.IntLiteral(1), origin=self.origin)
        less = ir.Binary("-", arrived, ir.IntLiteral(1), origin=self.origin)
        done = ir.Binary("div", less, counts, origin=self.origin)
        full = ir.Binary("*", ir.Binary("+", done, ir.IntLiteral(1), origin=self.origin), counts, origin=self.origin)
        return (
            ir.Assign(arrived, more, origin=self.origin),
            ir.Assign(mine, full, origin=self.origin),
            ir.WaitUntil(ir.Binary(">=", arrived, mine, origin=self.origin), origin=self.origin),
        )
