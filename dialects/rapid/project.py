"""What the sources of a project declare, found before any is read: own routines, data names, names used as signals.

A RAPID signal is a name that no module declares, and an installed instruction gives way to a routine of its name; both
need to know all declarations first. A scan with patterns is enough for that and costs milliseconds.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from rpl import ir
from rpl.source import Source

from .types import SIGNALS, TYPES

# The letters a pattern can begin with stand first: most places of a long text are then passed over at once.
_NOISE = re.compile(r'"(?:[^"\r\n]|"")*"|![^\r\n]*')
# Moves to places that are written out name nothing; long programs hold little else.
_POINT = re.compile(r"Move(?:L|J|AbsJ)[ \t]*\[[-+0-9.,\[\]eE ]*\],\w+,\w+,\w+(?:\\WObj:=\w+)?;")
_ROUTINE = re.compile(r"(?=[LPFT])\b(LOCAL\s+)?(?:PROC|FUNC\s+\w+|TRAP)\s+(\w+)(?:\s*\(([^()]*)\))?", re.IGNORECASE)
_DATA = re.compile(r"(?=[CVP])\b(?:CONST|VAR|PERS)\s+\w+\s+(\w+)", re.IGNORECASE)
_PARAMETER = re.compile(r"(\w+)\s+(\w+)\s*(?:\{[^}]*\}\s*)?(?=[,|\\]|$)")
_COUNTER = re.compile(r"(?=F)\bFOR\s+(\w+)\s+FROM\b", re.IGNORECASE)
_RECORD = re.compile(r"(?=[RA])\b(?:RECORD|ALIAS\s+\w+)\s+(\w+)", re.IGNORECASE)
# The first argument behind an instruction or inside a function tells the kind of signal.
_USES = (
    (r"Set|Reset|InvertDO|SetDO|PulseDO|WaitDO|ISignalDO|DOutput", "digital_out"),
    (r"WaitDI|ISignalDI|DInput|TestDI|SearchL|SearchC|SearchExtJ", "digital_in"),
    (r"SetAO|WaitAO|AOutput", "analog_out"),
    (r"AInput|WaitAI|ISignalAI", "analog_in"),
    (r"SetGO|WaitGO|GOutput|ISignalGO", "group_out"),
    (r"GInput|GInputDnum|WaitGI|ISignalGI", "group_in"),
)
_OPTION = r"(?:\\\w+(?:\s*:=\s*[\w.]+)?\s*,?\s*)*"
_USE_KINDS = {word.lower(): kind for words, kind in _USES for word in words.split("|")}
_USE_LETTERS = "".join(sorted({word[0] for word in _USE_KINDS}))
_SIGNAL_USE = re.compile(
    rf"(?=[{_USE_LETTERS}])(?<![\w\\.])({'|'.join(words for words, _ in _USES)})"
    rf"\s*\(?\s*{_OPTION}([^\W\d]\w*)\s*(?=[,;)\\])",
    re.IGNORECASE,
)
_DOP = re.compile(r"\\(DOp|AOp|GOp)\s*:=\s*([^\W\d]\w*)", re.IGNORECASE)
_DOP_KINDS = {"dop": "digital_out", "aop": "analog_out", "gop": "group_out"}
# A name by the usual prefix of a signal, such as diPart, do_grip, gi1: believed only when nothing declares it.
_PREFIX = re.compile(r"(di|do|ai|ao|gi|go)(?=[A-Z0-9_])")
_PREFIX_KINDS = {key[-2:]: kind for key, kind in SIGNALS.items()}


@dataclass(slots=True)
class Project:
    """Names in lower case. `signal_arguments`: routine -> parameter position or name -> signal kind."""

    routines: set[str] = field(default_factory=set)
    local_routines: dict[str, set[str]] = field(default_factory=dict)
    declared: set[str] = field(default_factory=set)
    signals: dict[str, str] = field(default_factory=dict)
    types: set[str] = field(default_factory=set)
    signal_arguments: dict[str, dict[int | str, str]] = field(default_factory=dict)
    signal_parameters: set[str] = field(default_factory=set)
    booked_errors: dict[str, int] = field(default_factory=dict)

    def type_named(self, word: str) -> ir.Type:
        """The type of a type name: a record or alias of the project before an installed type."""
        lower = word.lower()
        if lower in self.types:
            return ir.NamedType(word)
        return TYPES.get(lower) or ir.NamedType(word)

    def signal_kind(self, name: str) -> str | None:
        """The kind of signal an undeclared name must be, or None when nothing says that it is one."""
        lower = name.lower()
        if lower in self.declared:
            return None
        found = self.signals.get(lower)
        if found is not None:
            return found
        prefix = _PREFIX.match(name)
        return _PREFIX_KINDS[prefix.group(1)] if prefix else None


def survey(sources: Iterable[Source], predefined: Iterable[str]) -> Project:
    """Scan all sources. `predefined`: names the controller declares (lower case)."""
    project = Project(declared=set(predefined))
    for source in sources:
        text = _NOISE.sub(" ", _POINT.sub(" ", source.text))
        local = project.local_routines.setdefault(source.path, set())
        for scope, name, parameters in _ROUTINE.findall(text):
            (local if scope else project.routines).add(name.lower())
            if parameters:
                _parameters(project, name.lower(), parameters)
        project.declared.update(name.lower() for name in _DATA.findall(text))
        project.declared.update(name.lower() for name in _COUNTER.findall(text))
        project.types.update(name.lower() for name in _RECORD.findall(text))
        for word, name in _SIGNAL_USE.findall(text):
            project.signals.setdefault(name.lower(), _USE_KINDS[word.lower()])
        for option, name in _DOP.findall(text):
            project.signals.setdefault(name.lower(), _DOP_KINDS[option.lower()])
    for routine, kinds in project.signal_arguments.items():
        if routine not in project.routines and not any(routine in names for names in project.local_routines.values()):
            kinds.clear()
    return project


def _parameters(project: Project, routine: str, parameters: str) -> None:
    for position, (word, name) in enumerate(_PARAMETER.findall(parameters)):
        project.declared.add(name.lower())
        kind = SIGNALS.get(word.lower())
        if kind:
            kinds = project.signal_arguments.setdefault(routine, {})
            kinds[position] = kinds[name.lower()] = kind
            project.signal_parameters.add(name.lower())
