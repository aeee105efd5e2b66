"""Keys of controllers: the one that is seen first is kept, and who shows another one later is another controller.

They stand in `known_keys.toml` below the profile's state folder, one line for each address and protocol. A key that the
profile names beforehand is the only one that counts.
"""

from __future__ import annotations

import os
from pathlib import Path

from rpl.controllers.link import OtherControllerError
from rpl.controllers.profile import Profile
from rpl.errors import UsageError
from rpl.source import read_bytes
from rpl.tomlfile import TomlError, read_toml

FILE = "known_keys.toml"
_LONGEST = 2**20
_HEAD = "# Keys of controllers as they were first seen. Take a line away when a controller was replaced on purpose.\n"


def check_key(profile: Profile, protocol: str, port: int, found: str, option: str = "host_key") -> None:
    """Is this fingerprint (`SHA256:...`) the controller's? `protocol`: `ssh` or `tls`; `option`: the key of the profile
    that may name the fingerprint. Raises OtherControllerError."""
    wanted = profile.option(option, "")
    if wanted:
        if wanted != found:
            raise OtherControllerError(f"{profile.name}: its key is {found}, and {option} says {wanted}")
        return
    path = profile.state_folder / FILE
    name = f"{protocol} {profile.host}:{port}"
    known = _read(path)
    if name not in known:
        _write(path, {**known, name: found})
    elif known[name] != found:
        raise OtherControllerError(
            f"{profile.name}: {profile.host}:{port} shows the key {found}, and it was {known[name]} before: this is "
            f"another controller, or somebody stands between; if it was replaced, take its line out of {path}"
        )


def _read(path: Path) -> dict[str, str]:
    if not path.exists():
        return {}
    try:
        table = read_toml(read_bytes(path, _LONGEST).decode("utf-8", "replace"))
    except TomlError as error:
        raise UsageError(error.at(str(path))) from None
    return {name: str(value) for name, value in table.items()}


def _write(path: Path, known: dict[str, str]) -> None:
    """Whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = [f'"{name}" = "{value}"\n' for name, value in sorted(known.items())]
    draft = path.with_name(f"{path.name}.{os.getpid()}.new")
    with draft.open("w", encoding="utf-8") as stream:
        stream.write(_HEAD + "".join(lines))
        stream.flush()
        os.fsync(stream.fileno())
    draft.replace(path)
