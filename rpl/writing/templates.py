"""The Jinja templates of a target, from the folder `templates` of its package."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment


@cache
def templates(package: str) -> Environment:
    """The environment with each `*.j2` file of the package's templates by its file name; block tags leave no lines."""
    from jinja2 import DictLoader, Environment, StrictUndefined

    folder = resources.files(package).joinpath("templates")
    texts = {entry.name: entry.read_text("utf-8") for entry in folder.iterdir() if entry.name.endswith(".j2")}
    return Environment(
        loader=DictLoader(texts), undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True, autoescape=False
    )
