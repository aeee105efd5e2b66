"""The other end of rpl.batch.processes: takes projects from standard input and gives what came of them on standard
output, each a pickle, until its input ends."""

from __future__ import annotations

import os
import pickle
import signal
import sys

from rpl.batch.work import answer


def main() -> None:
    """Works until its input ends. Whatever prints something here prints to standard error."""
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    while True:
        try:
            project, asked, longest_s = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        _end_after(longest_s)
        for made in answer(project, asked):
            pickle.dump(made, out)
            out.flush()
            _end_after(longest_s)
        _end_after(0.0)


def _end_after(seconds: float) -> None:
    """Ends this process by itself where nobody is left to do it; 0: never."""
    if hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, seconds)
