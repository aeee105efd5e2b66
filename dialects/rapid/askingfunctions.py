"""Questions to the operator that are functions (UIMessageBox, UINumEntry, UIAlphaEntry): dialogs in front of their use.

The key pressed becomes the number the controller gives for it. What reads a condition's right side only sometimes, or
has an option without a neutral form, stays a call of the controller's own. Source: reference manual, those functions.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import walk
from rpl.passes.capabilities import Capabilities, NameRules, Places, Settings
from rpl.passes.legalise.context import Context, names_in
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.rewrite import rewrite_parts
from rpl.source import NOWHERE, Origin

from .dialogs import Options, keys_asked, shown
from .types import NUM

_LOOKS = frozenset(("wrap", "icon", "image", "header", "message", "msgarray", "defaultbtn"))
_KNOWN = {
    "uimessagebox": _LOOKS | {"buttons", "btnarray", "maxtime"},
    "uinumentry": _LOOKS | {"initvalue", "minvalue", "maxvalue", "asinteger", "maxtime"},
    "uidnumentry": _LOOKS | {"initvalue", "minvalue", "maxvalue", "asinteger", "maxtime"},
    "uialphaentry": _LOOKS | {"initstring", "maxtime"},
}
_TYPES: dict[str, ir.Type] = {**dict.fromkeys(_KNOWN, NUM), "uialphaentry": ir.StringType()}
_NOTHING: frozenset[str] = frozenset()
# Reading asks for no target; the rewriting only needs names that are free.
_NO_TARGET = Capabilities(
    statements=_NOTHING,
    functions=_NOTHING,
    procedures=_NOTHING,
    system_variables=_NOTHING,
    operators=_NOTHING,
    types=_NOTHING,
    names=NameRules(32, False, _NOTHING),
    places=Places("rapid"),
    settings=Settings(modal=False),
)


def with_dialogs(program: ir.Program, own: frozenset[str], diagnostics: Diagnostics) -> ir.Program:
    """The program with statements for these functions. `own`: routines of the project, in lower case."""
    wanted = frozenset(_KNOWN) - own
    if not any(isinstance(node, ir.Call) and node.name.lower() in wanted for node in walk(*program.modules)):
        return program
    context = Context("rapid", "rapid", _NO_TARGET, diagnostics, taken=names_in(program))
    return _Dialogs(program, context, wanted).program()


class _Dialogs(Rewriter):
    def __init__(self, program: ir.Program, context: Context, wanted: frozenset[str]) -> None:
        super().__init__(program, context)
        self.wanted = wanted

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Binary(op="cand" | "cor", left=left):
                return replace(expression, left=self.expression(left))
            case ir.Call(name=name) if name.lower() in self.wanted:
                answer = self.temporary(_TYPES[name.lower()], "answer")
                asked = _asked(expression, answer)
                if asked is None:
                    self.editor.added.pop()
                    return expression
                self.before.extend(asked)
                return answer
        return rewrite_parts(expression, self.expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign(target=target, value=ir.Call(name=name) as call) if name.lower() in self.wanted:
                asked = _asked(call, target, statement.origin)
                if asked is not None:
                    return list(asked)
        return super().statement(statement)


def _asked(call: ir.Call, answer: ir.Expression, origin: Origin = NOWHERE) -> ir.Body | None:
    """The statements that put the operator's answer into a variable."""
    name = call.name.lower()
    options: Options = {(one.name or "").lower(): one.value for one in call.arguments}
    if set(options) - _KNOWN[name] or any(one.if_present for one in call.arguments):
        return None
    text, header = shown(options), options.get("header")
    if text is None:
        return None
    limit = options.get("maxtime")
    if name == "uimessagebox":
        return keys_asked(answer, text, header, limit, options, origin)
    kind = "text" if name == "uialphaentry" else "number"
    question = ir.Dialog(answer, text, kind=kind, timeout=limit, sender=header, origin=origin)
    wrong = _refused(answer, options)
    return (question,) if wrong is None else (question, ir.While(wrong, (replace(question, origin=NOWHERE),)))


def _refused(answer: ir.Expression, options: Options) -> ir.Expression | None:
    """The condition under which the controller does not take a number."""
    found: list[ir.Expression] = []
    for option, sign in (("minvalue", "<"), ("maxvalue", ">")):
        limit = options.get(option)
        if limit is not None:
            found.append(ir.Binary(sign, answer, limit))
    if "asinteger" in options:
        found.append(ir.Binary("<>", answer, ir.Builtin("trunc", (answer,))))
    if not found:
        return None
    whole = found[0]
    for one in found[1:]:
        whole = ir.Binary("cor", whole, one)
    return whole
