"""Reading a signal: each time the task notes that it looked, and at which inputs, for who asks what it waits for."""

from __future__ import annotations

from collections.abc import Callable

from rpl.runtime.code import Read, Values
from rpl.runtime.signals import is_bit_group, key_of, zero_of
from rpl.runtime.values import SignalRef, Value


def signal_reader(port: Callable[[Values], SignalRef] | SignalRef, kind: str) -> Read:
    """Gives the value of a signal, or of a group of bits. kind: of a signal that only running can tell."""
    if not isinstance(port, SignalRef):
        return _dynamic(port, kind.endswith("_in"))
    given = port.kind.endswith("_in")
    if is_bit_group(port):
        return _dynamic(lambda f: port, given)
    key, kind, zero = key_of(port), port.kind, zero_of(port.kind)

    def read(f: Values) -> Value:
        task = f[0]
        task.looked = True
        if given:
            task.inputs[port] = task.machine.now
        value = task.signals.get(key)
        if value is not None:
            return value
        return task.machine.read_unset(key, kind) if key.__class__ is str else zero

    return read


def _dynamic(port: Callable[[Values], SignalRef], given: bool) -> Read:
    def read(f: Values) -> Value:
        task, signal = f[0], port(f)
        task.looked = True
        if given:
            task.inputs[signal] = task.machine.now
        return task.machine.read(signal)

    return read
