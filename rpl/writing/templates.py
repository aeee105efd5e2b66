"""How a statement looks: the Jinja macros of a target, and a plant's own in their place.

The convention, for every target:
- `postprocessors/<target>/templates/*.j2` hold macros and nothing else, each name once in the target: `statements.j2`
  one for each form of a statement (blocks: one for each of their lines, or one for the whole), `frames.j2` what is
  around them: files, routines, declarations, remarks.
- Python decides words and values (names, numbers, expressions as the target spells them, which form of a statement it
  is); the macro decides layout, order and blanks. It gets words by name and never an IR node:
  `macros("wait", time="1.5", stand=True)`. What is not said is an empty text, an empty list or False.
- A macro's text stands on lines of its own between its tags: lines of tags leave nothing, the last line end is taken
  off. It gives whole lines without indentation; whoever calls indents, numbers and wraps them.
- The comment before a macro (`{# Goto: a jump. label: where to. #}`) names the IR node and explains words;
  `rpl templates` and docs/templates.md print it. Names with `_` in front are helpers of their file.
- A writer gets its macros by `macros_of(__package__, context.templates)`, once a program, and marks nodes in the ledger
  itself. Where it catches CannotSayError it lets `TemplateError` pass with its place: `raise error.at(origin)`.
- `move` takes a plain mapping of words to texts, so that one call can be rendered once for many moves.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from importlib import resources
from traceback import walk_tb
from typing import TYPE_CHECKING

from rpl.errors import UsageError
from rpl.source import Origin

if TYPE_CHECKING:
    from jinja2 import Environment, Template

_NOTE = r"(?:\{#-?\s*(?P<note>(?:(?!#\}).)*?)\s*-?#\}\s*)?"
_HEAD = re.compile(_NOTE + r"\{%-?\s*macro\s+(?P<name>[a-zA-Z]\w*)\s*\((?P<words>[^)]*)\)", re.DOTALL)
_END = re.compile(r"\{%-?\s*endmacro\s*-?%\}")
_STATEMENTS = "statements.j2"
_NO_TEXT = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")

# What a template can raise besides its own errors. Words are printed before it is called: it is the plant's fault.
_FAULTS = (TypeError, ValueError, ArithmeticError, LookupError, AttributeError, RecursionError)


class TemplateError(UsageError):
    """A plant's own macro cannot be used: where it stands and why. While writing, also the statement it failed at."""

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.placed = False

    def at(self, origin: Origin) -> TemplateError:
        """The same with the place in the source; the innermost statement says it first."""
        if self.placed or not origin.source:
            return self
        found = TemplateError(f"{self}, at the statement in {origin.file}:{origin.line}")
        found.placed = True
        return found


@dataclass(frozen=True, slots=True)
class MacroText:
    """One macro of a target as it stands in its file: what it is for, the words it gets, its whole text."""

    name: str
    file: str
    note: str
    words: tuple[str, ...]
    text: str


class Macros:
    """The macros of one target, called by name with their words."""

    __slots__ = ("_functions",)

    def __init__(self, functions: Mapping[str, Callable[..., str]]) -> None:
        self._functions = functions

    def __call__(self, macro: str, /, **words: object) -> str:
        """The macro's text without its last line end. Raises TemplateError for a plant's own macro that fails."""
        return self._functions[macro](**words).removesuffix("\n")

    def lines(self, macro: str, /, **words: object) -> list[str]:
        """The same as lines."""
        return self._functions[macro](**words).splitlines()


@cache
def macro_files(package: str) -> Mapping[str, str]:
    """The template files of a target's package: name -> text."""
    folder = resources.files(package).joinpath("templates")
    if not folder.is_dir():
        return {}
    found = {entry.name: entry.read_text("utf-8") for entry in folder.iterdir() if entry.name.endswith(".j2")}
    return dict(sorted(found.items()))


@cache
def macro_texts(package: str) -> Mapping[str, MacroText]:
    """Every macro of a target by its name, in the order of the files."""
    found = {}
    for file, text in macro_files(package).items():
        for head in _HEAD.finditer(text):
            end = _END.search(text, head.end())
            words = tuple(word.partition("=")[0].strip() for word in head["words"].split(",") if word.strip())
            note = " ".join((head["note"] or "").split())
            whole = text[head.start() : end.end() if end else None]
            found[head["name"]] = MacroText(head["name"], file, note, words, whole)
    return found


def macros_of(package: str, own: Mapping[str, str] | None = None) -> Macros:
    """The macros of a target, with those of a plant in their place. `own`: the plant's files, path -> text.

    Raises TemplateError for a file that is no template, for macros and words that the target has not.
    """
    shipped = _shipped(package)
    if not own:
        return Macros(shipped)
    replaced: dict[str, Callable[..., str]] = {}
    for path, text in own.items():
        for name, macro in _own(path, text, package, shipped).items():
            replaced[name] = macro
    return Macros({**shipped, **replaced})


def _environment(own: bool) -> Environment:
    """Block tags leave no lines; a word that is not given is an error. A plant's templates see texts only."""
    from jinja2 import Environment, StrictUndefined
    from jinja2.sandbox import ImmutableSandboxedEnvironment

    kind = ImmutableSandboxedEnvironment if own else Environment
    return kind(undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, autoescape=False)


