"""What transfers and commands use of ABB controllers. Looking at one needs a websocket, files do not."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rpl.controllers.abb.rws import RwsLink, connect
from rpl.controllers.profile import Profile
from rpl.controllers.showing import Sample, Status

__all__ = ["RwsLink", "connect", "status", "watch"]


def status(profile: Profile) -> Status:
    """One look. Raises LinkError."""
    from rpl.controllers.abb import looking

    return looking.status(profile)


def watch(profile: Profile, names: Sequence[str], period_s: float) -> Iterator[Sample]:
    """Values as they change. Raises LinkError."""
    from rpl.controllers.abb import looking

    return looking.watch(profile, names, period_s)
