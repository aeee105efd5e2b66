"""What a shell completes: the names of robots and languages, and files. The word that help shows for an argument or an
option (its metavar) says which of them it takes."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import click
from click.shell_completion import CompletionItem

from rpl import registry

if TYPE_CHECKING:
    _Text = click.ParamType[str]
else:
    _Text = click.ParamType  # generic in newer releases only


def _robots() -> list[str]:
    from rpl.emulator.robotfile import robot_names

    return robot_names()


def _languages() -> list[str]:
    """Names, and the words that people use for them where they are one word."""
    words = {word for name in registry.dialect_names() for word in (name, *registry.dialect(name).aliases)}
    return sorted(word for word in words if " " not in word)


def _controllers() -> list[str]:
    from rpl.motionmodel import PLAIN_NAME

    return [PLAIN_NAME, *registry.dialect_names()]


def _nothing() -> list[str]:
    return []


class Named(_Text):
    """A text that is one of these names; where none of them begins so, perhaps a file."""

    name = "text"

    def __init__(self, names: Callable[[], list[str]], or_file: bool = True) -> None:
        self.names = names
        self.or_file = or_file

    def shell_complete(self, ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
        typed = incomplete.lower()
        found = [CompletionItem(name) for name in self.names() if name.startswith(typed)]
        return found or ([CompletionItem(incomplete, type="file")] if self.or_file else [])


_ROBOT, _LANGUAGE = Named(_robots), Named(_languages, or_file=False)
_FILE = Named(_nothing)
_TAKES = {
    "R": _ROBOT,
    "R2": _ROBOT,
    "[FILTER]...": Named(_robots, or_file=False),
    "D": _LANGUAGE,
    "NAME|F.toml": Named(_controllers),
    "F.toml": _FILE,
}


def completed(command: click.Command) -> click.Command:
    """The command with what its plain texts take, by their metavars; arguments without one take files."""
    for param in command.params:
        if param.type is click.STRING:
            if param.metavar in _TAKES:
                param.type = _TAKES[param.metavar]
            elif isinstance(param, click.Argument):
                param.type = _FILE
    return command
