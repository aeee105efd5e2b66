"""The kinds of all names, found by going over the project until nothing changes.

A variable's kind comes from what is assigned to it, a parameter's from the calls and its default, a function's from
what it returns. What is still unknown then takes the kind that its use asks for.
"""

from __future__ import annotations

from rpl.diagnostics import Diagnostics, Severity, code

from . import nodes
from .functions import BUILTINS, HINTS, BindError, bind, constant
from .kinds import (
    BOOL,
    HANDLE,
    INT,
    LIST,
    POSE,
    REAL,
    TEXT,
    Kind,
    field_kind,
    is_joints,
    is_number,
    joined,
    list_of,
    word_of,
)
from .nodes import Expr, Node
from .scopes import Function, Project, Symbol, statements

CHANGED = code(
    "urscript-type-changed",
    Severity.WARNING,
    "{name} holds {old} and gets {new} here",
    "the controller keeps the type of the first assignment",
)
_MOST_ROUNDS = 12
_ARITHMETIC = frozenset("+-*/%^")
_ORDER = frozenset(("<", ">", "<=", ">="))
_TELLING = (nodes.Store, nodes.Perform, nodes.Branches, nodes.Repeat, nodes.Give, nodes.Thread)


class Inference:
    """Kinds of expressions in a project."""

    def __init__(self, project: Project) -> None:
        self.project = project
        self.changed = False
        self.clashes: list[tuple[Symbol, Kind, nodes.Store]] = []
        self.telling: dict[Function, list[Node]] = {}

    # ---- the whole project

    def run(self, diagnostics: Diagnostics) -> None:
        """Find the kinds of everything; report names whose kind changes."""
        for _ in range(_MOST_ROUNDS):
            self._settle()
            if not self._take_hints():
                break
        seen: set[tuple[int, int]] = set()
        for symbol, kind, store in self.clashes:
            key = (id(symbol), store.origin.start)
            old = symbol.kind
            if key not in seen and old is not None and old.word != kind.word and not joined(old, kind)[1]:
                seen.add(key)
                diagnostics.report(CHANGED, store.origin, name=symbol.name, old=word_of(old), new=word_of(kind))

    def _settle(self) -> None:
        for _ in range(_MOST_ROUNDS):
            self.changed = False
            self.clashes.clear()
            for function in self.project.functions():
                for name, default in function.node.parameters:
                    if default is not None:
                        self.widen(function.parameters[name], self.kind(default, function))
                self.block(function)
            if not self.changed:
                return

    def _take_hints(self) -> bool:
        taken = False
        for symbol in self.project.symbols():
            if symbol.kind is None and symbol.hint is not None:
                symbol.kind = symbol.hint
                taken = True
        if not taken:
            for symbol in self.project.symbols():
                if symbol.kind == LIST:
                    symbol.kind = list_of(REAL, None)
                    taken = True
        return taken

    def widen(self, symbol: Symbol, kind: Kind | None, store: nodes.Store | None = None) -> None:
        """The symbol may hold this kind too."""
        wider, fits = joined(symbol.kind, kind)
        if not fits and store is not None and kind is not None:
            self.clashes.append((symbol, kind, store))
        if wider != symbol.kind:
            symbol.kind = wider
            self.changed = True

    # ---- statements

    def block(self, here: Function) -> None:
        """What the statements of a function tell; those that hold numbers alone tell nothing."""
        if here not in self.telling:
            self.telling[here] = [node for node in statements(here.node.body) if not self.is_silent(node, here)]
        for node in self.telling[here]:
            match node:
                case nodes.Store():
                    self.store(node, here)
                case nodes.Perform(call=call):
                    self.kind(call, here)
                case nodes.Branches(branches=branches):
                    for condition, _ in branches:
                        self.expect(condition, BOOL, here)
                case nodes.Repeat(condition=condition):
                    self.expect(condition, BOOL, here)
                case nodes.Give(value=value) if value is not None and here.kind == "thread":
                    self.kind(value, here)
                case nodes.Give(value=value) if value is not None:
                    wider, _ = joined(here.returns, self.kind(value, here))
                    here.gives = True
                    if wider != here.returns:
                        here.returns = wider
                        self.changed = True
                case nodes.Thread(handle=handle):
                    self.kind(handle, here)

    def is_silent(self, node: Node, here: Function) -> bool:
        """A call of a function of the controller with nothing but numbers and texts, as most moves are?"""
        match node:
            case nodes.Perform(call=nodes.Apply(base=None, name=name, arguments=arguments)):
                plain = all(constant(value) for _, value in arguments)
                return plain and self.project.function(name, here) is None
        return not isinstance(node, _TELLING)

    def store(self, node: nodes.Store, here: Function) -> None:
        kind = self.kind(node.value, here)
        match node.target:
            case nodes.Var(name=name):
                symbol = self.project.symbol(name, here)
                if symbol is not None:
                    self.widen(symbol, kind, node)
                    if kind is None and symbol.kind is not None:
                        self.hint(node.value, symbol.kind, here)
            case nodes.At(base=base, indices=indices):
                self.kind(node.target, here)
                symbol = self.symbol_of(base, here)
                if symbol is not None and symbol.kind is not None and symbol.kind.word == "list" and kind is not None:
                    inner: Kind | None = kind
                    for _ in indices:
                        inner = list_of(inner, None)
                    if inner is not None and (symbol.kind.element is not None or len(indices) == 1):
                        self.widen(symbol, _deepened(symbol.kind, kind, len(indices)))
            case nodes.Member():
                self.kind(node.target, here)

    def symbol_of(self, expression: Expr, here: Function) -> Symbol | None:
        return self.project.symbol(expression.name, here) if isinstance(expression, nodes.Var) else None

    def hint(self, expression: Expr, kind: Kind, here: Function) -> None:
        """What the use of an unknown name asks of it."""
        symbol = self.symbol_of(expression, here)
        if symbol is not None and symbol.kind is None and symbol.hint is None:
            symbol.hint = kind

    def expect(self, expression: Expr, kind: Kind, here: Function) -> Kind | None:
        found = self.kind(expression, here)
        if found is None:
            self.hint(expression, kind, here)
        return found

    # ---- expressions

    def kind(self, expression: Expr, here: Function) -> Kind | None:
        """The kind of an expression as far as it is known; notes what its parts are used as."""
        match expression:
            case nodes.Number(value=value):
                return INT if isinstance(value, int) else REAL
            case nodes.Text():
                return TEXT
            case nodes.Truth():
                return BOOL
            case nodes.Var(name=name):
                symbol = self.project.symbol(name, here)
                return symbol.kind if symbol is not None else None
            case nodes.PoseOf(items=items):
                for item in items:
                    if not _is_written_number(item):
                        self.expect(item, REAL, here)
                return POSE
            case nodes.ListOf(items=items):
                element: Kind | None = None
                for item in items:
                    element, _ = joined(element, self.kind(item, here))
                return list_of(element, len(items))
            case nodes.At():
                return self.element(expression, here)
            case nodes.Member(base=base, name=name):
                found = self.expect(base, HANDLE, here)
                return field_kind(found, name) if found is not None and found.word == "struct" else None
            case nodes.Sign(op="not", operand=operand):
                self.expect(operand, BOOL, here)
                return BOOL
            case nodes.Sign(operand=operand):
                found = self.expect(operand, REAL, here)
                self.whole(operand, found, here)
                return found
            case nodes.Operation():
                return self.operation(expression, here)
            case nodes.Apply():
                return self.call(expression, here)
            case nodes.Run(call=nodes.Apply(name=name)):
                function = self.project.function(name, here)
                return Kind("thread", threads=frozenset((function.name if function is not None else name,)))
        return None

    def element(self, expression: nodes.At, here: Function) -> Kind | None:
        kind = self.expect(expression.base, LIST, here)
        symbol = self.symbol_of(expression.base, here)
        for index in expression.indices:
            self.expect(index, INT, here)
            if symbol is not None and not isinstance(index, nodes.Number):
                symbol.array_use = True
            if kind is None:
                return None
            if kind.word == "pose":
                kind = REAL
            elif kind.word == "struct":
                found = [inner for _, inner in kind.fields]
                place = index.value if isinstance(index, nodes.Number) else 0
                kind = found[int(place)] if int(place) < len(found) else None
            elif kind.word == "text":
                kind = TEXT
            else:
                kind = kind.element
            symbol = None
        return kind

    def whole(self, expression: Expr, kind: Kind | None, here: Function) -> None:
        """The expression is used as a whole list."""
        symbol = self.symbol_of(expression, here)
        if symbol is not None and kind is not None and kind.word == "list":
            symbol.array_use = symbol.array_use or not is_joints(kind)

    def operation(self, expression: nodes.Operation, here: Function) -> Kind | None:
        op = expression.op
        if op in ("and", "or", "xor"):
            self.expect(expression.left, BOOL, here)
            self.expect(expression.right, BOOL, here)
            return BOOL
        left, right = self.kind(expression.left, here), self.kind(expression.right, here)
        if op in ("==", "!="):
            if left is None and right is not None:
                self.hint(expression.left, right, here)
            elif right is None and left is not None:
                self.hint(expression.right, left, here)
            return BOOL
        for side, found, other in ((expression.left, left, right), (expression.right, right, left)):
            if found is None:
                self.hint(side, TEXT if op == "+" and other is not None and other.word == "text" else REAL, here)
        return BOOL if op in _ORDER else arithmetic(op, left, right)

    # ---- calls

    def call(self, expression: nodes.Apply, here: Function) -> Kind | None:
        if expression.base is not None:
            self.expect(expression.base, HANDLE, here)
            for _, value in expression.arguments:
                self.kind(value, here)
            return None
        if expression.name == "struct":
            return Kind("struct", fields=tuple((n or "", self.kind(v, here)) for n, v in expression.arguments))
        function = self.project.function(expression.name, here)
        if function is not None:
            self.own_call(expression, function, here)
            return function.returns
        builtin = BUILTINS.get(expression.name)
        kinds = [self.kind(value, here) for _, value in expression.arguments]
        if builtin is None:
            return None
        if builtin.parameters:
            self.builtin_arguments(expression, here)
        return _special(expression, kinds, builtin.kind)

    def own_call(self, expression: nodes.Apply, function: Function, here: Function) -> None:
        names = list(function.parameters)
        place = 0
        for name, value in expression.arguments:
            wanted: str | None = name
            if name is None:
                wanted = names[place] if place < len(names) else None
                place += 1
            kind = self.kind(value, here)
            symbol = function.parameters.get(wanted) if wanted is not None else None
            if symbol is None:
                continue
            self.widen(symbol, kind)
            if kind is None and symbol.kind is not None:
                self.hint(value, symbol.kind, here)

    def builtin_arguments(self, expression: nodes.Apply, here: Function) -> None:
        builtin = BUILTINS[expression.name]
        try:
            bound = bind(builtin, expression.arguments)
        except BindError:
            return
        for parameter in builtin.parameters:
            value = bound.get(parameter.name)
            if value is None:
                continue
            kind = self.kind(value, here)
            symbol = self.symbol_of(value, here)
            if parameter.letter in "mq" and symbol is not None and is_joints(kind) and not symbol.joints_use:
                symbol.joints_use = True
            if parameter.letter == "x" or (parameter.letter == "l" and builtin.name not in _RATES):
                self.whole(value, kind, here)
            if kind is None and parameter.letter in HINTS:
                self.hint(value, HINTS[parameter.letter], here)
            elif kind is None and parameter.letter == "m":
                self.hint(value, HINTS["q" if builtin.name == "movej" else "p"], here)


