"""Variables in numbered storage, for targets whose data has numbers and no names.

A variable becomes an element of its bank, an array consecutive elements (a chosen one through a helper number), a
constant its value. Taught points become points of the routines that use them, where the target has such. What was
declared with a value gets it at the start of the program, or of the routine. The plan of numbers is that of `banks`.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.capabilities import Bank
from rpl.passes.fold import Unchanged, constant, lasting, literal
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.labels import structure_to_labels
from rpl.passes.legalise.control.parameters import ARGUMENTS
from rpl.passes.legalise.facts.entries import INITIALISE, moving_entries
from rpl.passes.legalise.facts.liveness import Names
from rpl.passes.legalise.facts.usage import each_expression, each_statement, usage_of
from rpl.passes.legalise.facts.values.firstreads import read_first
from rpl.passes.legalise.kinds import kinds_in, walk_for
from rpl.passes.legalise.rewriting.operands import is_operand
from rpl.passes.legalise.rewriting.startdata import assigned_at_start, entries_of
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.storage.banks import (
    MIXED,
    NO_BANK,
    Numbers,
    Wanted,
    enlarged,
    fits,
    held,
    main_types,
    sizes_of,
)
from rpl.passes.legalise.storage.points import Points, poses_of_moves
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.stretches import settled
from rpl.passes.typewords import word_type
from rpl.source import NOWHERE

PERSISTENT = code(
    "persistent-set-at-start",
    Severity.INFO,
    "{name} keeps its value between runs in the source; here it is set at each start of the program",
    several="{count} values are kept between runs in the source; here each start of the program sets them: [{name}]",
)
WHOLE = code("array-as-a-whole", Severity.LOSS, "{name}: the target has no arrays that are used as a whole")
_SIMPLE = (ir.IntType, ir.RealType, ir.BoolType, ir.StringType, ir.CharType)
_ELSE = {"IntType": "RealType", "RealType": "IntType", "CharType": "StringType"}
_BESIDE = frozenset(
    ("TaskControl", "DeclareInterrupt", "ConnectInterrupt", "Trigger", "DefineTrigger", "OnError", "Search")
)
HOME = "registers"


@dataclass(frozen=True, slots=True)
class Place:
    """Where a variable is kept. `number`: its (first) number; `alone`: under a name of its own (R5)."""

    wanted: Wanted
    number: int
    alone: bool = False


@dataclass(slots=True)
class Facts:
    """What the program does with its variables, by identity of the declaration."""

    chosen: set[int] = field(default_factory=set)  # arrays with an element chosen at run time, or used whole
    counters: set[int] = field(default_factory=set)
    copied: dict[int, list[tuple[ir.ArrayType, Scope]]] = field(
        default_factory=dict
    )  # arrays stored into it as a whole


@legalising(unless=lambda context: not context.capabilities.storage.banks)
def number_data(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with banks."""
    if context.stretches and registry.target(context.target).rows:
        program = settled(program, context.stretches, context.diagnostics.items[context.before :])
        context.stretches = ()
    worker = _Numbered(program, context)
    done = worker.program()
    # Where the number of an element is computed first, its wait has become a loop.
    return structure_to_labels(done, context) if worker.made_loops else done


