"""Words of the language one by one: what the manual says of each, as expectations that a run meets."""

from __future__ import annotations

import pytest
from urscript_helpers import codes, holds, read

# The lines before, and what holds behind them.
CASES = {
    "parts of poses by computed numbers": (
        "a = p[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]\ni = 1\na[i + 1] = a[i] * 2",
        "norm(a[i] - 0.2) < 0.0001 and norm(a[i + 3] - 0.5) < 0.0001",
        "norm(a[2] - 0.4) < 0.0001",
    ),
    "whole numbers of bits": (
        "b = [False, True, True]\nn = integer_to_binary_list(-5)\nn[0] = False",
        "binary_list_to_integer([True, False, False, True]) == 9",
        "binary_list_to_integer(b) == 6",
        "binary_list_to_integer(n) == -6",
        "binary_list_to_integer([]) == 0",
    ),
    "bits of what a function gives": (
        "def five():\nreturn 5\nend\nb = integer_to_binary_list(five())",
        "b[0] and not b[1] and b[2]",
    ),
    "texts of values": (
        "x = 2.123456123456\ny = 2.5\nt = True\nl = [1, 2, 3]\nn = -3",
        'to_str(x) == "2.123456" and to_str(2.123456123456) == "2.123456"',
        'to_str(y) == "2.5" and to_str(n) == "-3" and to_str(t) == "True"',
        'to_str(p[1.0, 2.0, 3.0, 0.0, 0.0, 0.0]) == "p[1, 2, 3, 0, 0, 0]"',
        'to_str(l) == "[1, 2, 3]" and to_str([True, False]) == "[True, False]"',
        'str_cat([True, False, True], [1, 0, 1]) == "[True, False, True][1, 0, 1]"',
    ),
    "numbers of texts": ("", 'to_num("0x3A") == 58', 'norm(to_num("-3.0e5") + 300000) < 0.1', 'to_num(" +5.") == 5'),
    "what a thread gives": (
        "n = 0\nthread t():\nn = n + 1\nreturn False\nend\nh = run t()\njoin h",
        "n == 1",
    ),
    "the controller's time": (
        "t = time()\nsleep(1.5)\ns = time(0).sec - t.sec\ns = s + (time().nanosec - t.nanosec) / 1000000000",
        "norm(s - 1.5) < 0.01",
    ),
    "the load": (
        "set_payload(1.5, [0, 0, 0.05])\nset_payload_cog([0.01, 0, 0.06])\nc = get_target_payload_cog()",
        "norm(c[2] - 0.06) < 0.0001 and norm(get_target_payload() - 1.5) < 0.0001",
    ),
    "what is left of a division": (
        "def f():\nreturn 7.5\nend\nx = 7.5\nn = -17",
        "norm(x % 2 - 1.5) < 0.0001 and norm(f() % 2 - 1.5) < 0.0001",
        "17 % 5 == 2",
    ),
    "what is within reach": (
        "movej([0, -1.57, 1.57, -1.57, -1.57, 0])",
        "is_within_safety_limits(get_actual_tcp_pose()) and not is_within_safety_limits(p[3, 0, 0, 0, 0, 0])",
        "is_within_safety_limits([0, -1.5, 1.5, 0, 0.5, 0])",
    ),
    "a vector of length 1": (
        "v = [3, 0, 4]\nn = normalize(v)",
        "norm(n[0] - 0.6) < 0.0001 and norm(n[2] - 0.8) < 0.0001",
        "norm(norm(normalize([1.0, 2.0, 2.0])) - 1) < 0.0001",
    ),
    "an assertion that holds": ("a = 1\nassert(a == 1)\na = 2", "a == 2"),
}


@pytest.mark.parametrize("name", CASES)
def test_words(name: str) -> None:
    lines, *expectations = CASES[name]
    holds(lines, *expectations)


def test_an_assertion_that_fails_ends_the_program() -> None:
    with pytest.raises(AssertionError):
        holds("assert(1 == 2)", "True")


def test_settings_of_encoders_are_read() -> None:
    _, diagnostics = read("def p():\nencoder_enable_set_tick_count(0, 0)\nencoder_set_tick_count(0, 12)\nend\n")
    assert codes(diagnostics) == []
