"""A pause of Python's cycle collector while long programs are built: trees and IR have no cycles, and looking for
them again and again among millions of live nodes would cost more than the work itself.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def paused_cycle_collector() -> Iterator[None]:
    """No search for cycles inside; afterwards as before. What has come into being then counts as old: the next search
    for young cycles would go through all of it."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            if not gc.get_freeze_count():
                gc.freeze()
                gc.unfreeze()
            gc.enable()