class _Numbered(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.unchanged: Unchanged = unchanged_in(program)
        self.facts = _facts(program, self.scopes)
        self.numbers = Numbers(context, held(program, context.capabilities.storage.banks.values()))
        self.points = Points(context, self.unchanged, poses_of_moves(program, context))
        self.places: dict[int, Place] = {}
        self.declared: list[ir.Declaration] = []
        self.start: list[ir.Statement] = []
        self.first: list[ir.Statement] = []
        self.helpers: list[ir.Expression] = []
        self.helpers_in_use = 0
        self.chosen_here: dict[tuple[tuple[tuple[ir.Expression, int], ...], int], ir.Expression] = {}
        self.larger: dict[str, Bank] = {}
        self.begins = _begins(program)
        self.planned()

    # ---- the plan

    def planned(self) -> None:
        wanted = [*self.all_wanted()]
        wanted.sort(key=lambda one: one.origin is NOWHERE)
        self.larger = enlarged(wanted, self.context)
        for one in wanted:
            one.bank = self.larger.get(one.bank.name, one.bank)
        main = main_types(wanted)
        kept = []
        for one in wanted:
            if fits(one, main[one.bank.name]) and not one.alone:
                kept.append(one)
            elif one.chosen:
                self.context.diagnostics.report(MIXED, one.origin, bank=one.bank.name, name=one.key)
            else:
                one.alone = True
                kept.append(one)
        given = self.numbers.plan(kept)
        for one in kept:
            number = given.get(id(one.declaration))
            if number is not None:
                self.places[id(one.declaration)] = Place(one, number, one.alone)
        for bank in {id(one.bank): one.bank for one in kept if not one.alone}.values():
            array = ir.ArrayType(main[bank.name], (ir.IntLiteral(bank.last),), bank.first)
            if not any(isinstance(one, ir.Variable) and one.name == bank.name for one in self.declared):
                self.declared.append(ir.Variable(bank.name, array, storage="persistent", scope="global"))
        for place in self.places.values():
            if place.alone:
                self.declare_alone(place, main[place.wanted.bank.name])

    def declare_alone(self, place: Place, main: ir.Type) -> None:
        """Numbers of a bank are of one kind, so that nothing is converted between its array and names of their own."""
        one = place.wanted
        type = main if isinstance(one.type, ir.NUMBER_TYPES) and isinstance(main, ir.NUMBER_TYPES) else one.type
        for offset in range(one.count):
            name = f"{one.bank.name}{place.number + offset}"
            self.declared.append(
                ir.Variable(name, self.type(type), storage="persistent", scope="global", label=one.element(offset))
            )

    def all_wanted(self) -> list[Wanted]:
        found: list[Wanted] = []
        names: dict[str, int] = {}
        for module in self.source.modules:
            for declaration in module.declarations:
                if isinstance(declaration, ir.Variable):
                    names[declaration.name.lower()] = names.get(declaration.name.lower(), 0) + 1
        for module in self.source.modules:
            scope = self.scopes.module(module)
            for declaration in module.declarations:
                if isinstance(declaration, ir.Variable):
                    own = f"{module.name}.{declaration.name}"
                    key = own if names[declaration.name.lower()] > 1 else declaration.name
                    self.want(found, declaration, scope, key, (own, declaration.name))
            for routine in module.routines:
                inner = self.scopes.routine(module, routine)
                for declaration in routine.declarations:
                    if isinstance(declaration, ir.Variable):
                        key = f"{routine.name}.{declaration.name}"
                        self.want(found, declaration, inner, key, (declaration.name,))
        return found

    def want(
        self, found: list[Wanted], declaration: ir.Variable, scope: Scope, key: str, aliases: tuple[str, ...]
    ) -> None:
        """Note what numbers a declaration needs; none for constants, points and the arguments of calls."""
        if declaration.name == ARGUMENTS or declaration.name in self.context.capabilities.storage.own:
            return
        type = scope.resolve(declaration.type)
        element = scope.resolve(type.element) if isinstance(type, ir.ArrayType) else type
        chosen = id(declaration) in self.facts.chosen
        if self.is_constant(declaration, element, scope, chosen):
            return
        bank = self.bank_of(element)
        if bank is None:
            if element.__class__.__name__ not in self.context.capabilities.types:
                self.context.diagnostics.report(NO_BANK, declaration.origin, name=declaration.name)
            return
        sizes = self.sizes(declaration, type, scope) if isinstance(type, ir.ArrayType) else ()
        if sizes is None:
            self.context.diagnostics.report(NO_BANK, declaration.origin, name=declaration.name)
            return
        base = type.base if isinstance(type, ir.ArrayType) else 0
        alone = id(declaration) in self.facts.counters
        made = Wanted(key, aliases, bank, element, sizes, base, declaration, declaration.origin, alone, chosen)
        found.append(made)

    def sizes(self, declaration: ir.Variable, type: ir.ArrayType, scope: Scope) -> tuple[int, ...] | None:
        """Elements in each dimension; of an open array as many as the largest that is stored into it has."""
        found = sizes_of(type, scope)
        if found is None:
            copied = [sizes_of(other, where) for other, where in self.facts.copied.get(id(declaration), ())]
            known = [one for one in copied if one is not None and len(one) == len(type.dimensions)]
            found = tuple(map(max, zip(*known, strict=True))) if known else None
        return found

    def bank_of(self, type: ir.Type) -> Bank | None:
        """The bank for a type; numbers and texts of one kind may be kept with the other."""
        banks, name = self.context.capabilities.storage.banks, type.__class__.__name__
        return banks.get(name) or banks.get(_ELSE.get(name, ""))

    def is_constant(self, declaration: ir.Variable, element: ir.Type, scope: Scope, chosen: bool) -> bool:
        """Is its value written wherever it is used, or a taught point?"""
        if chosen:
            return False
        taught = isinstance(element, ir.TargetType | ir.JointsType) and self.points.is_taught(declaration, scope)
        taught = taught or self.points.is_pose_of_moves(declaration, scope)
        if taught and self.context.capabilities.storage.points is not None:
            return True
        if isinstance(scope.resolve(declaration.type), ir.ArrayType) or declaration.storage != "constant":
            return False
        return isinstance(element, _SIMPLE) and constant(ir.Name(declaration.name), scope) is not None

    # ---- declarations and starting values

    def program(self) -> ir.Program:
        done = super().program()
        self.points.report_copies()
        if self.declared:
            modules = done.modules
            home = ir.Module(HOME, modules[0].dialect, tuple(self.declared), public=True)
            done = replace(done, modules=(*modules, home))
        self.points.begin(ir.Routine(INITIALISE))
        start = [self.with_points(one) for one in self.start]
        return assigned_at_start(done, self.context, start, tuple(self.points.declarations()))

    def with_points(self, assign: ir.Statement) -> ir.Statement:
        """Positions that data starts with are points of the routine that sets them."""
        match assign:
            case ir.Assign(value=ir.Aggregate() as value) if self.context.capabilities.storage.points is not None:
                type = word_type(value.type_name, self.scope) if value.type_name else None
                point = self.points.written(value, type)
                return assign if point is None else replace(assign, value=point)
        return assign

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        if isinstance(declaration, ir.SignalDeclaration):
            return [] if self.numbered_signal(declaration) is not None else super().declaration(declaration)
        if not isinstance(declaration, ir.Variable):
            return super().declaration(declaration)
        place = self.places.get(id(declaration))
        if place is None:
            type = self.scope.resolve(declaration.type)
            element = self.scope.resolve(type.element) if isinstance(type, ir.ArrayType) else type
            gone = self.is_constant(declaration, element, self.scope, id(declaration) in self.facts.chosen)
            return [] if gone else super().declaration(declaration)
        if declaration.initial is not None and not self.is_kept_there(declaration) and self.is_looked_at(declaration):
            self.initialised(declaration, place)
        return []

    def is_kept_there(self, declaration: ir.Variable) -> bool:
        """Data whose value nobody knows: the target's controller keeps what is stored there, as the source's does."""
        kept = declaration.storage == "persistent" and self.scope.routine_here is None
        return kept and declaration.name.lower() in self.context.unknown

    def is_looked_at(self, declaration: ir.Variable) -> bool:
        """May a run read what the declaration says, before a statement sets something else?"""
        return self.scope.routine_here is not None or declaration.name.lower() in self.begins

    def initialised(self, declaration: ir.Variable, place: Place) -> None:
        assigns = []
        origin = replace(declaration.origin, comments=())
        for offset, value in _elements(declaration.initial, len(place.wanted.sizes), place.wanted.count):
            assigns.append(ir.Assign(self.at(place, offset), self.valued(value), origin=origin))
        if self.scope.routine_here is not None and declaration.storage != "persistent":
            self.first.extend(assigns)
            return
        if declaration.storage == "persistent" and declaration.origin is not NOWHERE:
            self.context.diagnostics.report(PERSISTENT, declaration.origin, name=declaration.name)
        self.start.extend(assigns)

    def valued(self, value: ir.Expression) -> ir.Expression:
        """A starting value: a literal where it is constant."""
        if isinstance(value, ir.Aggregate):
            return value
        known = constant(value, self.scope)
        made = literal(known) if known is not None else None
        return self.expression(value) if made is None or not is_operand(made) else made

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.first, self.helpers = [], []
        self.chosen_here.clear()
        self.points.begin(routine)
        done = super().routine(module, routine)
        return replace(
            done,
            body=(*self.first, *done.body) if self.first else done.body,
            declarations=(*done.declarations, *self.points.declarations()),
        )

    # ---- uses

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Rows():
                return self.rows(statement)
            case ir.Assign(target=ir.Name(id=name), value=value):
                place = self.array(name)
                if place is not None:
                    done = self.copied(statement, place, value)
                    if done is not None:
                        return done
        return super().statement(statement)

    def rows(self, rows: ir.Rows) -> list[ir.Statement]:
        """Moves of one shape with their points; move by move where they differ in more."""
        stripped = replace(rows.sample, target=ir.Name(""))
        if self.context.capabilities.storage.points is not None and super().statement(stripped) == [stripped]:
            done = self.points.of_rows(rows, self.type_of(rows.sample.target))
            if done is not None:
                return [done]
        return [one for move in rows.moves() for one in self.placed(move)]

    def array(self, name: str) -> Place | None:
        symbol = self.scope.value(name)
        place = None if symbol is None else self.places.get(id(symbol.declaration))
        return place if place is not None and place.wanted.sizes else None

    def copied(self, statement: ir.Assign, place: Place, value: ir.Expression) -> list[ir.Statement] | None:
        """A whole array, element by element."""
        count = place.wanted.count
        if isinstance(value, ir.Aggregate):
            parts = _elements(value, len(place.wanted.sizes), count)
            return [replace(statement, target=self.at(place, at), value=self.expression(one)) for at, one in parts]
        source = self.array(value.id) if isinstance(value, ir.Name) else None
        if source is None or source.wanted.sizes[1:] != place.wanted.sizes[1:]:
            return None
        elements = range(min(count, source.wanted.count))
        return [replace(statement, target=self.at(place, at), value=self.at(source, at)) for at in elements]

    def placed(self, statement: ir.Statement) -> ir.Body:
        self.helpers_in_use = 0
        self.chosen_here.clear()
        if isinstance(statement, ir.For) and not statement.scoped:
            symbol = self.scope.value(statement.counter)
            place = None if symbol is None else self.places.get(id(symbol.declaration))
            if place is not None:
                done = super().placed(statement)
                name = f"{place.wanted.bank.name}{place.number}"
                return tuple(replace(one, counter=name) if isinstance(one, ir.For) else one for one in done)
        return super().placed(statement)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Name(id=name):
                return self.named(expression, name)
            case ir.Index(base=ir.Name(id=name), indices=indices):
                return self.indexed(expression, name, indices)
            case ir.Field() | ir.Binary() | ir.Unary():
                known = lasting(expression, self.scope)
                if isinstance(known, int | float) and not isinstance(known, bool):
                    return replace(literal(known) or expression, origin=expression.origin)
            case ir.Aggregate() if self.context.capabilities.storage.points is not None:
                point = self.inline(expression)
                if point is not None:
                    return point
        return super().expression(expression)

    def numbered_signal(self, declaration: ir.SignalDeclaration) -> ir.Signal | None:
        """The signal by its number; its name goes to the map of numbers."""
        signal = declaration.signal
        number = None if signal.index is None else constant(signal.index, self.scope)
        if not isinstance(number, int) or "SignalDeclaration" in self.context.capabilities.types:
            return None
        if signal.last is not None:
            self.context.signal_groups[declaration.name] = signal
        else:
            self.context.register_names[signal.kind, number] = declaration.name
        return signal

    def inline(self, value: ir.Aggregate) -> ir.Expression | None:
        """The point for a position that is written out where it is used."""
        return None if self.scope.routine_here is None else self.points.written(value, self.type_of(value))

    def named(self, expression: ir.Name, name: str) -> ir.Expression:
        symbol = self.scope.value(name)
        if symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration):
            return self.numbered_signal(symbol.declaration) or expression
        if symbol is None or not isinstance(symbol.declaration, ir.Variable):
            return expression
        place = self.places.get(id(symbol.declaration))
        if place is not None:
            if place.wanted.sizes:
                self.context.diagnostics.report(WHOLE, expression.origin, name=name)
                return expression
            return self.at(place, 0)
        if symbol.declaration.storage == "constant":
            known = constant(expression, self.scope)
            made = None if known is None or not isinstance(known, bool | int | float | str) else literal(known)
            if made is not None:
                return replace(made, origin=expression.origin)
        if self.context.capabilities.storage.points is not None:
            point = self.points.named(expression, symbol.declaration, self.scope)
            return expression if point is None else point
        return expression

    def indexed(self, expression: ir.Index, name: str, indices: tuple[ir.Expression, ...]) -> ir.Expression:
        symbol = self.scope.value(name)
        if symbol is None or not isinstance(symbol.declaration, ir.Variable):
            return super().expression(expression)
        place = self.places.get(id(symbol.declaration))
        if place is None:
            point = self.points.element(expression, symbol.declaration, self.scope)
            return super().expression(expression) if point is None else point
        sizes, base = place.wanted.sizes, place.wanted.base
        if len(indices) != len(sizes):
            return super().expression(expression)
        offset, terms = 0, []
        for at, index in enumerate(indices):
            stride = 1
            for size in sizes[at + 1 :]:
                stride *= size
            known = constant(index, self.scope)
            if isinstance(known, int | float) and not isinstance(known, bool):
                offset += (int(known) - base) * stride
            else:
                offset -= base * stride
                terms.append((self.expression(index), stride))
        if not terms:
            return self.at(place, offset) if 0 <= offset < place.wanted.count else super().expression(expression)
        return self.chosen(place, terms, place.number + offset)

    def chosen(self, place: Place, terms: list[tuple[ir.Expression, int]], offset: int) -> ir.Expression:
        """The element whose number is a sum of products, made in a helper where it is not a variable already."""
        bank = ir.Name(place.wanted.bank.name)
        first, stride = terms[0]
        if len(terms) == 1 and stride == 1 and offset == 0 and is_operand(first):
            return ir.Index(bank, (first,))
        known = self.chosen_here.get((tuple(terms), offset))
        if known is not None:  # the same place again in this statement
            return ir.Index(bank, (known,))
        helper = self.chosen_here[tuple(terms), offset] = self.helper()
        made: ir.Expression | None = None
        for value, factor in terms:
            product = value if factor == 1 else ir.Binary("*", value, ir.IntLiteral(factor))
            if made is None:
                made = product
            elif isinstance(product, ir.Binary):
                other = self.helper()
                self.before.append(ir.Assign(helper, made))
                self.before.append(ir.Assign(other, product))
                made = ir.Binary("+", helper, other)
            else:
                if made is not helper:
                    self.before.append(ir.Assign(helper, made))
                made = ir.Binary("+", helper, product)
        assert made is not None  # there is at least one term
        if offset:
            if not is_operand(made):
                self.before.append(ir.Assign(helper, made))
                made = helper
            made = ir.Binary("+" if offset > 0 else "-", made, ir.IntLiteral(abs(offset)))
        self.before.append(ir.Assign(helper, made))
        return ir.Index(bank, (helper,))

    def helper(self) -> ir.Expression:
        """A number that says which element; free again behind the statement."""
        if self.helpers_in_use == len(self.helpers):
            banks = self.context.capabilities.storage.banks
            kind = ir.IntType() if "IntType" in banks else ir.RealType()
            bank = banks[kind.__class__.__name__]
            bank = self.larger.get(bank.name, bank)
            routine = self.scope.routine_here
            key = f"{routine.name if routine else 'data'}.element{len(self.helpers) + 1 if self.helpers else ''}"
            wanted = Wanted(key, (), bank, kind, (), 0, ir.Variable(key, kind))
            self.numbers.needed[bank.name] += 1
            # A full bank is reported as such; even then two helpers of one statement never share a number.
            given = self.numbers.plan([wanted]).get(id(wanted.declaration), bank.last - len(self.helpers))
            self.helpers.append(ir.Index(ir.Name(bank.name), (ir.IntLiteral(given),)))
            self.declare_bank(bank.name, bank.first, bank.last, kind)
        self.helpers_in_use += 1
        return self.helpers[self.helpers_in_use - 1]

    def declare_bank(self, name: str, first: int, last: int, type: ir.Type) -> None:
        if not any(isinstance(one, ir.Variable) and one.name == name for one in self.declared):
            array = ir.ArrayType(type, (ir.IntLiteral(last),), first)
            self.declared.append(ir.Variable(name, array, storage="persistent", scope="global"))

    def at(self, place: Place, offset: int) -> ir.Expression:
        number = place.number + offset
        if place.alone:
            return ir.Name(f"{place.wanted.bank.name}{number}")
        return ir.Index(ir.Name(place.wanted.bank.name), (ir.IntLiteral(number),))


