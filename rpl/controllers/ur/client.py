"""The client: files by SFTP, who and what state by the dashboard, values by RTDE. Nothing here starts anything."""

from __future__ import annotations

from rpl.controllers.link import Identity, State
from rpl.controllers.profile import Profile
from rpl.controllers.sftp.client import SftpLink
from rpl.controllers.ur.dashboard import Dashboard, identity_by, state_by


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
