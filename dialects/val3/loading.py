"""What a Staubli controller refuses when it loads an application (VAL3)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from rpl.checks.loading import Listing, Loader, Place, Rule, Trust, longer, twice

_POST = "public generators of applications"
_BLANKS = re.compile(r"(?<=[\s\]])//[^\r\n]*")


def _lacking(listings: Sequence[Listing]) -> Iterator[Place]:
    """Applications without the programs start and stop: their project file."""
    names = {Path(listing.source.path).name.lower() for listing in listings}
    for listing in listings:
        if listing.source.path.lower().endswith(".pjx") and not {"start.pgx", "stop.pgx"} <= names:
            yield Place(listing, 0, 1)


RULES = (
    Rule(
        "val3-programs",
        "an application has the programs start and stop",
        "the application is not opened",
        "write both",
        _POST,
        Trust.COUNTED,
        _lacking,
    ),
    Rule(
        "val3-name-length",
        "names of programs and data have at most 15 characters",
        "the application is not opened",
        "shorten the name",
        _POST,
        Trust.COUNTED,
        longer(r"<(?:Program|Data|Local|Parameter)[ \t]+name=\"([^\"\r\n]*)\"", 15),
    ),
    Rule(
        "val3-data-once",
        "data of an application have names of their own",
        "the application is not opened",
        "rename one of them",
        _POST,
        Trust.M,
        twice(r"<Data[ \t]+name=\"([^\"\r\n]*)\"", capitals=True),
    ),
)
LOADER = Loader(RULES, _BLANKS)
