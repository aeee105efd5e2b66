"""Which controller is meant: `rpl.toml` and addresses, and what is wrong in them, with its line."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.controllers.profiles import profile_named
from rpl.controllers.rules import safe_name
from rpl.controllers.vendors import vendors
from rpl.errors import UsageError

GOOD = """
[controllers.line1]
vendor = "folder"
path = "/mnt/robot"
user = "operator"
password_env = "LINE1"
encoding = "cp1252"
line_ends = "crlf"
tasks = ["T_ROB1"]
patience_s = 3
identity = { serial = "17" }
"""


def test_a_profile_says_everything(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "rpl.toml"
    file.write_text(GOOD, encoding="utf-8")
    (tmp_path / "below").mkdir()
    monkeypatch.chdir(tmp_path / "below")
    monkeypatch.setenv("LINE1", "secret")
    profile = profile_named("line1")
    assert (profile.maker, profile.folder, profile.text_encoding, profile.text_line_ends) == (
        "folder",
        "/mnt/robot",
        "cp1252",
        "crlf",
    )
    assert profile.password == "secret"
    assert profile.patience_s == 3.0
    assert profile.state_folder == tmp_path / ".rpl"
    assert "secret" not in repr(profile)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('[controllers.a]\nhost = "x"\n', "rpl.toml:1: vendor: which maker's"),
        ('[controllers.a]\nvendor = "foldr"\n', "did you mean folder"),
        (
            '[controllers.a]\nvendor = "folder"\npassword = "x"\n',
            "rpl.toml:3: password: no password stands in this file",
        ),
        ('[controllers.a]\nvendor = "folder"\n\nport = 99999\n', "rpl.toml:4: port: 99999 is no port"),
        ('[controllers.a]\nvendor = "folder"\nencoding = "klingon"\n', "rpl.toml:3: encoding: 'klingon' is not known"),
        ('[controllers.a]\nvendor = "folder"\nline_ends = "cr"\n', "rpl.toml:3: line_ends: lf or crlf"),
        ('[controllers.a]\nvendor = "folder"\nidentity = { sirial = "1" }\n', "there is no 'sirial'"),
        ('[controllers.a]\nvendor = "folder"\npath = 3\n', "rpl.toml:3: path: 3 is no str"),
        ('[controllers.b]\nvendor = "folder"\n', "no controller 'a' in"),
        ("[controllers.a\n", "rpl.toml:1:"),
    ],
)
def test_what_is_wrong_in_a_profile_is_said_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "rpl.toml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(UsageError) as error:
        profile_named("a", file)
    assert said in str(error.value)


@pytest.mark.parametrize(
    ("address", "said"),
    [
        ("folder://user:secret@host/x", "no password stands in an address"),
        ("nowhere://host", "no controller 'nowhere'"),
        ("folder://host:99999999/", "is no address"),
    ],
)
def test_what_is_wrong_in_an_address_is_said(address: str, said: str) -> None:
    with pytest.raises(UsageError) as error:
        profile_named(address)
    assert said in str(error.value)
    assert "secret" not in str(error.value) or "secret@" in address


def test_without_a_file_it_is_said_what_a_name_may_be(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match="no address"):
        profile_named("cell1")


@pytest.mark.parametrize(
    "name", ["../x", "a/../../x", "/etc/passwd", "a//b", "C:x", "con.src", "a\x00b", " a", "x" * 300, "", "a\\..\\b"]
)
def test_names_that_lead_elsewhere_are_refused(name: str) -> None:
    from rpl.controllers.link import GarbledError

    with pytest.raises(GarbledError):
        safe_name(name)


def test_every_maker_says_what_it_sends_and_what_never() -> None:
    assert vendors()
    for one in vendors():
        assert one.title
        assert one.rules.programs
        if one.dialect is not None:
            assert one.rules.denied, f"{one.name} has files that must never be sent"
