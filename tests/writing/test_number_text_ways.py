"""Two ways to the text of a number: the quick one gives what the exact one gives, or nothing."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from rpl.writing.text import ALWAYS_POINT, PLAIN, NumberStyle, _exact_text, _usual_text

STYLES = (PLAIN, ALWAYS_POINT, NumberStyle(exponent=""), NumberStyle(exponent="", always_point=True))
NUMBERS = st.one_of(
    st.floats(-2e4, 2e4, allow_nan=False),
    st.builds(lambda whole, places: whole / 10**places, st.integers(-(10**8), 10**8), st.integers(0, 9)),
    st.builds(  # about the middle between two last places, with noise in the last bits
        lambda whole, places, noise: (whole + 0.5) / 10**places + noise * 1e-12,
        *(st.integers(-(10**7), 10**7), st.integers(0, 6), st.integers(-(10**4), 10**4)),
    ),
)


@given(NUMBERS.filter(bool), st.sampled_from((None, 0, 1, 2, 3, 4, 6, 9)), st.sampled_from(STYLES))
@settings(max_examples=3000, deadline=None)
def test_the_quick_text_is_the_exact_one(value: float, decimals: int | None, style: NumberStyle) -> None:
    assert _usual_text(value, decimals, style) in ("", _exact_text(value, decimals, style))


def test_most_numbers_go_the_quick_way() -> None:
    assert all(_usual_text(400.0 + at / 7.0, 6, PLAIN) for at in range(100))
