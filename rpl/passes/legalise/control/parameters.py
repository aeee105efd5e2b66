"""Parameters as numbered arguments and module variables, for targets whose routines have no named parameters.

Numbers and texts that are passed by value may be numbered arguments; everything else goes through a variable of the
routine: the caller fills it, and takes back what is passed by reference.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.capabilities import Local, Parameters, RoutineRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.data.lists import sized
from rpl.passes.legalise.facts.activations import Activations
from rpl.passes.legalise.facts.effects import expressions_in, is_constant, statements_in
from rpl.passes.legalise.facts.usage import base_name, written_in
from rpl.passes.legalise.rewriting.arraycopies import array_copy
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import goes_on, inside
from rpl.passes.legalise.rewriting.places import fixed_place, is_open
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope

ARGUMENTS = "AR"
_NUMBERED = (ir.IntType, ir.RealType, ir.StringType, ir.CharType)
NOT_PASSED = code(
    "argument-not-passed",
    Severity.LOSS,
    "the arguments of {name} cannot be passed here: {reason}",
)


@dataclass(slots=True)
class _Plan:
    """How a routine gets its parameters, by folded name: a number, or a variable (with its declaration). `again`: it
    may be active twice at a time, so the variables only pass the values, and it works with copies."""

    numbers: dict[str, int] = field(default_factory=dict)
    variables: dict[str, ir.Variable] = field(default_factory=dict)
    again: bool = False


@legalising(unless=lambda context: context.capabilities.routines.parameters is Parameters.NAMES)
def fit_arguments(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without named parameters."""
    scopes = ProgramScope(program)
    sizes = ArraySizes(program, scopes)
    plans = {
        id(routine): _plan(routine, scopes.routine(module, routine), context, sizes)
        for module, routine in scopes.routines()
        if routine.parameters
    }
    if not plans:
        return program
    if (
        RoutineRule.RECURSION not in context.capabilities.routines.rules
        or Local.VARIABLES not in context.capabilities.routines.locals
    ):
        for key in Activations.of(program).recursive & plans.keys():
            plans[key].again = True
    done = edit_routines(program, context, lambda editor, routine: _Calls(editor, plans).routine(routine, plans))
    modules = []
    for old, module in zip(program.modules, done.modules, strict=True):
        made = [one for r in old.routines if id(r) in plans for one in plans[id(r)].variables.values()]
        modules.append(replace(module, declarations=(*module.declarations, *made)) if made else module)
    done = replace(done, modules=tuple(modules))
    numbered = [plan for plan in plans.values() if plan.numbers]
    return _with_argument_registers(done, context, plans) if numbered else done


def _plan(routine: ir.Routine, scope: Scope, context: Context, sizes: ArraySizes) -> _Plan:
    plan = _Plan()
    for parameter in routine.parameters:
        type = scope.resolve(parameter.type)
        key = parameter.name.lower()
        by_value = parameter.mode != "reference" and isinstance(type, _NUMBERED)
        if by_value and context.capabilities.routines.parameters is Parameters.NUMBERED:
            plan.numbers[key] = len(plan.numbers) + 1
            continue
        name = context.fresh(f"{routine.name}_{parameter.name}")
        known = sizes.largest(routine, parameter)
        if isinstance(known, ir.ArrayType) and None in known.dimensions:
            reason = f"the size of {parameter.name} differs between calls"
            context.diagnostics.report(NOT_PASSED, routine.origin, name=routine.name, reason=reason)
        plan.variables[key] = ir.Variable(name, known, scope="global" if routine.scope != "module" else "module")
    return plan


