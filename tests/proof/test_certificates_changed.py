"""Whatever somebody does to a certificate: asking again ends in an answer or in one plain line, and what is compared
does not hold when it was changed.
"""

import copy
import json
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.cli.main import run

PART = "DEF part()\n$OUT[1]=TRUE\nWAIT SEC 0.5\n$OUT[1]=FALSE\nEND\n"
NAMED = "MODULE Part\n PROC main()\n  SetDO doGrip,1;\n  WaitTime 0.5;\n ENDPROC\nENDMODULE\n"
# No sign that leads out of the folder.
WORDS = st.one_of(
    st.sampled_from(["", "a", "b", "part", "none", "plain", "krl", "equal", "wait", "a/part.src", "x.toml"]),
    st.text(st.characters(exclude_characters="/.\\~"), max_size=6),
)
NUMBERS = st.one_of(
    st.integers(),
    st.floats(),
    st.sampled_from([0, -1, 1, 10**400, 2**64, float("nan"), float("inf"), 1e308, 1e-308, -0.0]),
)
VALUES = st.recursive(
    st.one_of(st.none(), st.booleans(), NUMBERS, WORDS),
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(WORDS, inner, max_size=3)),
    max_leaves=5,
)
Place = tuple[str | int, ...]


@pytest.fixture(scope="module", params=["prove", "translate"])
def good(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A certificate beside its programs, of both commands that make one."""
    folder = tmp_path_factory.mktemp("kept")
    for name, text in (("a", PART), ("b", PART.replace("SEC 0.5", "SEC 0.25+0.25"))):
        (folder / name).mkdir()
        (folder / name / "part.src").write_text(text)
    (folder / "cell.toml").write_text("seed = 2\n")
    (folder / "part.mod").write_text(NAMED)
    command = ["prove", str(folder / "a"), str(folder / "b")]
    if request.param == "translate":
        command = ["translate", str(folder / "part.mod"), "--to", "tp", "-o", str(folder / "out")]
    command += ["--cell", str(folder / "cell.toml"), "--certificate", str(folder / "proof.json")]
    assert run(command) == 0
    return folder / "proof.json"


def checked(path: Path) -> int:
    out, err = StringIO(), StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        status = run(["prove", "--check", str(path)])
    assert status in (0, 1, 2), err.getvalue()
    if status == 2:
        assert not out.getvalue()
        assert err.getvalue().startswith(f"rpl: {path}: ") and err.getvalue().count("\n") == 1
    else:
        assert out.getvalue().startswith("the certificate ")
    return status


def places(value: Any, at: Place = ()) -> Iterator[Place]:
    """Of everything in a document."""
    yield at
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, one in pairs:
        yield from places(one, (*at, key))


@settings(max_examples=250)
@given(st.data())
def test_a_changed_certificate_ends_in_an_answer_or_a_plain_line(good: Path, data: st.DataObject) -> None:
    document = json.loads(good.read_text("utf-8"))
    changed, at = copy.deepcopy(document), data.draw(st.sampled_from(list(places(document))))
    if not at:
        changed = data.draw(VALUES)
    else:
        home = changed
        for key in at[:-1]:
            home = home[key]
        match data.draw(st.sampled_from(["replace", "leave out", "add"])):
            case "replace":
                home[at[-1]] = data.draw(VALUES)
            case "leave out":
                del home[at[-1]]
            case _ if isinstance(home, dict):
                home[data.draw(WORDS)] = data.draw(VALUES)
            case _:
                home.append(data.draw(VALUES))
    path = good.with_name("changed.json")
    path.write_text(json.dumps(changed), "utf-8")
    status = checked(path)
    compared = ("format", "programs", "files", "tolerance", "verdict")
    if at and at[0] in compared and changed.get(at[0]) != document[at[0]]:
        assert status != 0


@settings(max_examples=100)
@given(st.integers(0, 10_000), st.binary(max_size=3), st.integers(0, 5), st.booleans())
def test_a_damaged_certificate_ends_in_an_answer_or_a_plain_line(
    good: Path, at: int, new: bytes, left_out: int, cut: bool
) -> None:
    data = good.read_bytes()
    at %= len(data)
    path = good.with_name("damaged.json")
    path.write_bytes(data[:at] + new if cut else data[:at] + new.replace(b"/", b"") + data[at + left_out :])
    checked(path)
