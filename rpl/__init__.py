"""Open toolchain for robot programs: read any controller's language, run it, translate it, prove the translation.

The Python API has the command line's words: `rpl.read`, `rpl.translate`, `rpl.run`, `rpl.prove` (see rpl.api). They are
imported when first asked for, so that the command line starts fast.
"""

from typing import TYPE_CHECKING

__version__ = "0.1.0"
__all__ = ["__version__", "prove", "read", "run", "translate"]

if TYPE_CHECKING:
    from rpl.api import prove, read, run, translate


def __getattr__(name: str) -> object:
    if name in ("prove", "read", "run", "translate"):
        from rpl import api

        return getattr(api, name)
    raise AttributeError(f"module 'rpl' has no attribute {name!r}")