class ArraySizes:
    """Types of array parameters without a size of their own, from what is passed."""

    def __init__(self, program: ir.Program, scopes: ProgramScope) -> None:
        self.found: dict[tuple[int, str], set[ir.Type]] = {}
        self.handed: dict[tuple[int, str], set[tuple[int, str]]] = {}  # to a parameter from those of its callers
        for module, routine in scopes.routines():
            scope = scopes.routine(module, routine)
            for body in bodies(routine):
                for statement in statements_in(body):
                    match statement:
                        case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                            self.note(scope, name, arguments)
                    for one in expressions_in(statement, {"Call"}):
                        if isinstance(one, ir.Call):
                            self.note(scope, one.name, one.arguments)
        size = -1
        while size != (size := sum(map(len, self.found.values()))):
            for key, givers in self.handed.items():
                for giver in givers:
                    self.found.setdefault(key, set()).update(self.found.get(giver, ()))

    def note(self, scope: Scope, name: str, arguments: tuple[ir.Argument, ...]) -> None:
        routine = scope.routine(name)
        if routine is None:
            return
        for parameter, argument in zip(routine.parameters, arguments, strict=False):
            if not isinstance(parameter.type, ir.ArrayType):
                continue
            found = self.found.setdefault((id(routine), parameter.name.lower()), set())
            if isinstance(argument.value, ir.Name):
                symbol = scope.value(argument.value.id)
                if symbol is not None and symbol.routine is not None and is_open(symbol.type):
                    giver = (id(symbol.routine), argument.value.id.lower())
                    self.handed.setdefault((id(routine), parameter.name.lower()), set()).add(giver)
                elif symbol is not None:
                    found.add(symbol.type)
            elif isinstance(argument.value, ir.Aggregate):
                found.add(sized(parameter.type, argument.value))

    def known(self, routine: ir.Routine, parameter: ir.Parameter) -> ir.Type:
        type = parameter.type
        if not isinstance(type, ir.ArrayType) or None not in type.dimensions:
            return type
        passed = self.found.get((id(routine), parameter.name.lower()), set())
        return next(iter(passed)) if len(passed) == 1 else type

    def largest(self, routine: ir.Routine, parameter: ir.Parameter) -> ir.Type:
        """With room for each list that is passed, all of them having one dimension and a size known as a number."""
        type = self.known(routine, parameter)
        if not isinstance(type, ir.ArrayType) or type.dimensions != (None,):
            return type
        passed = self.found.get((id(routine), parameter.name.lower()), set())
        bounds = [one.dimensions[0] for one in passed if isinstance(one, ir.ArrayType) and one.base == type.base]
        known = [bound.value for bound in bounds if isinstance(bound, ir.IntLiteral)]
        return replace(type, dimensions=(ir.IntLiteral(max(known)),)) if 0 < len(passed) == len(known) else type


