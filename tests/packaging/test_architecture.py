"""The rooms of the house: arrows go downwards, no circles, files stay readable, the core knows no vendor."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# Highest first. A room may import its own level and the levels below. The last word is the room `rpl.<word>`.
LEVELS = [
    ["cli"],
    ["api", "controllers", "batch"],
    ["proof", "fitting"],
    [
        "project",
        "translation",
        "simulation",
        "workcell",
        "standing",
        "report",
        "view",
        "inventory",
        "comparing",
        "housestyle",
    ],
    ["sidefiles", "archives"],
    ["cell", "emulator", "runtime", "linking", "writing", "reading"],
    ["passes"],
    ["controllerfiles"],
    ["registry"],
    ["ir"],
    ["motionmodel", "checks"],
    ["grouping"],
    ["diagnostics", "source", "errors", "showing", "depth", "tomlfile", "words", "trivia", "library"],
]
LEVEL = {room: number for number, rooms in enumerate(LEVELS) for room in rooms}
MOST_LINES, MOST_FUNCTION_LINES = 600, 60


def modules() -> dict[str, Path]:
    """Every module of the package by its dotted name."""
    found = {}
    for room, package in (
        ("rpl", "rpl"),
        ("dialects", "rpl.dialects"),
        ("postprocessors", "rpl.postprocessors"),
        ("grammars", "rpl.grammars"),
    ):
        for path in sorted((ROOT / room).rglob("*.py")):
            parts = path.relative_to(ROOT / room).with_suffix("").parts
            name = ".".join((package, *parts)).removesuffix(".__init__")
            found[name] = path
    return found


MODULES = modules()


@dataclass(frozen=True)
class Facts:
    """What the tests ask of one module. Every module is parsed once: there are many, and many tests ask."""

    lines: int
    head: str | None
    anywhere: frozenset[str]  # modules of the package that it imports, but for type checking only
    known: frozenset[str]  # all modules of the package that it imports, also for type checking only
    loading: frozenset[str]  # those that it imports while it is loaded itself
    functions: tuple[tuple[str, int], ...]  # name and number of lines
    words: tuple[tuple[str, int], ...]  # texts in the code, no docstrings, and their lines
    handlers: tuple[tuple[str, int], ...]  # what is caught, and where


@cache
def facts(name: str) -> Facts:
    text = MODULES[name].read_text("utf-8")
    tree = ast.parse(text)
    anywhere: set[str] = set()
    known: set[str] = set()
    loading: set[str] = set()
    functions, words, handlers = [], [], []
    # What is left to look at; an import inside a function happens when it is called, not while modules are loaded.
    ahead: list[tuple[ast.AST, bool, bool]] = [(tree, False, False)]
    while ahead:
        node, called, typing = ahead.pop()
        match node:
            case ast.If(test=test) if "TYPE_CHECKING" in ast.dump(test):
                typing = True
            case ast.Import() | ast.ImportFrom():
                found = set(imported(name, node))
                known |= found
                anywhere |= set() if typing else found
                loading |= set() if called or typing else found
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                functions.append((node.name, (node.end_lineno or node.lineno) - node.lineno + 1))
                called = True
            case ast.Expr(value=ast.Constant()):
                continue
            case ast.Constant(value=str(word)):
                words.append((word, node.lineno))
            case ast.ExceptHandler(type=kind):
                handlers.append((ast.unparse(kind) if kind else "", node.lineno))
        ahead += [(inner, called, typing) for inner in ast.iter_child_nodes(node)]
    return Facts(
        len(text.splitlines()),
        ast.get_docstring(tree),
        frozenset(anywhere),
        frozenset(known),
        frozenset(loading),
        tuple(functions),
        tuple(words),
        tuple(handlers),
    )


def imported(name: str, node: ast.Import | ast.ImportFrom) -> Iterator[str]:
    """Dotted names of the package's modules that the statement imports."""
    package = name if MODULES[name].name == "__init__.py" else name.rpartition(".")[0]
    names = [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom):
        base = node.module or ""
        if node.level:
            root = package.split(".")[: len(package.split(".")) - node.level + 1]
            base = ".".join([*root, base] if base else root)
        names = [whole if (whole := f"{base}.{one}") in MODULES else base for one in names]
    return (target for target in names if target.split(".")[0] == "rpl" and target in MODULES)


