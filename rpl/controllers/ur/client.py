"""The client: files by SFTP, who and what state by the dashboard, values by RTDE. Nothing here starts anything."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rpl.controllers.link import Identity, State
from rpl.controllers.profile import Profile
from rpl.controllers.sftp.client import SftpLink
from rpl.controllers.showing import Sample, Status
from rpl.controllers.ur.dashboard import Dashboard, identity_by, state_by
from rpl.controllers.ur.exchange import degrees, now, signals_of, watched


class UrLink(SftpLink):
    """Files below /programs. Each question about the state is asked anew by a connection of its own."""

    def identity(self) -> Identity:
        with Dashboard(self.profile) as dashboard:
            return identity_by(dashboard)

    def state(self) -> State:
        with Dashboard(self.profile) as dashboard:
            return state_by(dashboard, self.profile.folder)


def connect(profile: Profile) -> UrLink:
    """Raises LinkError."""
    return UrLink(profile)


_LOOK = ("actual_q", "actual_TCP_pose", "actual_digital_input_bits", "actual_digital_output_bits", "speed_scaling")


def status(profile: Profile) -> Status:
    """Who it is and what it does by the dashboard, where it is and its signals by RTDE. Raises LinkError."""
    with Dashboard(profile) as dashboard:
        identity, state = identity_by(dashboard), state_by(dashboard, profile.folder)
    values = now(profile, _LOOK)
    pose = values["actual_TCP_pose"]
    place = pose if isinstance(pose, tuple) else (0.0,) * 6
    signals = {**signals_of(values), "speed_scaling": float(_number(values["speed_scaling"]))}
    return Status(
        identity,
        state,
        degrees(values["actual_q"]),
        tuple(1000.0 * float(part) for part in place[:3]),
        dict(zip(("rx", "ry", "rz"), (float(part) for part in place[3:]), strict=True)),
        signals,
    )


def _number(value: object) -> float:
    return float(value) if isinstance(value, (int, float)) else 0.0


def watch(profile: Profile, names: Sequence[str], period_s: float) -> Iterator[Sample]:
    """Values as they change, by RTDE. Raises LinkError."""
    return watched(profile, names, period_s)
