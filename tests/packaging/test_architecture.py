"""The rooms of the house: arrows go downwards, no circles, files stay readable, the core knows no vendor."""

import ast
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

# Highest first. A room may import its own level and the levels below. The last word is the room `rpl.<word>`.
LEVELS = [
    ["cli"],
    ["api"],
    ["proof"],
    ["project", "translation", "simulation"],
    ["cell", "emulator", "runtime", "linking", "writing", "reading"],
    ["passes"],
    ["registry"],
    ["ir"],
    ["diagnostics", "source", "errors"],
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


@cache
def imports(name: str, runtime_only: bool = False) -> frozenset[str]:
    """Dotted names of the package's modules that a module imports (anywhere in it; not for type checking only)."""
    path = MODULES[name]
    tree = ast.parse(path.read_text("utf-8"))
    skipped = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
        for inner in ast.walk(node)
    }
    if runtime_only:  # an import inside a function happens when it is called, not while modules are loaded
        skipped |= {
            id(inner)
            for node in ast.walk(tree)
            if isinstance(node, ast.FunctionDef)
            for inner in ast.walk(node)
            if inner is not node
        }
    found = set()
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(tree):
        if id(node) in skipped:
            continue
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                root = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join([*root, base] if base else root)
            for alias in node.names:
                whole = f"{base}.{alias.name}"
                found.add(whole if whole in MODULES else base)
    return frozenset(target for target in found if target.split(".")[0] == "rpl" and target in MODULES)


def room_of(name: str) -> str:
    return name.split(".")[1] if "." in name else ""


CORE = [name for name in MODULES if room_of(name) not in ("dialects", "postprocessors", "grammars", "robots", "")]
LANGUAGES = [name for name in MODULES if room_of(name) in ("dialects", "postprocessors")]


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


@pytest.mark.parametrize("name", list(MODULES))
def test_files_and_functions_stay_readable(name: str) -> None:
    text = MODULES[name].read_text("utf-8")
    tree = ast.parse(text)
    assert len(text.splitlines()) <= MOST_LINES, f"{name} is too long"
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            length = (node.end_lineno or node.lineno) - node.lineno + 1
            assert length <= MOST_FUNCTION_LINES, f"{name}.{node.name} has {length} lines"


@pytest.mark.parametrize("name", list(MODULES))
def test_every_module_says_what_it_is_for(name: str) -> None:
    assert ast.get_docstring(ast.parse(MODULES[name].read_text("utf-8"))), f"{name} has no module head"


@pytest.mark.parametrize("name", CORE)
def test_the_core_names_no_language_in_its_code(name: str) -> None:
    """Names of dialects may stand in comments and docstrings as examples, never in what is executed."""
    languages = {folder.name for folder in (ROOT / "dialects").iterdir() if folder.is_dir()} - {"__pycache__", "rpl"}
    tree = ast.parse(MODULES[name].read_text("utf-8"))
    docs = {
        id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
            assert node.value.lower() not in languages, f"{name}:{node.lineno} names {node.value}"


def test_broad_exceptions_are_caught_nowhere() -> None:
    for name, path in MODULES.items():
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ExceptHandler):
                kind = ast.unparse(node.type) if node.type else ""
                assert kind not in ("", "Exception", "BaseException"), f"{name}:{node.lineno} catches everything"
