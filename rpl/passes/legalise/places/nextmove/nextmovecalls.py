"""Settings for the next move in front of a call of a routine that moves, for targets without such settings.

The routine is called in a form of its own that begins with the settings, so that the move they count for is found
inside of it. Only settings of fixed value go there, and no routine that keeps data between calls or calls itself.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.capabilities import MoveSetting
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.activations import Activations, called
from rpl.passes.legalise.facts.effects import blocks, statements_in
from rpl.passes.legalise.facts.entries import never_called
from rpl.passes.legalise.places.nextmove.nextmove import fixed_setting, moves, set_at_move
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside, leaves
from rpl.passes.legalise.stages import legalising

# Calls in calls that a setting goes through.
_DEEPEST = 6


@legalising(
    unless=lambda context: (
        context.capabilities.settings.next_move
        and (not context.capabilities.settings.of_moves & {MoveSetting.SPEED, MoveSetting.BLEND})
    )
)
def next_moves_behind_calls(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose moves say what is set for one move."""
    can = context.capabilities
    if not any(set_at_move(one, can) for module in program.modules for one in _every(*module.routines)):
        return program
    before = never_called(program)
    for _ in range(_DEEPEST):
        forms = _Forms(program, context)
        done = edit_routines(program, context, forms.routine)
        if not forms.made:
            break
        program = forms.added(done)
    return _without(program, never_called(program) - before)


def _every(*routines: ir.Routine) -> list[ir.Statement]:
    return [one for routine in routines for body in bodies(routine) for one in statements_in(body)]


class _Forms:
    """One round. `made`: the forms of routines, by the routine's identity and what is set."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        self.context = context
        self.facts = Activations.of(program)
        own = {key for key, routine in self.facts.routines.items() if any(map(moves, _every(routine)))}
        self.movers = {key for key in self.facts.routines if self.facts.reached({key}) & own}
        self.made: dict[tuple[int, str], tuple[ir.Routine, ir.Routine]] = {}

    def routine(self, editor: Editor, routine: ir.Routine) -> ir.Routine:
        def body(statements: ir.Body) -> ir.Body:
            return self.straight(map_body(statements, nested), editor)

        def nested(statement: ir.Statement) -> ir.Body:
            return (inside(statement, body),) if blocks(statement) else (statement,)

        if not any(set_at_move(one, editor.capabilities) for one in _every(routine)):
            return routine
        return edit_bodies(routine, body)

    def straight(self, body: ir.Body, editor: Editor) -> ir.Body:
        """The statements of one level: what is set in front of a call is set in the routine."""
        done: list[ir.Statement] = []
        waiting: list[int] = []
        for statement in body:
            if set_at_move(statement, editor.capabilities):
                assert isinstance(statement, ir.SetForNextMove)
                waiting = [*waiting, len(done)] if fixed_setting(statement) else []
            elif isinstance(statement, ir.CallRoutine) and waiting:
                given = tuple(one for at in waiting if isinstance(one := done[at], ir.SetForNextMove))
                form = self.form(statement, given, editor)
                if form is not None:
                    for at in waiting:
                        done[at] = ir.Nothing(origin=done[at].origin)
                    statement = replace(statement, name=form.name)
                    waiting = []
                elif self.moves(statement, editor):
                    waiting = []
            elif (
                moves(statement)
                or blocks(statement)
                or leaves(statement)
                or isinstance(statement, ir.Label)
                or self.moves(statement, editor)
            ):
                waiting = []
            done.append(statement)
        return tuple(one for one in done if not isinstance(one, ir.Nothing) or one.origin.comments or one in body)

    def moves(self, statement: ir.Statement, editor: Editor) -> bool:
        return any(id(one) in self.movers for one in called(statement, editor.scope))

    def form(self, call: ir.CallRoutine, given: tuple[ir.SetForNextMove, ...], editor: Editor) -> ir.Routine | None:
        """The called routine with the settings in front; None where it is another question or has no such form."""
        found = called(call, editor.scope)
        routine = editor.scope.routine(call.name) if call.dynamic is None else None
        if routine is None or id(routine) not in self.movers or id(routine) in self.facts.recursive:
            return None
        if any(one is not routine and id(one) in self.movers for one in found) or not routine.body:
            return None
        if any(isinstance(one, ir.Variable) and one.storage != "variable" for one in routine.declarations):
            return None
        key = id(routine), repr([(one.setting, one.value) for one in given])
        if key not in self.made:
            name = self.context.fresh(f"{routine.name}_next")
            settings = tuple(replace(one, origin=replace(one.origin, comments=())) for one in given)
            self.made[key] = routine, replace(routine, name=name, body=(*settings, *routine.body))
        return self.made[key][1]

    def added(self, program: ir.Program) -> ir.Program:
        """The program with the new forms, each behind the routine it comes from."""
        by_name: dict[str, list[ir.Routine]] = {}
        for routine, form in self.made.values():
            by_name.setdefault(routine.name.lower(), []).append(form)
        modules = tuple(
            replace(
                module,
                routines=tuple(one for each in module.routines for one in (each, *by_name.get(each.name.lower(), ()))),
            )
            for module in program.modules
        )
        return replace(program, modules=modules)


def _without(program: ir.Program, names: set[str]) -> ir.Program:
    """The program without routines that were called only behind settings."""
    if not names:
        return program
    modules = tuple(
        replace(module, routines=tuple(one for one in module.routines if one.name.lower() not in names))
        for module in program.modules
    )
    return replace(program, modules=modules)


__all__ = ["next_moves_behind_calls"]