def _is_written_number(expression: Expr) -> bool:
    """Most components of poses; nothing is to be found out about them."""
    inner = expression.operand if isinstance(expression, nodes.Sign) else expression
    return inner.__class__ is nodes.Number


_RATES = frozenset(("speedj", "speedl"))


def _deepened(kind: Kind, value: Kind, depth: int) -> Kind:
    """The list's kind when an element so deep inside gets a value of this kind."""
    inner = kind.element
    if depth > 1 and inner is not None and inner.word == "list":
        return Kind("list", _deepened(inner, value, depth - 1), kind.length, kind.joints)
    element, _ = joined(inner, value)
    return Kind("list", element, kind.length, kind.joints)


def _special(expression: nodes.Apply, kinds: list[Kind | None], result: Kind | None) -> Kind | None:
    """Results that depend on the arguments."""
    first = kinds[0] if kinds else None
    if expression.name == "to_num":
        return REAL
    if expression.name in ("socket_read_ascii_float", "socket_read_binary_integer") and result is not None:
        count = expression.arguments[0][1] if expression.arguments else None
        if isinstance(count, nodes.Number):  # the first element tells how many came
            return list_of(result.element, int(count.value) + 1)
    if expression.name == "normalize" and first is not None:
        return list_of(REAL, first.length)
    if expression.name in ("inv", "transpose") and first is not None:
        return first
    if expression.name == "wrench_trans":
        return list_of(REAL, 6)
    return result


