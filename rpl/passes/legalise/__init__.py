"""Rewriting a normalised program for what a target lacks: general passes chosen by its capability list.

Each pass is a pure function of program and context and preserves what a run of the program shows. What no pass can
rewrite stays as it is, and the writer reports it and guards it with the target's own stop.
"""

from rpl.passes.legalise.context import Context
from rpl.passes.legalise.pipeline import legalise
from rpl.passes.legalise.stages import Pass

__all__ = ["Context", "Pass", "legalise"]
