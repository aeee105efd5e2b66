"""The entry: run a program in simulated time, or step through it.

`run_program` runs to the end; `Simulation` can be stepped, stopped at lines, inspected and copied
(`copy.deepcopy(simulation)` is a snapshot that goes on by itself).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from rpl import ir
from rpl.depth import at_any_depth
from rpl.errors import RunError, UsageError
from rpl.ir.walk import bodies
from rpl.runtime.faults import ProgramError
from rpl.runtime.limits import DEFAULTS, Limits
from rpl.runtime.machine import Machine
from rpl.runtime.ports import Task
from rpl.runtime.task import ENDED
from rpl.runtime.task import Task as NewTask
from rpl.runtime.trace import Event, RunInterrupted, RunResult
from rpl.runtime.values import Member, Value

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.cell.layout import Layout
    from rpl.cell.world import World
    from rpl.emulator.model import RobotModel
    from rpl.linking.program import LinkedProgram
    from rpl.motionmodel import MotionModel

MAIN = "main"


def run_program(
    program: ir.Program,
    robot: str | RobotModel | None = None,
    cell: Cell | None = None,
    entry: str | None = None,
    max_time_s: float | None = None,
    max_statements: int | None = None,
    on_event: Callable[[Event], None] | None = None,
    limits: Limits = DEFAULTS,
    controller: str | MotionModel | None = None,
    further: Sequence[str | RobotModel] = (),
) -> RunResult:
    """Run a normalised program. Without a robot its moves take no time. A given `max_time_s` or `max_statements` stands
    in place of that of `limits`. `controller` (a language's name, `plain`, or a file) drives the robot in place of each
    language's own. `further`: the robots of the second and further motion tasks, which move at the same time.

    Raises UsageError for an unknown robot or when the entry cannot be found (the candidates are listed), RunError when
    the cell file does not fit the program, RunInterrupted for Ctrl-C. A fault inside the program is part of the result.
    """
    told = 0

    def run() -> RunResult:
        shown = 0

        def tell(event: Event) -> None:
            nonlocal told, shown
            shown += 1
            if on_event is not None and shown > told:  # a run that begins again has been told of its first events
                told = shown
                on_event(event)

        listener = tell if on_event is not None else None
        simulation = Simulation(
            program, robot, cell, entry, max_time_s, max_statements, listener, limits, controller, further
        )
        try:
            simulation.run()
        except KeyboardInterrupt:
            raise simulation.interrupted() from None
        return simulation.result()

    return at_any_depth(run)


class Simulation(Machine):
    """A program on its machine, under control. `breakpoints`: (file, line), the file without its folder. `linked`: the
    program as it was linked before, for who runs it again and again. `place`: a world that other robots share, and
    which robot of it this one is; without it a cell with bodies makes its own."""

    def __init__(
        self,
        program: ir.Program,
        robot: str | RobotModel | None = None,
        cell: Cell | None = None,
        entry: str | None = None,
        max_time_s: float | None = None,
        max_statements: int | None = None,
        on_event: Callable[[Event], None] | None = None,
        limits: Limits = DEFAULTS,
        controller: str | MotionModel | None = None,
        further: Sequence[str | RobotModel] = (),
        linked: LinkedProgram | None = None,
        place: tuple[World, str] | None = None,
    ) -> None:
        from rpl.cell import Cell as NoCell
        from rpl.controllerfiles import controller_named
        from rpl.linking import link

        if max_time_s is not None:
            if not max_time_s >= 0.0:
                raise UsageError(f"max_time_s: {max_time_s:g} is not a time in s")
            limits = replace(limits, time_s=max_time_s)
        if max_statements is not None:
            limits = replace(limits, statements=max_statements)
        if linked is None:
            asked = cell is not None and cell.assume_data
            linked = link(program, asked, cell.variables if cell is not None else ())
        self.program, program = linked, linked.program
        driven = controller_named(controller) if isinstance(controller, str) else controller
        surroundings = cell if cell is not None else NoCell()
        others = tuple(model for one in further if (model := _model(one)) is not None)
        super().__init__(linked, _model(robot), surroundings, limits, on_event, driven, others)
        self.breakpoints: set[tuple[str, int]] = set()
        self.passed: tuple[int, int] | None = None
        for declared, routine in _tasks(program, linked, entry):
            self._add(declared, routine)
        self._robots_are_driven()
        if surroundings.layout:
            self._stand_among(surroundings.layout, place)
        for task in self.tasks:
            self.ready(task)

    def _add(self, declared: ir.Task, routine: ir.Routine) -> None:
        from rpl.linking.initial import shaped
        from rpl.runtime.functions.neutral import identity
        from rpl.runtime.moves.chain import DEFAULTS

        code = self.program.code_of(routine)
        self.provide(code)
        try:
            task = NewTask(self, declared.name, len(self.tasks), declared.kind, code, declared.cyclic)
        except ProgramError as error:  # a first value of the routine's own data cannot be made
            raise RunError(f"{routine.origin.place}{routine.name}: {error.message}") from None
        for name, value in code.rules.system_defaults.items():
            task.modal[name] = Member(value) if isinstance(value, str) else value
        for name, value in self.cell.system.items():
            key = name.partition("[")[0]
            pose = ir.SYSTEM_VARIABLES[key].type in ("P", "L")
            old = identity(task) if pose else task.modal.get(key, DEFAULTS.get(key))
            task.modal[name] = shaped(old, value, f"{self.cell.path}: system.{name}")
        self.tasks.append(task)
        robots = sum(other.robot is not None for other in self.tasks)
        if declared.kind == MOTION_TASK and robots <= len(self.further):
            task.robot = self.new_robot(task)

    def _stand_among(self, layout: Layout, place: tuple[World, str] | None) -> None:
        """The bodies of the cell are around the robot."""
        from rpl.cell.world import World
        from rpl.runtime.bodies import Bodies, deeds
        from rpl.runtime.reactions import Reactions

        if place is None:
            if len(layout.robots) > 1:
                raise UsageError(f"{layout.path}: the cell has several robots: `rpl run --cell` runs them together")
            place = World(layout, self.cell.seed), layout.robot("").name
        if all(task.robot is None or task.robot.model is None for task in self.tasks):
            raise UsageError(f"{layout.path}: bodies need a robot whose moves take time: name one (--robot)")
        world, name = place
        self.reactions = Reactions(self.linked, (*self.cell.reactions, *deeds(world, name)))
        self.bodies = Bodies(self, world, name, layout.robot(name).base)

    def _robots_are_driven(self) -> None:
        """Every robot that is named has a motion task."""
        driven = sum(task.robot is not None for task in self.tasks)
        if self.further and driven <= len(self.further):
            raise UsageError(f"{len(self.further) + 1} robots are named, and the program has {driven} motion tasks")

    # ---- control

    def run(self) -> None:
        """Run to the end (or to the next breakpoint when there are any)."""
        self.run_until(None)

    def run_until(self, time_s: float | None) -> bool:
        """Run until that time, a breakpoint or the end; FALSE when the run is over."""
        self.stepping = bool(self.breakpoints)
        self._go_on()
        while not self.status and not self.paused:
            if time_s is not None and (not self.agenda or self.agenda[0][0] > time_s):
                self.now = max(self.now, time_s)
                return True
            if not self.advance():
                break
        return not self.status

    def step(self) -> bool:
        """Execute one statement of the task that is next; FALSE when the run is over."""
        self.stepping = True
        self.one_step = True
        self._go_on()
        while not self.status and not self.paused:
            if not self.advance():
                break
        self.one_step = False
        return not self.status

    one_step = False

    def _go_on(self) -> None:
        """Leave a pause: the task that was stopped in the middle of its moment runs on."""
        if self.paused and not self.status:
            self.paused = False
            for task in self.tasks:
                if task.state == "ready" and self.passed is not None and task.index == self.passed[0]:
                    task.run()

    def pauses_at(self, task: Task) -> bool:
        """Before each instruction while stepping: is this a place to stop?"""
        place = (task.index, task.statements)
        if self.passed == place:
            return False
        origin = task.frame.code.origin(task.frame.counter)
        name = origin.file.rpartition("/")[2]
        wanted = self.one_step or any(
            line == origin.line and file in (origin.file, name) for file, line in self.breakpoints
        )
        if wanted and self._starts_statement(task):
            self.passed = place
            self.paused = True
        return self.paused

    def _starts_statement(self, task: Task) -> bool:
        code, counter = task.frame.code, task.frame.counter
        return code.statements[counter][0] == counter

    @property
    def waits_outside(self) -> bool:
        """Can only another robot's machine let it go on?"""
        return not self.status and not self.agenda and not self._is_finished()

    @property
    def next_s(self) -> float:
        """When it has something to do."""
        return self.agenda[0][0] if self.agenda else self.now

    # ---- inspection

    def variable(self, name: str, task: Task | None = None) -> Value:
        """The value of a variable: a local one of the task's present routine, else a global one (`module.name`)."""
        chosen = task if task is not None else self.tasks[0]
        for key, value in self.locals(chosen):
            if key == name.lower():
                return value
        slot = self.program.variable_slot(name)
        if slot is None:
            raise UsageError(f"there is no variable {name}")
        if slot >= len(self.globals):
            self.linked.initialise(self.globals, self)
        return self.globals[slot]

    def locals(self, task: Task) -> Iterator[tuple[str, Value]]:
        """Names and values of the task's present routine."""
        frame = task.frame
        for name, (place, is_reference) in frame.code.places.items():
            value = frame.values[place] if place < len(frame.values) else None
            yield name.lower(), value.get() if is_reference and value is not None else value

    def where(self, task: Task | None = None) -> tuple[str, int]:
        """File and line of the statement that the task is at."""
        chosen = task if task is not None else self.tasks[0]
        origin = chosen.where()
        return origin.file, origin.line

    def interrupted(self) -> RunInterrupted:
        """What is left of a run that was ended from outside, perhaps in the midst of a statement."""
        self.status = "interrupted"
        places = tuple((task.name, task.where()) for task in self.tasks if task.state != ENDED)
        return RunInterrupted(self.result(), places)

    @property
    def ended(self) -> bool:
        return bool(self.status) or all(task.state == ENDED for task in self.tasks)


MOTION_TASK = "motion"


def _model(robot: str | RobotModel | None) -> RobotModel | None:
    if isinstance(robot, str):
        from rpl.emulator.model import load_robot

        return load_robot(robot)
    return robot


def _tasks(program: ir.Program, linked: LinkedProgram, entry: str | None) -> Iterator[tuple[ir.Task, ir.Routine]]:
    """The tasks to start: those of the program; where none of them moves, or an entry is asked for, the main task
    from there and the background tasks beside it (a controller's background runs whatever program is chosen)."""
    found = [(task, _routine_of(program, linked, task)) for task in program.tasks]
    if entry is None and any(task.kind == MOTION_TASK for task, _ in found):
        yield from found
        return
    beside = [(task, routine) for task, routine in found if task.kind != MOTION_TASK]
    try:
        routine = find_entry(program, linked, entry)
    except UsageError:
        if entry is not None or not beside or _startable(program, _background(program)):
            raise
    else:
        yield ir.Task(MAIN, routine.name), routine
        beside = [each for each in beside if each[1] is not routine]
    yield from beside


def _routine_of(program: ir.Program, linked: LinkedProgram, task: ir.Task) -> ir.Routine:
    found = _in_modules(program, linked, task)
    if found is None:
        raise UsageError(f"task {task.name}: there is no routine {task.entry}")
    return found


def _background(program: ir.Program) -> tuple[tuple[int, str], ...]:
    """Modules (by identity: two tasks may have modules of one name) and names of the routines that background tasks
    run: nobody starts them as the program."""
    return tuple(
        (id(module), task.entry.lower())
        for task in program.tasks
        if task.kind != MOTION_TASK
        for module in program.modules
        if _belongs(module, task, program)
    )


def _belongs(module: ir.Module, task: ir.Task, program: ir.Program) -> bool:
    """May the task begin in this module? Modules of several tasks may have one name: the task's own are meant."""
    if not task.modules or any(one.task == task.name for one in program.modules):
        return not task.modules or module.task == task.name
    return module.name in task.modules


def _in_modules(program: ir.Program, linked: LinkedProgram, task: ir.Task) -> ir.Routine | None:
    for module in program.modules:
        if not _belongs(module, task, program):
            continue
        fold = linked.scopes.module(module).fold
        for routine in module.routines:
            if fold(routine.name) == fold(task.entry):
                return routine
    return None


def find_entry(program: ir.Program, linked: LinkedProgram, entry: str | None) -> ir.Routine:
    """The routine to start with: the one asked for, else `main`, else the one named like its file, else the only one
    that nobody calls. Raises UsageError with the candidates."""
    wanted = entry or program.entry
    if wanted:
        found = (
            _foreground(program, linked, wanted)
            or linked.find_routine(wanted)
            or _any_case(program, wanted)
            or _behind_its_module(program, wanted)
        )
        if found is None:
            raise UsageError(f"there is no routine {wanted}: {_listed(_startable(program))}")
        return found[1]
    main = _foreground(program, linked, MAIN) or _any_case(program, MAIN)
    behind = _background(program)
    if main is not None and _starts(main[1]) and (id(main[0]), main[1].name.lower()) not in behind:
        return main[1]
    startable = [(m, r) for m, r in _startable(program, behind) if not _is_empty(r)]
    uncalled = [(m, r) for m, r in startable if r.name.lower() not in _called(program, r)]
    named = [(m, r) for m, r in startable if _like_its_file(m, r)]
    for group in (named, [each for each in named if each in uncalled], uncalled):
        if len(group) == 1:
            return group[0][1]
    candidates = uncalled or startable or _startable(program)
    raise UsageError(f"which routine is the program? {_listed(candidates)} (name one with --entry)")


def entry_name(program: ir.Program, entry: str | None = None) -> str | None:
    """The name of the routine that a run starts with; None when several tasks start or it cannot be told."""
    from rpl.linking import link

    if entry is None and any(task.kind == MOTION_TASK for task in program.tasks):
        return None
    try:
        return find_entry(program, link(program), entry).name
    except UsageError:
        return None


def _foreground(program: ir.Program, linked: LinkedProgram, wanted: str) -> tuple[ir.Module, ir.Routine] | None:
    """The routine of that name which no background task runs (each task of a controller may have a `main`)."""
    behind = _background(program)
    for module in program.modules:
        fold = linked.scopes.module(module).fold
        for routine in module.routines:
            if fold(routine.name) == fold(wanted) and (id(module), routine.name.lower()) not in behind:
                return module, routine
    return None


def _any_case(program: ir.Program, wanted: str) -> tuple[ir.Module, ir.Routine] | None:
    """The only routine of that name in capital or small letters, in a language that tells them apart."""
    found = [(m, r) for m in program.modules for r in m.routines if r.name.lower() == wanted.lower()]
    return found[0] if len(found) == 1 else None


def _behind_its_module(program: ir.Program, wanted: str) -> tuple[ir.Module, ir.Routine] | None:
    """The routine that is named behind its module, and that behind its task: `T_ROB1.cell.main`, for names that several
    routines have."""
    for module in program.modules:
        for routine in module.routines:
            names = (f"{module.name}.{routine.name}", f"{module.task}.{module.name}.{routine.name}")
            if wanted.lower() in (name.lower() for name in names):
                return module, routine
    return None


def _starts(routine: ir.Routine) -> bool:
    return routine.kind == "procedure" and all(parameter.optional for parameter in routine.parameters)


def _startable(program: ir.Program, without: tuple[tuple[int, str], ...] = ()) -> list[tuple[ir.Module, ir.Routine]]:
    routines = [(module, r) for module in program.modules for r in module.routines if _starts(r)]
    return [(module, r) for module, r in routines if (id(module), r.name.lower()) not in without]


def _is_empty(routine: ir.Routine) -> bool:
    """Languages whose files must begin with a routine of their name have many that do nothing."""
    return all(isinstance(statement, ir.Nothing) for statement in routine.body)


def _like_its_file(module: ir.Module, routine: ir.Routine) -> bool:
    name = routine.name.lower()
    source = routine.origin.source or module.origin.source
    return name == module.name.lower() or (source is not None and name == source.name.lower())


def _called(program: ir.Program, caller: ir.Routine) -> set[str]:
    """Names that other routines call, themselves or by a text."""
    from rpl.ir.walk import walk
    from rpl.passes.legalise.facts.values.heldtexts import named_by_texts

    names = named_by_texts(program)
    for module in program.modules:
        for routine in module.routines:
            if routine is caller:
                continue
            for node in walk(*bodies(routine)):
                match node:
                    case ir.CallRoutine(name=name) | ir.Call(name=name):
                        names.add(name.lower())
                    case ir.ConnectInterrupt(routine=name) | ir.TaskControl(task=name):
                        names.add(name.lower())
                    case ir.OnError(routine=trap) if trap is not None:
                        names.add(trap.lower())
    return names


def _listed(candidates: list[tuple[ir.Module, ir.Routine]]) -> str:
    if not candidates:
        return "there is none that can be started"
    return "candidates are " + ", ".join(routine.name for _, routine in candidates)


__all__ = ["RunError", "RunResult", "Simulation", "entry_name", "find_entry", "run_program"]