def _elements(value: ir.Expression | None, depth: int, count: int) -> list[tuple[int, ir.Expression]]:
    """A starting value by place: of an array all its elements."""
    if value is None:
        return []
    flat: list[ir.Expression] = []

    def look(one: ir.Expression, deeper: int) -> None:
        if deeper and isinstance(one, ir.Aggregate):
            for _, entry in one.entries:
                look(entry, deeper - 1)
        else:
            flat.append(one)

    look(value, depth)
    return list(enumerate(flat[:count]))


def _begins(program: ir.Program) -> Names:
    """Data of modules (folded names) whose first values a run may read, wherever a person starts it. Where something
    runs beside the program, which may look at any time, that is all data."""
    declared = (one for module in program.modules for one in module.declarations)
    named = frozenset(one.name.lower() for one in declared if isinstance(one, ir.Variable))
    if kinds_in(program) & _BESIDE or any(task.kind != "motion" for task in program.tasks):
        return named
    used = named & {node.id.lower() for node in walk_for({"Name"}, *program.modules) if isinstance(node, ir.Name)}
    changing = used & usage_of(program).assigned  # what nothing sets is read as it begins
    return (used - changing) | read_first(program, changing, entries_of(program) | moving_entries(program))


def _facts(program: ir.Program, scopes: ProgramScope) -> Facts:
    facts = Facts()
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for body in bodies(routine):
                _look(body, scope, facts)
    return facts


def _look(body: ir.Body, scope: Scope, facts: Facts) -> None:
    def declared(name: str) -> int:
        symbol = scope.value(name)
        return 0 if symbol is None else id(symbol.declaration)

    def expression(one: ir.Expression) -> None:
        match one:
            case ir.Index(base=ir.Name(id=name), indices=indices):
                if not all(constant(index, scope) is not None for index in indices):
                    facts.chosen.add(declared(name))

    def statement(one: ir.Statement) -> None:
        if isinstance(one, ir.For) and not one.scoped:
            facts.counters.add(declared(one.counter))
        match one:
            case ir.Assign(target=ir.Name(id=name), value=ir.Name(id=other)):
                symbol = scope.value(other)
                type = None if symbol is None else scope.resolve(symbol.type)
                if isinstance(type, ir.ArrayType):
                    facts.copied.setdefault(declared(name), []).append((type, scope))
        each_expression(one, expression)

    each_statement(body, statement)
