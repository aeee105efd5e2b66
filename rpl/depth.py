"""Room for programs that are nested deeply: work that overflows the usual stack is done once more on a large one.

Readers, passes and writers follow blocks, expressions and chains of calls by calls of their own. Hardly any program
needs more than the stack that every thread has; what does is worked on in a thread with a large stack of its own, so
that the depth of a text ends no command. What even that cannot hold is refused by name.
"""

from __future__ import annotations

import ctypes
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import TypeVar

from rpl.diagnostics import Diagnostics
from rpl.errors import SourceError

Result = TypeVar("Result")

# Calls inside each other on the large stack, and its sizes in bytes, the first one that the system grants. A call takes
# less than 2 KiB of it: most calls of Python's functions take none.
DEEPEST_CALLS = 400_000
_STACKS = (1 << 30, 1 << 29, 1 << 28)
_CALL_BYTES = 2560

_here = threading.local()


def at_any_depth(work: Callable[[], Result], diagnostics: Diagnostics | None = None) -> Result:
    """What `work` gives, tried again with a large stack when it overflows the usual one.

    `work` changes nothing but `diagnostics`, whose reports of the first attempt are taken back. Raises SourceError when
    the large stack overflows too, and whatever `work` raises.
    """
    if getattr(_here, "deep", False):
        return work()
    before = len(diagnostics) if diagnostics is not None else 0
    outer, _here.guarded = getattr(_here, "guarded", False), True
    try:
        return work()
    except RecursionError:
        pass
    finally:
        _here.guarded = outer
    if diagnostics is not None:
        del diagnostics.items[before:]
    return deeply(work)


def has_more_depth() -> bool:
    """Will work that overflows the stack here be done again on a larger one?"""
    return getattr(_here, "guarded", False) and not getattr(_here, "deep", False)


def deeply(work: Callable[[], Result]) -> Result:
    """What `work` gives, done on a large stack. A key that interrupts the program interrupts the work."""
    if getattr(_here, "deep", False):
        return work()
    idents: list[int] = []

    def run() -> Result:
        _here.deep = True
        idents.append(threading.get_ident())
        return work()

    usual = sys.getrecursionlimit()
    try:
        begun = _begun(run)
        try:
            return begun.result()
        except RecursionError:
            raise SourceError("the program is nested too deeply to be worked on") from None
        except (KeyboardInterrupt, SystemExit) as stop:
            if not begun.done():
                _interrupt(idents)
                wait((begun,))
            ended = begun.exception()
            if isinstance(stop, KeyboardInterrupt) and isinstance(ended, KeyboardInterrupt):
                raise ended from None
            raise
    finally:
        sys.setrecursionlimit(usual)


def _begun(run: Callable[[], Result]) -> Future[Result]:
    """Work that has begun in a thread with the largest stack to be had, and as many calls as that holds."""
    for size in _STACKS:
        usual = threading.stack_size(size)
        executor = ThreadPoolExecutor(1)
        try:
            sys.setrecursionlimit(min(size // _CALL_BYTES, DEEPEST_CALLS))
            return executor.submit(run)
        except RuntimeError:  # so much memory is not to be had
            continue
        finally:
            threading.stack_size(usual)
            executor.shutdown(wait=False)
    raise SourceError("the program is nested too deeply for the memory that there is")


def _interrupt(idents: list[int]) -> None:
    """Ends the work of a thread at its next statement."""
    for ident in idents:
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(ident), ctypes.py_object(KeyboardInterrupt))
