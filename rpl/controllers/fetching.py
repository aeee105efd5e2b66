"""Taking the programs of a controller, as they are, byte for byte."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from rpl.controllers.link import Link, LostError, RefusedError
from rpl.controllers.planning import is_temporary
from rpl.controllers.profile import Profile
from rpl.controllers.rules import safe_name

Shown = Callable[[int, int], None]


@dataclass(frozen=True, slots=True)
class Fetched:
    """One file: its name, safe as a name here, and its bytes, or why there are none."""

    name: str
    data: bytes | None
    reason: str = ""


def fetched(link: Link, profile: Profile, everything: bool, show: Shown) -> Iterator[Fetched]:
    """The programs, one after the other (`everything`: all files that the controller lists). `show` is told how many
    of how many there are. A file that the controller refuses is told and the others go on. Raises LostError when the
    line is lost, GarbledError for names that lead elsewhere: what was given before stays good."""
    wanted = [
        one for one in link.files() if not is_temporary(one.name) and (everything or profile.rules.is_program(one.name))
    ]
    names = [safe_name(one.name) for one in wanted]  # all are looked at before anything is written
    for number, (one, name) in enumerate(zip(wanted, names, strict=True), 1):
        try:
            yield Fetched(name, link.fetch(one.name))
        except LostError:
            raise
        except RefusedError as error:
            yield Fetched(name, None, str(error))
        show(number, len(wanted))
