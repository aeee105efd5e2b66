"""Programs saved by the teach pendant (.urp): the tree of program nodes written out as script.

The file is XML (packed with gzip; unpacked before it comes here) in which nodes refer to others by relative paths. Read
are the nodes that stand for script: assignments, script lines and files, moves with taught waypoints, waits, branches,
loops, pop-ups, threads and calls of subprograms. Any other node becomes a call that a run stops at.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as Xml
from collections.abc import Iterator

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin, Source, source_from_text

DAMAGED = code("urscript-pendant-damaged", Severity.ERROR, "this saved program cannot be read: {reason}")
WRITTEN_OUT = code(
    "urscript-pendant",
    Severity.INFO,
    "read from the nodes of a saved program; lines count in the script they stand for",
)
NODE = code(
    "urscript-pendant-node",
    Severity.WARNING,
    "the program node {name} has no script that can be read from the file",
    "a run stops there; save the program on the robot and read the .script beside it",
)

_SIGNS = {"≟": "==", "≠": "!=", "≤": "<=", "≥": ">=", "×": "*", "÷": "/", "−": "-", "¬": "not "}
_PINS = {
    "digital": "standard_digital",
    "config": "configurable_digital",
    "tool": "tool_digital",
    "analog": "standard_analog",
}
_PIN = re.compile(r"(digital|config|tool|analog)_(in|out)\[(\d+)\]")
_STEP = re.compile(r"(\w+)(?:\[(\d+)\])?")


def is_saved_program(source: Source) -> bool:
    return "<URProgram" in source.text[:2000]


def as_script(source: Source, diagnostics: Diagnostics) -> Source:
    """The saved program as script text under the same name."""
    try:
        root = Xml.fromstring(source.text.lstrip("\ufeff \t\r\n").encode("utf-8"))
    except Xml.ParseError as error:
        diagnostics.report(DAMAGED, Origin(source), reason=str(error))
        return source_from_text(source.path, "")
    diagnostics.report(WRITTEN_OUT, Origin(source))
    return source_from_text(source.path, "\n".join(_Writer(root, source, diagnostics).program()) + "\n")


class _Writer:
    def __init__(self, root: Xml.Element, source: Source, diagnostics: Diagnostics) -> None:
        self.root, self.source, self.diagnostics = root, source, diagnostics
        self.parents = {child: parent for parent in root.iter() for child in parent}

    def program(self) -> Iterator[str]:
        name = identifier(self.root.get("name") or "program")
        yield f"def {name}():"
        top = self.root.find("children")
        nodes = list(top) if top is not None else []
        for kind in ("SubProgram", "Thread"):
            for node in nodes:
                if node.tag == kind:
                    yield from self.indented(self.function(node))
        for node in nodes:
            if node.tag == "InitVariablesNode":
                for variable in node.iterfind("variables/variable"):
                    yield f"  global {self.name(variable)} = {self.expression(variable.find('expression'))}"
            elif node.tag == "SpecialSequence":
                yield from self.indented(self.children(node))
            elif node.tag == "Thread":
                yield f"  run {identifier(node.get('name') or 'Thread')}()"
        for node in nodes:
            if node.tag == "MainProgram":
                once = node.get("runOnlyOnce") == "true"
                body = list(self.indented(self.children(node)))
                yield from body if once else ["  while (True):", *self.indented(body), "  end"]
        yield "end"

    def function(self, node: Xml.Element) -> Iterator[str]:
        if node.tag == "Thread":
            yield f"thread {identifier(node.get('name') or 'Thread')}():"
            yield "  while (True):"
            yield from self.indented(self.indented(self.children(node)))
            yield "  end"
        else:
            found = self.resolved(node)
            yield f"def {identifier(found.get('name') or 'SubProgram')}():"
            yield from self.indented(self.children(found))
        yield "end"

    @staticmethod
    def indented(lines: Iterator[str] | list[str]) -> Iterator[str]:
        for line in lines:
            yield f"  {line}"

    def children(self, node: Xml.Element) -> Iterator[str]:
        inner = node.find("children")
        closing = False
        for child in inner if inner is not None else ():
            follows = child.tag == "If" and child.get("type") in ("ElseIf", "Else")
            if closing and not follows:
                yield "end"
            yield from self.node(child)
            closing = child.tag == "If"
        if closing:
            yield "end"

    # ---- one node

    def node(self, node: Xml.Element) -> Iterator[str]:
        match node.tag:
            case "Assignment":
                yield f"global {self.name(node.find('variable'))} = {self.expression(node.find('expression'))}"
            case "Script":
                text = node.findtext("cachedContents")
                yield from (text.splitlines() if text is not None else [self.expression(node.find("expression"))])
            case "Wait" if node.get("type") == "Sleep":
                yield f"sleep({node.findtext('waitTime') or '0'})"
            case "Comment":
                yield f"# {node.get('comment') or ''}"
            case "Halt":
                yield "halt"
            case "Folder":
                yield f"# {node.get('name') or ''}"
                yield from self.children(node)
            case "If":
                yield from self.branch(node)
            case "Loop" if node.find("expression") is not None or node.get("type") == "Always":
                found = node.find("expression")
                yield f"while ({self.expression(found) if found is not None else 'True'}):"
                yield from self.indented(self.children(node))
                yield "end"
            case "Popup":
                yield f"popup({_text(node.get('message'))}, blocking=True)"
                if node.get("haltProgram") == "true":
                    yield "halt"
            case "Move":
                yield from self.move(node)
            case "CallSubProgram":
                found = node.find("subprogram")
                name = self.resolved(found).get("name") if found is not None else ""
                yield f"{identifier(name or 'SubProgram')}()"
            case "SuppressedNode" | "InitVariablesNode":
                yield f"# suppressed: {_inner_name(node)}"
            case _:
                yield from self.unread(node)

    def unread(self, node: Xml.Element) -> Iterator[str]:
        name = node.get("strategyProgramNodeType") or node.get("type") or ""
        shown = f"{node.tag} {name}".strip()
        self.diagnostics.report(NODE, Origin(self.source), name=shown)
        yield f"pendant_node({_text(shown)})"

    def branch(self, node: Xml.Element) -> Iterator[str]:
        kind = node.get("type") or "If"
        if kind == "Else":
            yield "else:"
        else:
            yield f"{'elif' if kind == 'ElseIf' else 'if'} ({self.expression(node.find('expression'))}):"
        yield from self.indented(self.children(node))

    def move(self, node: Xml.Element) -> Iterator[str]:
        """Taught points carry the joints; a linear move goes to where these put the tool."""
        kind = {"MoveJ": "movej", "MoveL": "movel", "MoveP": "movep"}.get(node.get("motionType") or "")
        if kind is None:
            yield from self.unread(node)
            return
        how = f"a={node.get('acceleration') or '1.2'}, v={node.get('speed') or '0.25'}"
        inner = node.find("children")
        for child in inner if inner is not None else ():
            if child.tag != "Waypoint":
                yield from self.node(child)
                continue
            angles = child.find("position/JointAngles")
            variable = child.find("variable")
            if angles is not None:
                yield f"# {child.get('name') or 'Waypoint'}"
                yield f"{kind}([{angles.get('angles') or ''}], {how})"
            elif variable is not None:
                yield f"{kind}({self.name(variable)}, {how})"
            else:
                yield from self.unread(child)

    # ---- expressions

    def expression(self, node: Xml.Element | None) -> str:
        if node is None:
            return "0"
        parts: list[str] = []
        for part in node:
            match part.tag:
                case "ExpressionChar":
                    sign = part.get("character") or ""
                    parts.append(_SIGNS.get(sign, sign))
                case "ExpressionToken":
                    token = part.get("token") or ""
                    parts.append(f" {token} " if token.isalpha() else token)
                case "ExpressionVariable":
                    parts.append(self.name(part.find("ProgramVariable")))
                case "ExpressionIO":
                    parts.append(_pin(part.find("pin")))
        return "".join(parts).strip() or "0"

    def name(self, node: Xml.Element | None) -> str:
        found = self.resolved(node) if node is not None else None
        return identifier(found.get("name") or "variable") if found is not None else "variable"

    def resolved(self, node: Xml.Element) -> Xml.Element:
        """The node that a reference such as `../../Assignment[2]/variable` means."""
        for _ in range(20):
            path = node.get("reference")
            if path is None:
                return node
            at: Xml.Element | None = node
            for step in path.split("/"):
                if at is None:
                    break
                at = self.parents.get(at) if step == ".." else _child(at, step)
            if at is None:
                return node
            node = at
        return node


def _child(node: Xml.Element, step: str) -> Xml.Element | None:
    found = _STEP.fullmatch(step)
    if found is None:
        return None
    same = [child for child in node if child.tag == found[1]]
    place = int(found[2] or 1) - 1
    return same[place] if place < len(same) else None


def _pin(node: Xml.Element | None) -> str:
    name = (node.get("referencedName") if node is not None else "") or "pin"
    found = _PIN.fullmatch(name)
    if found is None:
        return identifier(name)
    return f"get_{_PINS[found[1]]}_{found[2]}({found[3]})"


def _inner_name(node: Xml.Element) -> str:
    inner = node.find("suppressedNode")
    return (inner.get("class") or "") if inner is not None else node.tag


def _text(text: str | None) -> str:
    plain = (text or "").replace('"', "'").replace("\r", " ").replace("\n", " ")
    return f'"{plain}"'


def identifier(text: str) -> str:
    """A name that the language accepts."""
    name = re.sub(r"\W", "_", text) or "name"
    return f"_{name}" if name[0].isdigit() else name
