"""The one exception tree. A user's mistake is never an `assert`; a fault of ours is an `InternalError`."""


class RplError(Exception):
    """Base of every error this package raises on purpose."""


class UsageError(RplError):
    """The call itself is wrong: an unknown robot, a missing file, an ambiguous entry."""


class SourceError(RplError):
    """A program cannot be used as asked; the diagnostics say where and why."""


class RunError(RplError):
    """A run could not be carried out (not a fault inside the robot program: that is part of the trace)."""


class InternalError(RplError):
    """A promise inside this package was broken, such as an IR node that no writer accounts for."""
