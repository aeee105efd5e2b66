"""All KRL files of a project to modules: `.src` and `.dat` of one name become one module, `.sub` a background task."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import PurePath, PureWindowsPath

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.assemble import assemble
from rpl.reading.ledger import FileReport
from rpl.reading.pieces import Attribute, Item, ModulePart
from rpl.reading.runs import Cursor, Runs
from rpl.reading.shapes import ShapeParser
from rpl.registry import ReadResult
from rpl.source import Origin, Source

from . import tables
from .blocks import Builder, DataList
from .expressions import Facts
from .keptframes import tell_what_is_not_given
from .motion import Motion
from .split import SHAPE, SLOTS, split

OUTSIDE = code(
    "krl-outside-routine", Severity.WARNING, "instructions outside of DEF ... END", "they are read as routine {name}"
)
TWICE = code("krl-two-data-lists", Severity.INFO, "a second data list named {name}; both are read")
IMPORTED = code(
    "krl-import",
    Severity.WARNING,
    "{name} stands for {target} of another module; it is not connected to it here",
    "use the same name in both modules",
)

PARAMETERS = code(
    "krl-message-parameters",
    Severity.WARNING,
    "the parameters of user messages are not filled into their texts: %1, %2 and %3 are shown as they stand",
    "write the values into the text (SWRITE), or use MsgNotify with its parameters",
)
_PARAMETER = re.compile(r"^[^;\n]*\bPAR_TYPE[ \t]*=?[ \t]*#[ \t]*(?:VALUE|KEY)\b", re.IGNORECASE | re.MULTILINE)

_ROUTINE = re.compile(
    r"^[ \t]*(?=[GD])(?:GLOBAL[ \t]+)?DEF(?:FCT[ \t]+[\w$]+[ \t]*(?:\[[^\]\n]*\])?)?[ \t]+([\w$]+)",
    re.IGNORECASE | re.MULTILINE,
)
_TYPED = re.compile(
    r"^[ \t]*(?=[DGCIRBAEFP])(?:(?:DECL|GLOBAL|CONST)[ \t]+)*"
    r"(INT|REAL|BOOL|CHAR|AXIS|E[36]AXIS|FRAME|POS|E[36]POS)[ \t]+([A-Za-z_$][^=;{\r\n]*)",
    re.IGNORECASE | re.MULTILINE,
)
_MACHINE_DATA = re.compile(
    r"^[ \t]*(?:DECL[ \t]+)?(?:GLOBAL[ \t]+)?[A-Z_]\w*[ \t]+(\$\w+)", re.IGNORECASE | re.MULTILINE
)
_DECLARED_NAME = re.compile(r"([A-Za-z_$][\w$]*)[ \t]*(?:\[[^\]]*\])?[ \t]*(?:,|$)")
_IMPORT = re.compile(
    r"IMPORT\s+[\w$]+\s+([\w$]+)\s*(?:\[[^\]]*\])?\s+IS\s+(?:/\w+)*/([\w$]+)\s*\.\.\s*([\w$]+)", re.IGNORECASE
)
# The names of the controller's own data lists begin so; what they declare are variables of the whole controller.
_SYSTEM = "$"


@cache
def _parser() -> ShapeParser:
    return ShapeParser("krl.lark", SHAPE, SLOTS)


def facts_of(texts: Iterable[str]) -> Facts:
    """A quick look over the project: its routines' names, the simple types of its names, and the machine data that it
    declares (`DECL CP $VEL_MA={CP 3.0,ORI1 400.0,ORI2 400.0}` of $machine.dat)."""
    routines: set[str] = set()
    types: dict[str, str] = {}
    given: set[str] = set()
    for text in texts:
        given.update(name.lower() for name in _MACHINE_DATA.findall(text))
        routines.update(name.lower() for name in _ROUTINE.findall(text))
        for kind, names in _TYPED.findall(text):
            for name in _DECLARED_NAME.findall(names):
                types.setdefault(name.lower(), kind.lower())
    return Facts(frozenset(routines), types, frozenset(given & tables.MEASURED.keys()))


@dataclass(slots=True)
class _Parts:
    """What belongs to one module name."""

    name: str
    attributes: list[tuple[str, str]] = field(default_factory=list)
    declarations: list[ir.Declaration] = field(default_factory=list)
    routines: list[ir.Routine] = field(default_factory=list)
    origin: Origin = field(default_factory=Origin)
    public: bool = False
    has_data: bool = False
    background: bool = False


def read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    """Read all files of one project together."""
    facts = facts_of(source.text for source in sources)
    lowering = Motion(facts, diagnostics)
    build = Builder(diagnostics)
    modules: dict[str, _Parts] = {}
    reports: list[FileReport] = []
    for source in sorted(sources, key=lambda source: _suffix(source) == ".dat"):
        facts.reported.clear()
        cursor = Cursor()
        lone = frozenset(("spline",))
        runs = Runs(source, _parser(), lowering.lower, cursor, diagnostics, signs_placed=True, not_in=lone)
        pieces = split(source, cursor)
        done = assemble(source, "krl", pieces, _parser(), lowering.lower, build, diagnostics, runs)
        reports.append(done.report)
        _sort_items(source, done.items, modules, diagnostics)
        parameters = "set_krlmsg" not in facts.routines and "PAR_TYPE" in source.text.upper()
        if parameters and (found := _PARAMETER.search(source.text)):
            diagnostics.report(PARAMETERS, Origin(source, found.start(), found.end()))
    tell_what_is_not_given(sources, diagnostics)
    order = {source.path: position for position, source in enumerate(sources)}
    reports.sort(key=lambda report: order[report.path])
    _connect_imports(list(modules.values()), diagnostics)
    built = tuple(_module(parts) for parts in modules.values())
    tasks = tuple(
        ir.Task(parts.name.lower(), parts.routines[0].name, "background", modules=(parts.name,))
        for parts in modules.values()
        if parts.background and parts.routines
    )
    return ReadResult(ir.Program(built, tasks), tuple(reports))


def _suffix(source: Source) -> str:
    return PurePath(source.path).suffix.lower()


def _stem(source: Source) -> str:
    return PureWindowsPath(source.path).stem


def _sort_items(source: Source, items: tuple[Item, ...], modules: dict[str, _Parts], diagnostics: Diagnostics) -> None:
    """Put a file's top-level items into the module they belong to."""
    stem = _stem(source)
    attributes: list[tuple[str, str]] = []
    loose: list[ir.Statement] = []
    routines = [item for item in items if isinstance(item, ir.Routine)]
    lists = [item for item in items if isinstance(item, ModulePart)]
    parts = _parts_for(source, stem, routines, lists, modules, diagnostics)
    for item in items:
        match item:
            case Attribute(name=name, value=value):
                attributes.append((name, value))
            case ir.Routine():
                first = not parts.routines
                parts.routines.append(replace(item, scope="global") if first and item.scope == "module" else item)
            case ModulePart(data=DataList(public=public)):
                parts.public = parts.public or public
                parts.has_data = True
                parts.declarations.extend(_visible(item, public))
            case ir.Nothing():
                parts.declarations.append(ir.Unread("", origin=item.origin))
            case ir.Variable(storage="variable") if _suffix(source) == ".dat":  # a data list without its frame
                parts.declarations.append(replace(item, storage="persistent"))
            case ir.Variable() | ir.VariableRows() | ir.RecordDeclaration() | ir.EnumDeclaration():
                parts.declarations.append(item)
            case ir.SignalDeclaration():
                parts.declarations.append(item)
            case ir.ExternalDeclaration() | ir.AliasDeclaration() | ir.Initialise() | ir.Unread():
                parts.declarations.append(item)
            case _ if not isinstance(item, ModulePart):
                loose.append(item)
    if loose:
        diagnostics.report(OUTSIDE, loose[0].origin, name=parts.name)
        parts.routines.append(ir.Routine(parts.name, body=tuple(loose), scope="global", origin=loose[0].origin))
    prefix = "" if _suffix(source) != ".dat" else "dat "
    parts.attributes.extend((prefix + name, value) for name, value in attributes)
    parts.background = parts.background or _suffix(source) == ".sub"


