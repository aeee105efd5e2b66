"""The only door to the makers' folders: found by their names, imported when asked for.

A folder `rpl/controllers/<name>/` has `VENDOR` in its `__init__`; its parts are modules that are imported when they are
needed: `client` has `connect(profile) -> Link`, `status(profile) -> Status` and `watch(profile, names, period_s)`;
`server` has `start(cabinet, endpoints)`, its virtual controller.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pkgutil import iter_modules
from typing import TYPE_CHECKING, cast

from rpl import controllers
from rpl.controllers.rules import SendingRules
from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.controllers.link import Link
    from rpl.controllers.profile import Profile
    from rpl.controllers.showing import Sample, Status
    from rpl.controllers.virtual.cabinet import Cabinet
    from rpl.controllers.virtual.endpoints import Endpoints


@dataclass(frozen=True, slots=True)
class Vendor:
    """A maker of controllers, or a plain way of carrying files. `package`: its folder as a module. `ports`: those that
    its client uses, by what they are for; `needs`: the extra of this package that its client needs, empty: none.
    `dialect`: the language of its programs, None for a way of carrying files. `options`: further keys that a profile
    may have, each with what it says."""

    package: str
    title: str
    ports: Mapping[str, int]
    path: str
    rules: SendingRules
    dialect: str | None = None
    needs: str = ""
    options: Mapping[str, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        return self.package.rpartition(".")[2]

    def connect(self, profile: Profile) -> Link:
        """A connection. Raises LinkError, or UsageError when the extra is not installed."""
        return cast("Callable[[Profile], Link]", self._part("client", "connect"))(profile)

    @property
    def status(self) -> Callable[[Profile], Status] | None:
        """Asks what the controller is doing; None where its interfaces do not say."""
        return cast("Callable[[Profile], Status] | None", self._part("client", "status"))

    @property
    def watch(self) -> Callable[[Profile, Sequence[str], float], Iterator[Sample]] | None:
        """Gives values as they change; None where no interface does."""
        return cast("Callable[[Profile, Sequence[str], float], Iterator[Sample]] | None", self._part("client", "watch"))

    @property
    def start(self) -> Callable[[Cabinet, Endpoints], Awaitable[None]] | None:
        """Opens the interfaces of its virtual controller; None where there is none."""
        return cast("Callable[[Cabinet, Endpoints], Awaitable[None]] | None", self._part("server", "start"))

    def _part(self, part: str, name: str) -> object:
        place = f"{self.package}.{part}"
        if find_spec(place) is None:
            return None
        try:
            return getattr(import_module(place), name, None)
        except ModuleNotFoundError as error:
            if not self.needs or (error.name or "").startswith("rpl."):
                raise
            raise UsageError(
                f"{self.title} needs the package {error.name}: pip install 'robot-rpl[{self.needs}]'"
            ) from None


@cache
def vendors() -> tuple[Vendor, ...]:
    """All of them, in the order of their names."""
    found = []
    for module in iter_modules(controllers.__path__, f"{controllers.__name__}."):
        if module.ispkg and (vendor := getattr(import_module(module.name), "VENDOR", None)) is not None:
            found.append(cast("Vendor", vendor))
    return tuple(found)


def vendor(name: str) -> Vendor:
    """The one of that name. Raises UsageError with the names that there are."""
    for one in vendors():
        if one.name == name.lower():
            return one
    names = [one.name for one in vendors()]
    close = get_close_matches(name.lower(), names, 1)
    hint = f"did you mean {close[0]}?" if close else f"there are {', '.join(names)}"
    raise UsageError(f"no controller {name!r}; {hint}")
