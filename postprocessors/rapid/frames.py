"""The Jinja environment of this target's templates."""

from __future__ import annotations

from functools import cache
from importlib import resources

import jinja2


@cache
def environment() -> jinja2.Environment:
    folder = resources.files(__package__).joinpath("templates")
    texts = {entry.name: entry.read_text("utf-8") for entry in folder.iterdir() if entry.name.endswith(".j2")}
    return jinja2.Environment(
        loader=jinja2.DictLoader(texts), autoescape=False, undefined=jinja2.StrictUndefined, keep_trailing_newline=True
    )


@cache
def macros(name: str) -> object:
    """The macros of a template as an object."""
    return environment().get_template(name).module
