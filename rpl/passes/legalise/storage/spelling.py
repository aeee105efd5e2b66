"""One spelling for each name, for targets that tell capitals from small letters and sources that do not.

A name is spelled as it is declared; one in capitals alone, which such languages use for everything, in small letters.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.stages import legalising

_DECLARED = (
    ir.Variable,
    ir.Parameter,
    ir.Routine,
    ir.RecordDeclaration,
    ir.EnumDeclaration,
    ir.AliasDeclaration,
    ir.SignalDeclaration,
)
_COMPONENTS = frozenset(name for names in ir.COMPONENTS.values() for name in names)


@legalising(
    unless=lambda context: not context.capabilities.names.case_sensitive or rules_of(context.source).case_sensitive
)
def one_spelling(program: ir.Program, context: Context) -> ir.Program:
    """The program with every name spelled one way."""
    spelled: dict[str, str] = {}
    fields: dict[str, str] = {}
    for module in program.modules:
        spelled.setdefault(module.name.lower(), _plain(module.name))
        for node in walk(module):
            if isinstance(node, _DECLARED):
                spelled.setdefault(node.name.lower(), _plain(node.name))
                for name, _ in node.fields if isinstance(node, ir.RecordDeclaration) else ():
                    fields.setdefault(name.lower(), name.lower() if name.lower() in _COMPONENTS else _plain(name))
            elif isinstance(node, ir.For):
                spelled.setdefault(node.counter.lower(), _plain(node.counter))
            elif isinstance(node, ir.Label):
                spelled.setdefault(node.name.lower(), _plain(node.name))
    return _Spelling(spelled, fields).program(program)


def _plain(name: str) -> str:
    return name.lower() if name.upper() == name else name


class _Spelling:
    def __init__(self, spelled: dict[str, str], fields: dict[str, str]) -> None:
        self.spelled, self.fields = spelled, fields

    def of(self, name: str) -> str:
        return self.spelled.get(name.lower(), name)

    def program(self, program: ir.Program) -> ir.Program:
        tasks = tuple(
            replace(task, entry=self.of(task.entry), modules=tuple(map(self.of, task.modules)))
            for task in program.tasks
        )
        modules = tuple(rewrite(module, self.changed) for module in program.modules)
        return replace(program, modules=modules, tasks=tasks, entry=self.of(program.entry))

    def changed(self, node: object) -> object:
        match node:
            case ir.Name(id=name):
                return self.with_name(node, "id", name)
            case ir.Label(name=name) | ir.Module(name=name) | ir.NamedType(name=name) | ir.CallRoutine(name=name):
                return self.with_name(node, "name", name)
            case ir.Call(name=name) | ir.Present(name=name):
                return self.with_name(node, "name", name)
            case ir.Field(name=name):
                return replace(node, name=self.fields[name.lower()]) if name.lower() in self.fields else node
            case ir.Signal(name=str() as name) | ir.Argument(name=str() as name):
                return self.with_name(node, "name", name)
            case ir.Goto(label=name):
                return self.with_name(node, "label", name)
            case ir.For(counter=name):
                return self.with_name(node, "counter", name)
            case ir.ConnectInterrupt(routine=str() as name) | ir.OnError(routine=str() as name):
                return self.with_name(node, "routine", name)
            case ir.TaskControl(task=name):
                return self.with_name(node, "task", name)
            case ir.Aggregate():
                return self.aggregate(node)
            case ir.RecordDeclaration(fields=fields):
                new = tuple((self.fields.get(name.lower(), name), type) for name, type in fields)
                return replace(node, name=self.of(node.name), fields=new)
            case ir.EnumDeclaration(members=members):
                return replace(node, name=self.of(node.name), members=tuple(map(self.of, members)))
        return self.with_name(node, "name", node.name) if isinstance(node, _DECLARED) else node

    def with_name(self, node: object, part: str, name: str) -> object:
        new = self.of(name)
        return node if new == name else replace(node, **{part: new})  # type: ignore[type-var]  # nodes are dataclasses

    def aggregate(self, node: ir.Aggregate) -> ir.Aggregate:
        entries = tuple((name and self.fields.get(name.lower(), name), value) for name, value in node.entries)
        word = node.type_name
        if word is not None and word.lower() in self.spelled:
            word = self.of(word)
        return replace(node, entries=entries, type_name=word)