def arithmetic(op: str, left: Kind | None, right: Kind | None) -> Kind | None:
    """The kind of a sum, product and so on."""
    if op == "+" and TEXT in (left, right):
        return TEXT
    lists = [kind for kind in (left, right) if kind is not None and kind.word == "list"]
    if len(lists) == 2:
        return _list_arithmetic(op, lists[0], lists[1])
    if lists:
        other = right if lists[0] is left else left
        if other is None:
            return None if _is_matrix(lists[0]) else lists[0]
        element, _ = joined(lists[0].element, other)
        return list_of(element if is_number(element) else lists[0].element, lists[0].length)
    if POSE in (left, right):
        return POSE
    if op in "/^":
        return REAL
    if left is None or right is None:
        return None
    return INT if left == INT and right == INT else REAL


def _list_arithmetic(op: str, left: Kind, right: Kind) -> Kind:
    """Lists element by element; a matrix times a list or a matrix is the product of matrices."""
    if op == "*" and _is_matrix(left):
        return right if not _is_matrix(right) or right.length is None else list_of(right.element, left.length)
    element, _ = joined(left.element, right.element)
    length = left.length if left.length is not None else right.length
    if left == LIST or right == LIST:
        length = None
    return list_of(REAL if op == "/" else element, length)


def _is_matrix(kind: Kind) -> bool:
    return kind.element is not None and kind.element.word == "list"