class _Calls(Hoister):
    """One routine: its own parameters, and the calls in it."""

    def __init__(self, editor: Editor, plans: dict[int, _Plan]) -> None:
        super().__init__(editor, self.called)
        self.plans = plans

    # ---- the routine's own side

    def routine(self, routine: ir.Routine, plans: dict[int, _Plan]) -> ir.Routine:
        done = edit_bodies(routine, self.body)
        plan = plans.get(id(routine))
        if plan is None:
            return done
        written = _written(done)
        start: list[ir.Statement] = []
        values: dict[str, ir.Expression] = {key: ir.Name(one.name) for key, one in plan.variables.items()}
        kept: list[ir.Declaration] = []
        for parameter in routine.parameters:
            key = parameter.name.lower()
            if key not in plan.numbers:
                continue
            register = self.register(parameter, plan.numbers[key])
            if key not in written:
                values[key] = register
                continue
            copy = ir.Variable(self.editor.context.fresh(parameter.name), parameter.type, scope="routine")
            kept.append(copy)
            start.append(ir.Assign(ir.Name(copy.name), register))
            values[key] = ir.Name(copy.name)
        end: list[ir.Statement] = []
        for parameter in routine.parameters if plan.again else ():
            passing = plan.variables.get(parameter.name.lower())
            if passing is None:
                continue
            copy = ir.Variable(self.editor.context.fresh(parameter.name), passing.type, scope="routine")
            kept.append(copy)
            values[parameter.name.lower()] = ir.Name(copy.name)
            start.append(ir.Assign(ir.Name(copy.name), ir.Name(passing.name)))
            if parameter.mode == "reference":
                end.append(ir.Assign(ir.Name(passing.name), ir.Name(copy.name)))
        own = tuple(
            one
            for one in done.declarations
            if not (isinstance(one, ir.Variable) and one.name.lower() in {*plan.numbers, *plan.variables})
        )
        parameters = tuple(
            replace(self.argument(p, plan.numbers[p.name.lower()]), mode="value", type=self.passed_type(p.type))
            for p in routine.parameters
            if p.name.lower() in plan.numbers
        )
        done = edit_bodies(replace(done, declarations=(*kept, *own)), lambda body: _renamed(body, values))
        if end:
            done = replace(done, body=(*_given_back(done.body, end), *(end if goes_on(done.body) else ())))
        return replace(done, parameters=parameters, body=(*start, *done.body))

    def is_text(self, parameter: ir.Parameter) -> bool:
        return isinstance(self.editor.scope.resolve(parameter.type), ir.StringType | ir.CharType)

    def register(self, parameter: ir.Parameter, number: int) -> ir.Expression:
        """An argument register; one that holds a text is a parameter with the register's name, and so has its type."""
        if self.is_text(parameter):
            return ir.Name(f"{ARGUMENTS}{number}")
        return ir.Index(ir.Name(ARGUMENTS), (ir.IntLiteral(number),))

    def argument(self, parameter: ir.Parameter, number: int) -> ir.Parameter:
        return replace(parameter, name=f"{ARGUMENTS}{number}") if self.is_text(parameter) else parameter

    def passed_type(self, type: ir.Type) -> ir.Type:
        """The type of an argument register: a target without whole numbers passes them as they are."""
        whole = isinstance(self.editor.scope.resolve(type), ir.IntType)
        return ir.RealType() if whole and "IntType" not in self.editor.capabilities.types else type

    # ---- calls

    def plan_of(self, name: str) -> _Plan | None:
        routine = self.editor.scope.routine(name)
        return None if routine is None else self.plans.get(id(routine))

    def called(self, expression: ir.Expression) -> Lowered | None:
        """A function call: its value is kept while what is passed by reference is taken back."""
        if not isinstance(expression, ir.Call):
            return None
        plan = self.plan_of(expression.name)
        if plan is None:
            return None
        before, arguments, behind = self.passed(expression.name, expression.arguments, plan)
        call = replace(expression, arguments=arguments)
        if not behind:
            return before, call
        type = self.editor.type_of(expression)
        if type is None:
            return None
        kept = self.editor.temporary("result", type)
        return (*before, ir.Assign(kept, call), *behind), kept

    def placed(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.CallRoutine(dynamic=None):
                plan = self.plan_of(statement.name)
                done = super().placed(statement)
                last = done[-1]
                if plan is None or not isinstance(last, ir.CallRoutine):
                    return done
                before, arguments, behind = self.passed(statement.name, last.arguments, plan)
                call = replace(last, arguments=arguments)
                return expansion(statement.origin, (*done[:-1], *before, call, *behind))
            case ir.CallRoutine(arguments=arguments) if arguments and self.all_numbered(len(arguments)):
                before, passed = self.simple_arguments(arguments)
                call = replace(statement, arguments=passed)
                return expansion(statement.origin, (*before, *super().placed(call)))
            case ir.CallRoutine(arguments=arguments) if arguments:
                self.refused(
                    statement,
                    statement.dynamic.value if isinstance(statement.dynamic, ir.TextLiteral) else "the call",
                    "the routine is chosen at run time",
                )
            case ir.DeclareInterrupt(action=ir.CallRoutine() as action) | ir.Trigger(action=ir.CallRoutine() as action):
                self.action(statement, action)
            case ir.Move(triggers=triggers) if triggers:
                for one in triggers:
                    if isinstance(one, ir.Trigger) and isinstance(one.action, ir.CallRoutine):
                        self.action(statement, one.action)
            case ir.TaskControl(task=task, arguments=arguments) if arguments:
                plan = self.plan_of(task)
                if plan is not None and plan.variables:
                    self.refused(statement, task, "it starts beside the program")
        return super().placed(statement)

    def all_numbered(self, count: int) -> bool:
        """Does every routine that takes so many arguments take them by value in argument registers?"""
        plans = [plan for plan in self.plans.values() if len(plan.numbers) + len(plan.variables) == count]
        return bool(plans) and not any(plan.variables for plan in plans)

    def simple_arguments(self, arguments: tuple[ir.Argument, ...]) -> tuple[ir.Body, tuple[ir.Argument, ...]]:
        """Arguments that stand in a call, and what computes them in front of it."""
        before: list[ir.Statement] = []
        done: list[ir.Argument] = []
        for argument in arguments:
            value = argument.value
            if value is not None and not _simple(value):
                kept = self.editor.temporary("argument", self.editor.type_of(value) or ir.RealType())
                before.append(ir.Assign(kept, value))
                value = kept
            done.append(replace(argument, value=value))
        return tuple(before), tuple(done)

    def action(self, statement: ir.Statement, action: ir.CallRoutine) -> None:
        plan = self.plan_of(action.name)
        if plan is not None and plan.variables and action.arguments:
            self.refused(statement, action.name, "nothing can be set in front of the call")

    def refused(self, statement: ir.Statement, name: str, reason: str) -> None:
        self.editor.context.diagnostics.report(NOT_PASSED, statement.origin, name=name, reason=reason)

    def passed(
        self, name: str, arguments: tuple[ir.Argument, ...], plan: _Plan
    ) -> tuple[ir.Body, tuple[ir.Argument, ...], ir.Body]:
        """What must run before the call, the arguments that stay, and what must run behind it."""
        routine = self.editor.scope.routine(name)
        assert routine is not None  # it has a plan
        before: list[ir.Statement] = []
        behind: list[ir.Statement] = []
        numbered: list[ir.Argument] = []
        by_name = {one.name.lower(): one for one in routine.parameters}
        for at_number, argument in enumerate(arguments):
            if not argument.name and at_number >= len(routine.parameters):  # an error of the source, reported there
                numbered.append(argument)
                continue
            parameter = by_name[argument.name.lower()] if argument.name else routine.parameters[at_number]
            if argument.value is None:
                continue
            variable = plan.variables.get(parameter.name.lower())
            if variable is None:
                value = argument.value
                if not _simple(value):
                    kept = self.editor.temporary("argument", parameter.type)
                    before.append(ir.Assign(kept, value))
                    value = kept
                numbered.append(ir.Argument(value))
                continue
            place = argument.value
            if parameter.mode == "reference" and isinstance(place, ir.Name | ir.Index | ir.Field):
                place = fixed_place(place, before, self.editor)
                behind.extend(self.copy(place, ir.Name(variable.name), variable.type, place))
            before.extend(self.copy(ir.Name(variable.name), place, variable.type, place))
        return tuple(before), tuple(numbered), tuple(behind)

    def copy(
        self, target: ir.Expression, value: ir.Expression, type: ir.Type, given: ir.Expression
    ) -> tuple[ir.Assign, ...]:
        """To or from a variable of that type; of a list that has room for more, what the given one has."""
        own = self.editor.type_of(given)
        if isinstance(type, ir.ArrayType) and isinstance(own, ir.ArrayType) and not is_open(own):
            type = replace(type, dimensions=own.dimensions)
        base = type.base if isinstance(type, ir.ArrayType) else 0
        return array_copy(target, value, type, (base, base))


def _given_back(body: ir.Body, end: list[ir.Statement]) -> ir.Body:
    """The body with these statements in front of each return."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Return):
            return expansion(statement.origin, (*end, statement))
        return (inside(statement, lambda inner: map_body(inner, change)),)

    return map_body(body, change)


def _simple(value: ir.Expression) -> bool:
    match value:
        case ir.Index(base=ir.Name(), indices=indices):
            return all(map(is_constant, indices))
    return isinstance(value, ir.Name) or is_constant(value)


def _written(routine: ir.Routine) -> set[str]:
    """Names that the routine writes, or takes apart: an argument register has no parts."""
    found = written_in(routine)
    for body in bodies(routine):
        for statement in statements_in(body):
            for one in expressions_in(statement, {"Index", "Field"}):
                if isinstance(one, ir.Index | ir.Field):
                    name = base_name(one)
                    found |= set() if name is None else {name}
    return found


def _renamed(body: ir.Body, values: dict[str, ir.Expression]) -> ir.Body:
    if not values:
        return body

    def expression(one: ir.Expression) -> ir.Expression:
        if isinstance(one, ir.Name) and one.id.lower() in values:
            return replace(values[one.id.lower()], origin=one.origin)
        return rewrite_parts(one, expression)

    def statements(inner: ir.Body) -> ir.Body:
        return tuple(map(change, inner))

    def change(statement: ir.Statement) -> ir.Statement:
        if isinstance(statement, ir.For) and isinstance(values.get(statement.counter.lower()), ir.Name):
            counter = values[statement.counter.lower()]
            assert isinstance(counter, ir.Name)
            statement = replace(statement, counter=counter.id)
        return rewrite_parts(statement, expression, statements)

    return statements(body)


def _with_argument_registers(program: ir.Program, context: Context, plans: dict[int, _Plan]) -> ir.Program:
    """A declaration for the numbered arguments, so that they have a type."""
    most = max(len(plan.numbers) for plan in plans.values())
    if any(one.name == ARGUMENTS for m in program.modules for one in m.declarations if isinstance(one, ir.Variable)):
        return program
    registers = ir.ArrayType(ir.RealType(), (ir.IntLiteral(most),))
    declared = ir.Variable(ARGUMENTS, registers, scope="global")
    return with_support(program, context, (declared,))