def imports(name: str, runtime_only: bool = False) -> frozenset[str]:
    """Dotted names of the package's modules that a module imports (anywhere in it; not for type checking only)."""
    return facts(name).loading if runtime_only else facts(name).anywhere


def room_of(name: str) -> str:
    return name.split(".")[1] if "." in name else ""


CORE = [name for name in MODULES if room_of(name) not in ("dialects", "postprocessors", "grammars", "robots", "")]
# Makers' folders: their programs' language is a fact of theirs.
MAKERS = {path.parent.name for path in (ROOT / "rpl/controllers").glob("*/__init__.py")} - {"virtual"}
LANGUAGES = [name for name in MODULES if room_of(name) in ("dialects", "postprocessors")]


# What the folders of the legaliser hold for all; the others are the insides of single stages.
FOR_WRITERS = ("facts", "kinds")
FOR_PASSES = (*FOR_WRITERS, "context", "rewriting", "stages")


@pytest.mark.parametrize("name", [name for name in LANGUAGES if room_of(name) == "postprocessors"])
def test_a_target_uses_no_insides_of_a_stage(name: str) -> None:
    """It may ask for facts, and its own passes rewrite as all others do; what more it needs is made public first."""
    open_folders = FOR_PASSES if name.split(".")[3:4] == ["passes"] else FOR_WRITERS
    used = {one for one in facts(name).known if one.startswith("rpl.passes.legalise.")}
    inside = {one for one in used if one.split(".")[3] not in open_folders}
    assert not inside


# Who has to look at every node of a program: at any name in it, at any aggregate, at what any statement reads.
WALKS_ALL = {
    "rpl.passes.legalise.errors.posetables": "every place that may be an element of a table",
    "rpl.passes.legalise.errors.possiblecases": "every value that a variable or a component may get",
    "rpl.passes.settable": "every place that any statement sets; asked by the linker too",
    "rpl.postprocessors.urscript.facts.programs": "every name of anything",
    "rpl.postprocessors.vplus.facts.names": "every name of anything",
}
WHOLE_WALK = re.compile(r"\bwalk\(\*?(self\.)?(program|source)(\.modules)?\)|\bwalk\(\*done\.modules\)")


@pytest.mark.parametrize("name", [name for name in MODULES if name.startswith(("rpl.passes.", "rpl.postprocessors."))])
def test_no_pass_walks_the_whole_program_by_itself(name: str) -> None:
    """`walk_for`, `gathering` and `kinds_in` pass by what holds nothing of the kinds that are asked for."""
    walks = WHOLE_WALK.search(MODULES[name].read_text("utf-8")) is not None
    assert walks == (name in WALKS_ALL)


@pytest.mark.parametrize("name", CORE)
def test_arrows_go_downwards(name: str) -> None:
    here = room_of(name)
    assert here in LEVEL, f"rpl.{here} has no level: add it to LEVELS"
    for target in imports(name):
        there = room_of(target)
        if there in ("", "robots", here):
            continue
        assert LEVEL[there] >= LEVEL[here], f"{name} imports {target}: an arrow upwards"


@pytest.mark.parametrize("name", CORE)
def test_the_core_reaches_languages_through_the_registry_only(name: str) -> None:
    for target in imports(name):
        assert room_of(target) not in ("dialects", "postprocessors"), f"{name} imports {target}"


@pytest.mark.parametrize("name", LANGUAGES)
def test_a_language_imports_itself_and_the_core(name: str) -> None:
    own = ".".join(name.split(".")[:3])
    for target in imports(name):
        if room_of(target) in ("dialects", "postprocessors"):
            assert target == own or target.startswith(own + "."), f"{name} imports {target}"
        assert room_of(target) not in ("cli", "proof"), f"{name} imports {target}"


def test_no_circles_between_rooms_of_one_level() -> None:
    arrows: dict[str, set[str]] = {}
    for name in CORE:
        here = room_of(name)
        for target in imports(name, runtime_only=True):
            there = room_of(target)
            if there not in ("", here, "robots"):
                arrows.setdefault(here, set()).add(there)
    for start in arrows:
        seen, ahead = set(), list(arrows.get(start, ()))
        while ahead:
            room = ahead.pop()
            assert room != start, f"rpl.{start} imports itself by way of other rooms"
            if room not in seen:
                seen.add(room)
                ahead.extend(arrows.get(room, ()))