@cache
def _shipped(package: str) -> Mapping[str, Callable[..., str]]:
    """The target's own macros, compiled once."""
    environment = _environment(False)
    found: dict[str, Callable[..., str]] = {}
    for text in macro_files(package).values():
        found.update(_macros_in(environment.from_string(text)))
        found.update(_plain_macros(text, environment))
    return found


def _plain_macros(text: str, environment: Environment) -> dict[str, Callable[..., str]]:
    """The macros that only put words between texts, as format strings: a third of the time, and most statements."""
    from jinja2 import nodes

    found: dict[str, Callable[..., str]] = {}
    for macro in environment.parse(text).find_all(nodes.Macro):
        parts = [part for one in macro.body for part in (one.nodes if isinstance(one, nodes.Output) else (one,))]
        shown = []
        for part in parts:
            if isinstance(part, nodes.TemplateData):
                shown.append(part.data.replace("{", "{{").replace("}", "}}"))
            elif isinstance(part, nodes.Name):
                shown.append(f"{{{part.name}}}")
        if len(shown) == len(parts) and not macro.defaults and not macro.name.startswith("_"):
            found[macro.name] = "".join(shown).format
    return found


def _macros_in(template: Template) -> dict[str, Callable[..., str]]:
    from jinja2.runtime import Macro

    exported = vars(template.module).items()
    return {name: value for name, value in exported if isinstance(value, Macro) and not name.startswith("_")}


def _own(
    path: str, text: str, package: str, shipped: Mapping[str, Callable[..., str]]
) -> dict[str, Callable[..., str]]:
    """The macros of one file of a plant, each called with the words that it asks for."""
    from jinja2 import TemplateError as JinjaError
    from jinja2 import TemplateSyntaxError

    known = macro_texts(package)
    environment = _environment(True)
    environment.globals["shipped"] = {one: _by_place(known[one].words, shipped[one]) for one in known}
    try:
        template = environment.from_string(text)
    except TemplateSyntaxError as error:
        raise TemplateError(f"{path}:{error.lineno}: {error.message}") from None
    try:
        macros = _macros_in(template)
    except (JinjaError, *_FAULTS) as error:
        raise TemplateError(f"{path}:{_line(error, template)}: {error}") from None
    if not macros:
        raise TemplateError(f"{path}: no macro stands in it")
    found = {}
    for name, macro in macros.items():
        line = _line_of(name, text)
        if name not in known:
            raise TemplateError(f"{path}:{line}: there is no macro {name!r}{_meant(name, known)}")
        wanted: tuple[str, ...] = getattr(macro, "arguments", ())
        for word in wanted:
            if word not in known[name].words:
                of = f"the macro {name} gets no word {word!r}{_meant(word, known[name].words)}"
                raise TemplateError(f"{path}:{line}: {of}")
        found[name] = _guarded(f"{path}:{line}", known[name], macro, wanted, template)
    return found


def _by_place(names: tuple[str, ...], macro: Callable[..., str]) -> Callable[..., str]:
    """A shipped macro as templates call it: words by their place or by name."""

    def call(*given: object, **words: object) -> str:
        return macro(**dict(zip(names, given, strict=False)), **words)

    return call


def _guarded(
    place: str, shipped: MacroText, macro: Callable[..., str], wanted: tuple[str, ...], template: Template
) -> Callable[..., str]:
    """The plant's macro with the words it asks for. What it raises, and what is no text, are its own faults."""
    from jinja2 import TemplateError as JinjaError

    path = place.rpartition(":")[0]

    def call(**words: object) -> str:
        try:
            text = macro(**{word: words[word] for word in wanted})
        except (JinjaError, *_FAULTS) as error:
            where = f"{path}:{_line(error, template)}"
            raise TemplateError(f"{where}: the macro {shipped.name} fails: {error}") from None
        if shipped.file == _STATEMENTS and not text.strip():
            raise TemplateError(f"{place}: the macro {shipped.name} gives no text, and its statement would be lost")
        if _NO_TEXT.search(text):
            raise TemplateError(f"{place}: the macro {shipped.name} gives control characters, which are no text")
        return text

    return call


def _line(error: BaseException, template: Template) -> int:
    """The line of the template that an error comes from."""
    lines = [
        template.get_corresponding_lineno(line)
        for frame, line in walk_tb(error.__traceback__)
        if frame.f_globals.get("__jinja_template__") is template
    ]
    return lines[-1] if lines else 1


def _line_of(name: str, text: str) -> int:
    """The line that a macro begins at."""
    found = re.search(rf"macro\s+{re.escape(name)}\s*\(", text)
    return text.count("\n", 0, found.start()) + 1 if found else 1


def _meant(word: str, known: Mapping[str, object] | tuple[str, ...]) -> str:
    close = get_close_matches(word, list(known), 1)
    if close:
        return f"; did you mean {close[0]}?"
    return f": there are {', '.join(known)}" if known else ""


__all__ = ["MacroText", "Macros", "TemplateError", "macro_files", "macro_texts", "macros_of"]
