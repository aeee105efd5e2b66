"""Texts for targets that build them by procedures: concatenations and formatted numbers in front of the statement.

`"part " & number_text(n, 0)` becomes one formatted write into a text variable; pure texts are copied and appended.
Where a target has text operators, templates (C-like formats, messages with %1) are taken apart instead.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import RoutineRule, TextRule
from rpl.passes.legalise.facts.effects import everything
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting import textparts
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered, Rule
from rpl.passes.legalise.rewriting.editing import Editor, expansion
from rpl.passes.legalise.rewriting.library import Library

_SPECIFICATION = re.compile(r"%(?:(%)|(\d+)?(?:\.(\d+))?l?([diufgsc]))")
_PARAMETER = re.compile(r"%([1-9])")
_DEFAULT_DECIMALS = 6
# Functions with a text as result, as procedures of the helper module that write their first parameter.
_WRITERS = {
    "text_part": "rpl_text_part",
    "text_upper": "rpl_text_upper",
    "text_lower": "rpl_text_lower",
    "text_map": "rpl_text_map",
    "from_code": "rpl_from_code",
}
_READERS = {
    "text_find_any": "rpl_text_find_any",
    "text_match": "rpl_text_match",
    "text_member": "rpl_text_member",
    "text_value": "rpl_text_value",
    "character_code": "rpl_character_code",
}
_PLACES = (ir.Name, ir.Index, ir.Field)
_NUMBERS = ("number_text", "value_text", "format")
# Any specification of a C-like format; the kinds that a formatted write knows.
_ANY_SPECIFICATION = re.compile(r"%([-+0 #]*\d*)(?:\.(\d+))?l?(.)")
_KINDS = "diufegxsc%"


class TextHoister(Hoister):
    """Hoists what a target's expressions cannot say of texts."""

    def __init__(self, editor: Editor, rule: Rule, helpers: Library) -> None:
        super().__init__(editor, rule)
        self.helpers = helpers
        self._shared: dict[str, ir.Name] = {}
        self.builds = "&" not in editor.capabilities.operators
        self.cuts = textparts.by_parts(editor.capabilities)

    # ---- concatenation

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        if (self.builds or self.cuts) and isinstance(expression, ir.Builtin) and expression.function == "value_text":
            (value,) = expression.arguments
            if isinstance(self.editor.type_of(value), ir.BoolType):
                return self.truth(value)
        if self.composed(expression):
            before, pieces = self.pieces(expression)
            text = self.editor.temporary("text", ir.StringType())
            written = self.written(text, pieces)
            if written is not None:
                return (*before, *written), text
        return super().lower(expression, lvalue)

    def placed(self, statement: ir.Statement) -> ir.Body:
        """An assignment builds its text in place where the pieces do not mention it."""
        match statement:
            case ir.Assign(target=ir.Name() as target, value=value) if self.composed(value):
                before, pieces = self.pieces(value)
                appended = bool(pieces) and pieces[0] == target
                rest = pieces[1:] if appended else pieces
                key = base_name(target)
                if not any(isinstance(one, ir.Name) and one.id.lower() == key for p in rest for one in everything(p)):
                    written = self.appended(target, rest) if appended else self.written(target, rest)
                    if written is not None:
                        return expansion(statement.origin, (*before, *written))
        return super().placed(statement)

    def truth(self, value: ir.Expression) -> Lowered:
        """The text of a BOOL: chosen by an If."""
        before, (condition,) = self.several([value], [False])
        text = self.editor.temporary("text", ir.StringType())
        choose = ir.If(
            ((condition, (ir.Assign(text, ir.TextLiteral("TRUE")),)),), (ir.Assign(text, ir.TextLiteral("FALSE")),)
        )
        return (*before, choose), text

    def composed(self, expression: ir.Expression) -> bool:
        """Is it a text that this target can only build by statements?"""
        if not self.builds:
            return False
        match expression:
            case ir.Binary(op="&"):
                return True
            case ir.Builtin(function=function) if function in _NUMBERS:
                return function not in self.editor.capabilities.functions and self._formatted(expression)
        return False

    def pieces(self, expression: ir.Expression) -> tuple[ir.Body, list[ir.Expression]]:
        """The parts of a concatenation in order, their own operands done."""
        parts = list(_flat(expression))
        inner = [one for part in parts for one in (self.shown(part) or (part,))]
        before, values = self.several(inner, [False] * len(inner))
        given = iter(values)
        done: list[ir.Expression] = []
        for part in parts:
            shown = self.shown(part)
            if shown is None or not isinstance(part, ir.Builtin):
                done.append(next(given))
                continue
            new = tuple(next(given) for _ in shown)
            kept = part.arguments
            done.append(replace(part, arguments=(*kept[:1], *new) if part.function == "format" else (*new, *kept[1:])))
        return before, done

    def shown(self, part: ir.Expression) -> tuple[ir.Expression, ...] | None:
        """The values that a formatted piece shows; None for a piece that is a text by itself."""
        if not isinstance(part, ir.Builtin) or not self._formatted(part):
            return None
        return part.arguments[1:] if part.function == "format" else part.arguments[:1]

    def _formatted(self, part: ir.Expression) -> bool:
        return isinstance(part, ir.Builtin) and part.function in _NUMBERS and self.template((part,)) is not None

    def written(self, target: ir.Name, pieces: Sequence[ir.Expression]) -> ir.Body | None:
        """Statements that put the pieces into a text."""
        if any(isinstance(piece, ir.Builtin) and piece.function in _NUMBERS for piece in pieces):
            return self.printed(target, pieces)
        if not pieces:
            return (ir.Assign(target, ir.TextLiteral("")),)
        first = pieces[0]
        start: ir.Statement = ir.Assign(target, first)
        if isinstance(self.editor.type_of(first), ir.CharType):
            start = ir.Assign(target, ir.TextLiteral(""))
            return (start, *(self.append(target, piece) for piece in pieces))
        return (start, *(self.append(target, piece) for piece in pieces[1:]))

    def appended(self, target: ir.Name, pieces: Sequence[ir.Expression]) -> ir.Body | None:
        if any(isinstance(piece, ir.Builtin) and piece.function in _NUMBERS for piece in pieces):
            text = self.editor.temporary("text", ir.StringType())
            written = self.printed(text, pieces)
            return None if written is None else (*written, self.append(target, text))
        return tuple(self.append(target, piece) for piece in pieces)

    def append(self, target: ir.Name, piece: ir.Expression) -> ir.Statement:
        return ir.Do("text_append", (target, piece))

    def printed(self, target: ir.Name, pieces: Sequence[ir.Expression]) -> ir.Body | None:
        """One formatted write."""
        if "format_into" not in self.editor.capabilities.procedures:
            return None
        made = self.template(pieces)
        if made is None:
            return None
        template, values = made
        offset = self.shared("offset", ir.IntType())
        call = ir.Do("format_into", (target, None, offset, ir.TextLiteral(template), *values))
        return (ir.Assign(target, ir.TextLiteral("")), ir.Assign(offset, ir.IntLiteral(0)), call)

    def shared(self, stem: str, type: ir.Type) -> ir.Name:
        """A variable that all formatted writes of the routine use, each for itself."""
        if stem not in self._shared:
            self._shared[stem] = self.editor.temporary(stem, type)
        return self._shared[stem]

    def template(self, pieces: Sequence[ir.Expression]) -> tuple[str, list[ir.Expression]] | None:
        """A format and its values; None when a piece has no format."""
        template, values = "", []
        for piece in pieces:
            match piece:
                case ir.TextLiteral(value=text):
                    template += text.replace("%", "%%")
                    continue
                case ir.Builtin(function="number_text", arguments=(number, ir.IntLiteral(value=decimals))):
                    whole = isinstance(self.editor.type_of(number), ir.IntType)
                    template += "%d" if whole and not decimals else f"%.{decimals}f"
                    values.append(number)
                case ir.Builtin(function="value_text", arguments=(number,)):
                    type = self.editor.type_of(number)
                    if not isinstance(type, ir.NUMBER_TYPES):
                        return None
                    template += "%d" if isinstance(type, ir.IntType) else "%g"
                    values.append(number)
                case ir.Builtin(function="format", arguments=(ir.TextLiteral(value=form), *shown)):
                    fitting = self.fitting(form, shown)
                    if fitting is None:
                        return None
                    template += fitting
                    values.extend(shown)
                case ir.Builtin(function="number_text" | "format"):
                    return None
                case _:
                    template += "%c" if isinstance(self.editor.type_of(piece), ir.CharType) else "%s"
                    values.append(piece)
        return template, values

    def fitting(self, form: str, values: Sequence[ir.Expression]) -> str | None:
        """A C-like format with the kinds that the values' types ask for; None when it cannot be said."""
        rest = list(values)

        def one(found: re.Match[str]) -> str:
            kind = found[3]
            if kind == "%":
                return "%%"
            if kind not in _KINDS or not rest:
                raise ValueError(found[0])
            type = self.editor.type_of(rest.pop(0))
            if kind in "diu" and isinstance(type, ir.RealType):
                return f"%{found[1]}.0f"
            digits = f".{found[2]}" if found[2] else ""
            return f"%{found[1]}{digits}{kind}"

        try:
            done = _ANY_SPECIFICATION.sub(one, form)
        except ValueError:
            return None
        return None if rest else done

    # ---- other functions of texts

    def text_statements(self, expression: ir.Expression) -> Lowered | None:
        """A function of texts as a helper: its texts are variables, also the one that it gives."""
        if self.cuts:
            done = self.by_helpers(expression)
            if done is not None:
                return (), done
        if not isinstance(expression, ir.Builtin) or expression.function in self.editor.capabilities.functions:
            return None
        if expression.function in _READERS and self.readable(expression.function):
            before, values = self.variables(expression.arguments)
            return before, self.helpers.call(_READERS[expression.function], *values)
        helper = _WRITERS.get(expression.function)
        if helper is None or RoutineRule.TEXT_RESULTS in self.editor.capabilities.routines.rules:
            return None
        before, values = self.variables(expression.arguments)
        text = self.editor.temporary("text", ir.StringType())
        arguments = tuple(ir.Argument(value) for value in (text, *values))
        return (*before, ir.CallRoutine(self.helpers.name(helper), arguments)), text

    def by_helpers(self, expression: ir.Expression) -> ir.Expression | None:
        """What is said of texts where they can only be cut and joined."""
        match expression:
            case ir.Index(base=base, indices=(index,)) if isinstance(self.editor.type_of(base), ir.StringType):
                return ir.Builtin("text_part", (base, index, ir.IntLiteral(1)))
            case ir.Builtin(function="number_text", arguments=(value, ir.IntLiteral(value=0))):
                if "IntType" in self.editor.capabilities.types or not self.is_fraction(value):
                    return None
                rounded = ir.Convert("round_half_away", value)
                return replace(expression, arguments=(rounded, ir.IntLiteral(0)))
            case ir.Builtin(function="number_text") if self.editor.capabilities.storage.banks:
                return self.helpers.call(textparts.NUMBER_TEXT, *expression.arguments)
            case ir.Builtin(function=function) if function in textparts.FUNCTIONS:
                if not self.has(expression):
                    return self.helpers.call(textparts.FUNCTIONS[function], *expression.arguments)
        return None

    def is_fraction(self, value: ir.Expression) -> bool:
        """May it be another number than a whole one?"""
        rounded = isinstance(value, ir.Convert) and value.how == "round_half_away"
        return not rounded and not isinstance(self.editor.type_of(value), ir.IntType)

    def has(self, call: ir.Builtin) -> bool:
        """Has the target this function, with these arguments?"""
        can = self.editor.capabilities
        if call.function == "text_find" and TextRule.FIND_FROM not in can.texts.rules:
            return call.function in can.functions and call.arguments[1:2] == (ir.IntLiteral(1),)
        return call.function in can.functions

    @property
    def reads_numbers(self) -> bool:
        """Can the helpers that read a number be said? They find where it ends and ask the target for its value."""
        return self.cuts and "text_value" in self.editor.capabilities.functions

    def parsed(self, name: str, arguments: Sequence[ir.Expression | None]) -> ir.Expression | None:
        """A number read from a text by a helper, where texts can only be cut."""
        if not self.reads_numbers or name not in ("parse_number", "parse_value") or len(arguments) != 2:
            return None
        text, target = arguments
        if text is None or target is None:
            return None
        match self.editor.type_of(target):
            case ir.IntType():
                return self.helpers.call(textparts.PARSE_WHOLE, text, target)
            case ir.RealType():
                return self.helpers.call(textparts.PARSE_REAL, text, target)
        return None

    def readable(self, function: str) -> bool:
        """Can the helper for it be said in the target?"""
        can = self.editor.capabilities
        if function == "text_value":
            return "parse_number" in can.procedures
        return not can.storage.banks and "CharType" in can.types

    def variables(self, values: Sequence[ir.Expression]) -> tuple[ir.Body, list[ir.Expression]]:
        """Texts that are passed by reference have to be variables."""
        before: list[ir.Statement] = []
        done: list[ir.Expression] = []
        for value in values:
            held = isinstance(value, _PLACES) or not isinstance(self.editor.type_of(value), ir.StringType)
            if held or (
                RoutineRule.TEXT_RESULTS in self.editor.capabilities.routines.rules
                and not isinstance(value, ir.TextLiteral)
            ):
                done.append(value)
                continue
            kept = self.editor.temporary("text", ir.StringType())
            before.append(ir.Assign(kept, value))
            done.append(kept)
        return tuple(before), done

    def text_function(self, expression: ir.Builtin) -> ir.Expression | None:
        """A function of texts in terms of others."""
        arguments = expression.arguments
        match expression.function, arguments:
            case "from_code", (ir.IntLiteral(value=code) | ir.RealLiteral(value=code),) if _printable(int(code)):
                return ir.TextLiteral(chr(int(code)))
            case "character_code", (ir.TextLiteral(value=text),) if text:
                return ir.IntLiteral(ord(text[0]))
            case "text_find", (text, start, wanted) if "text_match" in self.editor.capabilities.functions:
                # the other function says length + 1 where this one says 0
                found = ir.Builtin("text_match", (text, start, wanted))
                beyond = ir.Binary("+", ir.Builtin("text_length", (text,)), ir.IntLiteral(1))
                return ir.Binary("mod", found, beyond) if "mod" in self.editor.capabilities.operators else None
            case "message_text", (ir.TextLiteral(value=template), *values) if not self.builds:
                return self.message(template, values)
            case "format", (ir.TextLiteral(value=template), *values) if not self.builds:
                return self.from_template(template, values)
        return None

    def message(self, template: str, values: Sequence[ir.Expression]) -> ir.Expression:
        """`%1` in a message is the text of the first value."""
        pieces: list[ir.Expression] = []
        at = 0
        for found in _PARAMETER.finditer(template):
            number = int(found[1]) - 1
            if number < len(values):
                pieces.append(ir.TextLiteral(template[at : found.start()]))
                pieces.append(self.text_of(values[number]))
                at = found.end()
        pieces.append(ir.TextLiteral(template[at:]))
        return _joined(pieces)

    def text_of(self, value: ir.Expression) -> ir.Expression:
        if isinstance(self.editor.type_of(value), ir.StringType | ir.CharType):
            return value
        return ir.Builtin("value_text", (value,))

    def padded(self, piece: ir.Expression, width: int) -> ir.Expression:
        """Blanks in front, up to the width."""
        return self.helpers.call("rpl_padded", piece, ir.IntLiteral(width))

    def from_template(self, template: str, values: Sequence[ir.Expression]) -> ir.Expression | None:
        """A C-like format as a concatenation; None when it has more than plain specifications."""
        pieces: list[ir.Expression] = []
        rest = list(values)
        at = 0
        template = re.sub(r"(?<!%)% ([\d.]*[dfg])", r" %\1", template)  # a blank where there is no minus sign
        for found in _SPECIFICATION.finditer(template):
            if "%" in template[at : found.start()]:
                return None
            pieces.append(ir.TextLiteral(template[at : found.start()]))
            at = found.end()
            if found[1]:
                pieces.append(ir.TextLiteral("%"))
                continue
            if not rest or (found[2] or "").startswith("0") or (found[4] in "sc" and found[3]):
                return None
            value = rest.pop(0)
            piece: ir.Expression
            match found[4]:
                case "d" | "i" | "u":
                    piece = ir.Builtin("number_text", (value, ir.IntLiteral(0)))
                case "f":
                    decimals = int(found[3]) if found[3] else _DEFAULT_DECIMALS
                    piece = ir.Builtin("number_text", (value, ir.IntLiteral(decimals)))
                    piece = (self.by_helpers(piece) if self.cuts else None) or piece
                case "g":
                    piece = ir.Builtin("value_text", (value,))
                case _:
                    piece = value
            pieces.append(self.padded(piece, int(found[2])) if found[2] else piece)
        if "%" in template[at:]:
            return None
        pieces.append(ir.TextLiteral(template[at:]))
        return _joined(pieces)


def _printable(code: int) -> bool:
    """May the character stand in a text as it is, in any language?"""
    return 32 <= code <= 126 and chr(code) not in "\"'\\"


def _flat(expression: ir.Expression) -> Sequence[ir.Expression]:
    if isinstance(expression, ir.Binary) and expression.op == "&":
        return [*_flat(expression.left), *_flat(expression.right)]
    return [expression]


def _joined(pieces: Sequence[ir.Expression]) -> ir.Expression:
    kept = [piece for piece in pieces if piece != ir.TextLiteral("")]
    done: ir.Expression = kept[0] if kept else ir.TextLiteral("")
    for piece in kept[1:]:
        done = ir.Binary("&", done, piece)
    return done
