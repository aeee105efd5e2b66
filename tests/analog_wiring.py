"""Analogue modules for tests that are about something else: 0 to 10 V count 0 to 10 where a configuration decides."""

from rpl.ir.analog import AnalogRange, AnalogSetting

_TEN_VOLTS = AnalogRange((0.0, 10.0), (0.0, 10.0))
WIRED = tuple(
    AnalogSetting(language, f"{word}{number}", _TEN_VOLTS)
    for language in ("rapid", "tp")
    for word in ("ai", "ao")
    for number in range(1, 9)
)
