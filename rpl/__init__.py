"""Open toolchain for robot programs: read any controller's language, run it, translate it, prove the translation.

The Python API has the command line's words: `read`, `translate`, `run`, `prove`.
"""

__version__ = "0.1.0"
