"""The whole way: a program is legalised, written in the other language, read back, and still shows the same."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.legalise import Context, legalise
from rpl.project import read_sources
from rpl.source import source_from_bytes
from rpl.writing.target import WriteContext

from .common import ANALOG, read
from .machine import run
from .test_errors import _RAPID as _ERRORS
from .test_generated import _KRL, _RAPID, bodies, handlers, krl_bodies
from .test_waits import _RAPID as _WAITS


def written(program: ir.Program, source: str, target: str) -> ir.Program:
    """The program as its translation reads; nothing may be lost."""
    diagnostics = Diagnostics()
    writer = registry.target(target)
    context = Context(source, target, writer.capabilities(), diagnostics, analog=ANALOG)
    legal = legalise(program, context, writer.passes())
    files = writer.write(legal, WriteContext(diagnostics))
    back = read_sources([source_from_bytes(file.path, file.data) for file in files], target, diagnostics).program
    assert not [item.as_text() for item in diagnostics if item.severity >= Severity.LOSS]
    return back


def shown(program: ir.Program, inputs: Any = None) -> list[Any]:
    """What a run shows, apart from names of signals and the message that an error is not handled."""
    trace = [one for one in run(program, "main", inputs) if "is not handled" not in str(one)]
    return [("output", round(float(one[2]), 6)) if one[0] == "output" else one for one in trace]


def compare(program: ir.Program, source: str, target: str, inputs: Any = None) -> None:
    before, after = shown(program, inputs), shown(written(program, source, target), inputs)
    if ("end", "limit") in (before[-1], after[-1]):
        common = min(len(before), len(after)) - 1
        before, after = before[:common], after[:common]
    assert after == before


_SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large]


def _from_rapid_to_krl(inner: str, caught: str, main: str, last: str) -> None:
    compare(read("rapid", _RAPID % (inner, caught, main, last)), "rapid", "krl")


@settings(max_examples=7, deadline=None, suppress_health_check=_SLOW)
@given(bodies(), handlers(), st.lists(bodies(), min_size=1, max_size=3).map(" ".join), handlers())
def test_from_rapid_to_krl(inner: str, caught: str, main: str, last: str) -> None:
    _from_rapid_to_krl(inner, caught, main, last)


@pytest.mark.slow
@settings(max_examples=20, deadline=None, suppress_health_check=_SLOW)
@given(bodies(), handlers(), st.lists(bodies(), min_size=1, max_size=3).map(" ".join), handlers())
def test_many_from_rapid_to_krl(inner: str, caught: str, main: str, last: str) -> None:
    _from_rapid_to_krl(inner, caught, main, last)


def _from_krl_to_rapid(body: str) -> None:
    compare(read("krl", _KRL % f"i = 0\nk = 0\n{body}"), "krl", "rapid")


@settings(max_examples=7, deadline=None, suppress_health_check=_SLOW)
@given(st.lists(krl_bodies(), min_size=1, max_size=3).map("\n".join))
def test_from_krl_to_rapid(body: str) -> None:
    _from_krl_to_rapid(body)


@pytest.mark.slow
@settings(max_examples=20, deadline=None, suppress_health_check=_SLOW)
@given(st.lists(krl_bodies(), min_size=1, max_size=3).map("\n".join))
def test_many_from_krl_to_rapid(body: str) -> None:
    _from_krl_to_rapid(body)


@pytest.mark.parametrize(
    "text",
    [
        _ERRORS % ("x:=noisy(1)+value(2)+noisy(3); show x;", "ERROR show ERRNO; RETRY;"),
        _ERRORS % ("WHILE yes(1) AND n<6 DO show n; ENDWHILE", "ERROR show ERRNO; TRYNEXT;"),
        _ERRORS % ("show safe(5); show safe(0);", ""),
        _ERRORS % ("WaitUntil n=1\\MaxTime:=2; show 1;", "ERROR show 2; n:=1; RETRY;"),
        _WAITS % "ClkReset c1; ClkStart c1; WaitTime 1.5; ClkStop c1; WaitTime 1; show ClkRead(c1);",
        _WAITS % "ClkReset many{1}; n:=1; ClkStart many{n}; WaitTime 1; watch many{n}; show ClkRead(many{1});",
    ],
)
def test_errors_waits_and_clocks_in_krl(text: str) -> None:
    compare(read("rapid", text), "rapid", "krl")
