"""Which controller is meant, and how it is reached: the data of one, wherever it was written down."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from importlib import import_module
from pathlib import Path

from rpl.controllers.link import PATIENCE_S, Identity
from rpl.controllers.rules import SendingRules
from rpl.errors import UsageError


@dataclass(frozen=True)
class Profile:
    """One controller. `maker`: the name of its maker's folder, of which rules, ports and path are. `name`: of its
    table, or its address. `port`: for files, None: the maker's usual one. `ports`: those of other interfaces, by
    name. `identity`: what it must say about itself. `state_folder`: where backups, journals and pinned keys are."""

    name: str
    maker: str
    rules: SendingRules
    usual_ports: Mapping[str, int]
    usual_path: str = ""
    host: str = ""
    port: int | None = None
    path: str = ""
    user: str = ""
    password_env: str = ""
    keyring: str = ""
    encoding: str = ""
    line_ends: str = ""
    tasks: tuple[str, ...] = ()
    ports: Mapping[str, int] = field(default_factory=dict)
    identity: Mapping[str, str] = field(default_factory=dict)
    patience_s: float = PATIENCE_S
    robot: str = ""
    options: Mapping[str, str] = field(default_factory=dict)
    state_folder: Path = Path(".rpl")
    given_password: str | None = field(default=None, repr=False)

    def port_of(self, interface: str) -> int:
        """The port of an interface, by the name that its maker's folder gives it. The first one of the maker's table
        carries files: the port of an address is that one."""
        usual = self.usual_ports[interface]
        if interface in self.ports:
            return self.ports[interface]
        first = next(iter(self.usual_ports))
        return self.port if self.port is not None and interface == first else usual

    @property
    def text_encoding(self) -> str:
        return self.encoding or self.rules.encoding

    @property
    def text_line_ends(self) -> str:
        return self.line_ends or self.rules.line_ends

    @property
    def folder(self) -> str:
        """Where the programs are on the controller."""
        return self.path or self.usual_path

    @property
    def address(self) -> str:
        """maker://host:port/path."""
        at = f"{self.host}:{self.port}" if self.port is not None else self.host
        return f"{self.maker}://{at}{self.folder if self.folder.startswith('/') else '/' + self.folder}"

    def option(self, name: str, usual: str) -> str:
        """A key that only this maker has."""
        return self.options.get(name, usual)

    @cached_property
    def password(self) -> str:
        """From where the profile says; asked for on a terminal. Raises UsageError when there is none."""
        if self.given_password is not None:
            return self.given_password
        if self.password_env:
            if self.password_env not in os.environ:
                raise UsageError(
                    f"{self.name}: the environment has no {self.password_env}, which is to hold the password"
                )
            return os.environ[self.password_env]
        if self.keyring:
            return _from_keyring(self.name, self.keyring, self.user)
        if not sys.stdin.isatty():
            raise UsageError(f"{self.name}: a password is asked for: name password_env or keyring in rpl.toml")
        import getpass

        return getpass.getpass(f"password of {self.user} at {self.name}: ", sys.stderr)

    def wrong_identity(self, found: Identity) -> list[str]:
        """What the controller says about itself that the profile says otherwise."""
        said = found.said()
        return [
            f"{word} is {said.get(word) or 'not said'}, and {self.name} is to have {wanted}"
            for word, wanted in self.identity.items()
            if said.get(word) != wanted
        ]


def _from_keyring(name: str, service: str, user: str) -> str:
    try:
        keyring = import_module("keyring")
    except ModuleNotFoundError:
        raise UsageError(f"{name}: a password in the keyring needs the package keyring: pip install keyring") from None
    found = keyring.get_password(service, user)
    if found is None:
        raise UsageError(f"{name}: the keyring has no password of {user!r} for {service!r}")
    return str(found)