def _parts_for(
    source: Source,
    stem: str,
    routines: list[ir.Routine],
    lists: list[ModulePart],
    modules: dict[str, _Parts],
    diagnostics: Diagnostics,
) -> _Parts:
    """The module of a file: by its name, else by the name its content gives itself."""
    inner = lists[0].name if lists else (routines[0].name if routines else "")
    is_list = bool(lists) and not routines
    for name in (stem, inner):
        known = modules.get(name.lower())
        if known is not None and is_list and not known.has_data:
            return known
    wanted = inner if inner and (inner.lower() == stem.lower() or not _is_name(stem)) else stem
    if not _is_name(wanted):
        wanted = re.sub(r"\W", "_", wanted) or "module"
    key = wanted.lower()
    if key in modules:
        key = f"{key}#{len(modules)}"
        if is_list:
            diagnostics.report(TWICE, lists[0].origin, name=wanted)
    origin = (lists[0] if is_list else routines[0]).origin if (lists or routines) else Origin(source)
    parts = modules[key] = _Parts(wanted, origin=replace(origin, comments=()))
    return parts


def _is_name(text: str) -> bool:
    return re.fullmatch(r"[A-Za-z_$\u0080-\uffff][\w$]*", text) is not None


def _visible(part: ModulePart, public: bool) -> Iterable[ir.Declaration]:
    """A data list's declarations with their scope: the controller's own ($config, $machine, $robcor, $option) are seen
    everywhere, others only what says GLOBAL."""
    everywhere = part.name.startswith(_SYSTEM)
    if part.origin.comments:
        yield ir.Unread("", origin=part.origin)
    for declaration in part.declarations:
        match declaration:
            case (
                ir.Variable(scope="module")
                | ir.RecordDeclaration(scope="module")
                | ir.EnumDeclaration(scope="module")
                | ir.SignalDeclaration(scope="module")
            ) if everywhere:
                yield replace(declaration, scope="global")
            case _:
                yield declaration


