"""What a run that waits for good says: the inputs that its condition or its loop looks at, with the program's names."""

from __future__ import annotations

from helpers import run


def test_a_wait_names_the_inputs_that_are_hidden_behind_names() -> None:
    result = run("krl", "DEF P0( )\nSIGNAL READY $IN[7]\nWAIT FOR READY\nEND")
    assert result.status == "deadlock" and result.fault is not None
    assert "WAIT FOR READY" in result.fault.message and "$IN[7]" in result.fault.message
    (waiting,) = result.awaited
    assert waiting.kind == "condition" and [name for name, _ in waiting.inputs] == ["$IN[7] (READY)"]


def test_a_loop_that_polls_names_what_it_looks_at() -> None:
    result = run("krl", "DEF P0( )\nWHILE NOT $IN[1]\nENDWHILE\nEND")
    assert result.status == "deadlock" and result.fault is not None
    assert "$IN[1] that nothing changes" in result.fault.message
    slow = run("krl", "DEF P0( )\nWHILE NOT $IN[1]\nWAIT SEC 1\nENDWHILE\nEND")
    assert slow.status == "limit" and [name for one in slow.awaited for name, _ in one.inputs] == ["$IN[1]"]


def test_inputs_of_an_earlier_wait_are_not_named() -> None:
    body = "IF $IN[3] THEN\nHALT\nENDIF\nWAIT FOR $IN[4]"
    result = run("krl", f"DEF P0( )\n{body}\nEND")
    assert [name for one in result.awaited for name, _ in one.inputs] == ["$IN[4]"]
