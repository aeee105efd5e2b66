"""Which controller is meant: a name in `rpl.toml`, or an address such as `ftp://10.0.0.5:2121/md:`.

    [controllers.cell1]
    url = "ur://10.0.0.5"            # or: vendor = "ur", host = "10.0.0.5", port = 22, path = "/programs"
    user = "root"
    password_env = "CELL1_PASSWORD"  # or: keyring = "cell1"; never the password itself
    encoding = "utf-8"
    identity = { serial = "20195599999" }

Passwords come from the environment, the keyring of the system, or a question on the terminal: none stands in a file,
and none is guessed.
"""

from __future__ import annotations

import codecs
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

from rpl.controllers.link import PATIENCE_S
from rpl.controllers.profile import Profile
from rpl.controllers.vendors import vendor
from rpl.errors import UsageError
from rpl.source import read_bytes
from rpl.tomlfile import Lines, TomlError, key_lines, line_of, read_toml

FILE = "rpl.toml"
_LONGEST_PROFILE = 2**20
_KEYS = {
    "url": str,
    "vendor": str,
    "host": str,
    "port": int,
    "path": str,
    "user": str,
    "password_env": str,
    "keyring": str,
    "encoding": str,
    "line_ends": str,
    "tasks": list,
    "ports": dict,
    "identity": dict,
    "patience_s": float,
    "robot": str,
}
_LINE_ENDS = ("", "lf", "crlf")
_SAID = ("maker", "model", "serial", "firmware", "name")


def profile_named(name: str, file: Path | None = None) -> Profile:
    """The controller of that name in `rpl.toml` (that file, or the nearest one above the present folder), or of that
    address. Raises UsageError."""
    if "://" in name:
        return _of_table(name, {"url": name}, {}, "", Path(".rpl"))
    path = file if file is not None else _nearest()
    if path is None:
        raise UsageError(f"no controller {name!r}: there is no {FILE} here or above, and it is no address (ur://HOST)")
    text = read_bytes(path, _LONGEST_PROFILE).decode("utf-8", "replace")
    try:
        tables = read_toml(text).get("controllers", {})
    except TomlError as error:
        raise UsageError(error.at(str(path))) from None
    if not isinstance(tables, dict) or not isinstance(tables.get(name), dict):
        names = ", ".join(sorted(tables)) if isinstance(tables, dict) else ""
        raise UsageError(f"no controller {name!r} in {path}: there {'are ' + names if names else 'is none'}")
    return _of_table(name, tables[name], key_lines(text), str(path), path.parent / ".rpl")


def _nearest() -> Path | None:
    here = Path.cwd()
    return next((path for folder in (here, *here.parents) if (path := folder / FILE).is_file()), None)


def _of_table(name: str, table: Mapping[str, Any], lines: Lines, file: str, state: Path) -> Profile:
    """Checks every key, with its line."""

    def wrong(key: str, text: str) -> UsageError:
        line = line_of(lines, f"controllers.{name}.{key}") if file else 0
        return UsageError(f"{file}:{line}: {key}: {text}" if line else f"{file or name}: {key}: {text}")

    url = _parts(str(table.get("url", "")), wrong)
    said = {**url, **table}
    if "vendor" not in said:
        raise wrong("vendor", "which maker's controller is it? Give url or vendor")
    made = vendor(str(said["vendor"]))
    for key, value in table.items():
        kind = _KEYS.get(key, str if key in made.options else None)
        if kind is None:
            if "password" in key:
                raise wrong(key, "no password stands in this file: name password_env or keyring")
            raise wrong(key, f"there is no such key; there are {', '.join([*_KEYS, *made.options])}")
        if (not isinstance(value, kind) and not (kind is float and isinstance(value, int))) or isinstance(value, bool):
            raise wrong(key, f"{value!r} is no {kind.__name__}")
    for key, value in (("port", said.get("port")), *(("ports", one) for one in said.get("ports", {}).values())):
        if value is not None and not (isinstance(value, int) and 0 < value < 2**16):
            raise wrong(key, f"{value!r} is no port")
    encoding, ends, patience = str(said.get("encoding", "")), str(said.get("line_ends", "")), said.get("patience_s")
    if encoding and not _is_encoding(encoding):
        raise wrong("encoding", f"{encoding!r} is not known")
    if ends not in _LINE_ENDS:
        raise wrong("line_ends", "lf or crlf")
    if patience is not None and not 0.0 < patience <= 3600.0:
        raise wrong("patience_s", "a time in s")
    unknown = set(said.get("ports", {})) - set(made.ports)
    if unknown:
        raise wrong("ports", f"there is no interface {min(unknown)!r}; there are {', '.join(made.ports)}")
    unsaid = set(said.get("identity", {})) - set(_SAID)
    if unsaid:
        raise wrong("identity", f"there is no {min(unsaid)!r}; there are {', '.join(_SAID)}")
    return Profile(
        name,
        made.name,
        made.rules,
        made.ports,
        made.path,
        host=str(said.get("host", "")),
        port=said.get("port"),
        path=str(said.get("path", "")),
        user=str(said.get("user", "")),
        password_env=str(said.get("password_env", "")),
        keyring=str(said.get("keyring", "")),
        encoding=encoding,
        line_ends=ends,
        tasks=tuple(map(str, said.get("tasks", ()))),
        ports=dict(said.get("ports", {})),
        identity={key: str(value) for key, value in said.get("identity", {}).items()},
        patience_s=float(patience) if patience is not None else PATIENCE_S,
        robot=str(said.get("robot", "")),
        options={key: str(table[key]) for key in made.options if key in table},
        state_folder=state,
    )


def _parts(url: str, wrong: Any) -> dict[str, Any]:
    """vendor, host, port, user and path of an address; no password stands in one."""
    if not url:
        return {}
    try:
        found = urlsplit(url)
        port = found.port
    except ValueError as error:
        raise wrong("url", f"{url!r} is no address: {error}") from None
    if not found.scheme or "://" not in url:
        raise wrong("url", f"{url!r} is no address: write maker://host:port/path")
    if found.password is not None:
        raise wrong("url", "no password stands in an address: name password_env or keyring in rpl.toml")
    parts: dict[str, Any] = {"vendor": found.scheme, "host": found.hostname or "", "path": unquote(found.path)}
    if port is not None:
        parts["port"] = port
    if found.username:
        parts["user"] = unquote(found.username)
    return {key: value for key, value in parts.items() if value != ""}


def _is_encoding(name: str) -> bool:
    try:
        codecs.lookup(name)
    except LookupError:
        return False
    return True