def _connect_imports(modules: list[_Parts], diagnostics: Diagnostics) -> None:
    """`IMPORT INT X IS /R1/OTHER..X`: the datum of a PUBLIC list becomes visible everywhere under its own name."""
    lists = {parts.name.lower(): parts for parts in modules if parts.has_data}
    for parts in modules:
        every = [*parts.declarations, *(item for routine in parts.routines for item in routine.declarations)]
        for declaration in every:
            if not isinstance(declaration, ir.ExternalDeclaration):
                continue
            found = _IMPORT.match(declaration.text)
            if found is None:
                continue
            name, module, target = found.groups()
            home = lists.get(module.lower())
            if home is None or name.lower() != target.lower():
                diagnostics.report(IMPORTED, declaration.origin, name=name, target=f"{module}..{target}")
                continue
            home.declarations = [_made_global(item, target.lower()) for item in home.declarations]


def _made_global(declaration: ir.Declaration, name: str) -> ir.Declaration:
    if isinstance(declaration, ir.Variable) and declaration.name.lower() == name:
        return replace(declaration, scope="global")
    return declaration


def _complete(declaration: ir.Declaration) -> ir.Declaration:
    """Path parameters (LDAT) as older systems wrote them lack components that BAS reads: these get what is usual."""
    match declaration:
        case ir.Variable(type=ir.NamedType(name=name), initial=ir.Aggregate(entries=entries) as initial):
            usual = tables.USUAL_COMPONENTS.get(name.lower(), {})
            given = {(key or "").lower() for key, _ in entries}
            more = tuple((key.upper(), ir.EnumLiteral(word)) for key, word in usual.items() if key not in given)
            return replace(declaration, initial=replace(initial, entries=(*entries, *more))) if more else declaration
    return declaration


def _module(parts: _Parts) -> ir.Module:
    return ir.Module(
        parts.name,
        "krl",
        tuple(_complete(one) for one in parts.declarations),
        tuple(parts.routines),
        tuple(parts.attributes),
        public=parts.public,
        origin=parts.origin,
    )