def test_no_circles_between_modules() -> None:
    done: set[str] = set()

    def visit(name: str, way: tuple[str, ...]) -> None:
        assert name not in way, f"circle: {' -> '.join((*way[way.index(name) :], name))}"
        if name in done:
            return
        for target in imports(name, runtime_only=True):
            if MODULES[target].name != "__init__.py":  # a package's re-exports are not a circle
                visit(target, (*way, name))
        done.add(name)

    for name in MODULES:
        visit(name, ())


# Modules that know each other's types: each group is one matter, said here so that it does not grow.
KNOWN_TO_EACH_OTHER = (
    {"rpl.ir.expressions", "rpl.ir.types"},
    {"rpl.emulator.splinerules", "rpl.emulator.splines"},
    {"rpl.emulator.closedforms", "rpl.emulator.model", "rpl.emulator.postures"},
    {"rpl.dialects.urscript.calls", "rpl.dialects.urscript.levels"},
    {
        "rpl.registry",
        "rpl.passes.analog",
        "rpl.passes.scope",
        "rpl.passes.legalise.context",
        "rpl.passes.legalise.stages",
    },
    {f"rpl.postprocessors.vplus.{name}" for name in ("expressions", "locations", "places", "texts")},
    # the door hands out a target's own passes, and passes ask the door for the rules of a language
    {"rpl.registry", *(f"rpl.passes.{name}" for name in ("analog", "legalise.context", "legalise.stages", "scope"))},
)


def test_modules_know_each_other_in_few_places_only() -> None:
    """Also counting what is imported inside functions and for type checking only."""
    above: dict[str, frozenset[str]] = {}  # module -> those that it reaches

    def reach(start: str) -> frozenset[str]:
        seen: set[str] = set()
        ahead = [start]
        while ahead:
            for target in facts(ahead.pop()).known:
                if target not in seen and MODULES[target].name != "__init__.py":
                    seen.add(target)
                    ahead.append(target)
        return frozenset(seen)

    for name in MODULES:
        above[name] = reach(name)
    for name in MODULES:
        circle = {other for other in above[name] if name in above[other]}
        assert not circle or any(circle <= group for group in KNOWN_TO_EACH_OTHER), sorted(circle)


@pytest.mark.parametrize("name", list(MODULES))
def test_files_and_functions_stay_readable(name: str) -> None:
    assert facts(name).lines <= MOST_LINES, f"{name} is too long"
    for function, length in facts(name).functions:
        assert length <= MOST_FUNCTION_LINES, f"{name}.{function} has {length} lines"


@pytest.mark.parametrize("name", list(MODULES))
def test_every_module_says_what_it_is_for(name: str) -> None:
    assert facts(name).head, f"{name} has no module head"


@pytest.mark.parametrize("name", CORE)
def test_the_core_names_no_language_in_its_code(name: str) -> None:
    """Names of dialects may stand in comments and docstrings as examples, never in what is executed."""
    if name.startswith("rpl.controllers.") and name.split(".")[2] in MAKERS:
        return
    languages = {folder.name for folder in (ROOT / "dialects").iterdir() if folder.is_dir()} - {"__pycache__", "rpl"}
    for word, line in facts(name).words:
        assert word.lower() not in languages, f"{name}:{line} names {word}"


def test_broad_exceptions_are_caught_nowhere() -> None:
    for name in MODULES:
        for kind, line in facts(name).handlers:
            assert kind not in ("", "Exception", "BaseException"), f"{name}:{line} catches everything"


@pytest.mark.parametrize("name", [name for name in CORE if name.startswith("rpl.controllers.")])
def test_the_rules_of_sending_know_no_maker(name: str) -> None:
    """A maker's folder uses the rules and the plain ways of carrying files; nothing uses a maker's folder."""
    plain = {"folder", "ftp", "sftp"}
    here = name.split(".")[2]
    for target in imports(name):
        parts = target.split(".")
        if parts[1] == "controllers" and len(parts) > 2 and parts[2] in MAKERS - plain:
            assert parts[2] == here, f"{name} imports {target}"
