"""`rpl`: finds the command, runs it, and turns every mistake into one line and an exit status, never a traceback.

Commands give back their exit status: 0 as asked, 1 the answer is no, 2 bad usage, 3 written with guarded stops.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Sequence
from importlib import import_module
from types import FrameType

import click

from rpl import __version__
from rpl.errors import InternalError, RplError, UsageError
from rpl.showing import printable

OK, NO, USAGE, GUARDED = 0, 1, 2, 3
_INTERRUPTED, _PIPE_CLOSED, _TERMINATED = 130, 141, 143
_AGAIN_S = 0.05  # Ctrl-C that comes while a module is loaded is tried again after this
# Commands that only list what there is: who has read enough of it may go away.
_LISTINGS = ("dialects", "robots", "templates")
_HELP = frozenset(("-h", "--help", "--version"))

# Name -> what the list of commands says. Each lives in rpl.cli.<name> as `command`.
COMMANDS = {
    "dialects": "List the languages that can be read and written.",
    "robots": "List the robot models that come with the package.",
    "check": "Read programs and report what cannot be read or makes no sense.",
    "project": "Show what a backup holds: programs, calls, signals, points.",
    "diff": "Show what two versions of a program differ in, by meaning.",
    "merge": "Bring two changed versions of a program together.",
    "translate": "Write programs in another controller's language.",
    "run": "Run a program on an emulated robot.",
    "view": "See a run of a cell in a browser, or as a page that plays it.",
    "batch": "Check, run or translate every project of a plant's archive.",
    "fit": "Adjust the motion parameters of a controller to a recorded log.",
    "prove": "Decide by running both whether two programs mean the same.",
    "fk": "Forward kinematics: joints to a pose in a dialect's notation.",
    "ik": "Inverse kinematics: a pose to all joint solutions.",
    "stable": "Show how a part can rest on a surface, and how likely.",
    "fetch": "Fetch the programs of a robot controller.",
    "send": "Send programs to a robot controller, all or none, with a backup.",
    "status": "Show who a controller is and what it is doing.",
    "watch": "Show values of a controller as they change.",
    "serve": "Stand in for a robot controller behind its maker's own interfaces.",
    "templates": "List how statements are written, or copy it to be changed.",
    "repl": "Try RPL statements one by one on an emulated robot.",
}


class LazyGroup(click.Group):
    """A group whose commands are imported when called; the list of commands needs no import."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name not in COMMANDS:
            return None
        found = import_module(f"rpl.cli.{cmd_name}").command
        assert isinstance(found, click.Command)
        from rpl.cli.completion import completed

        return completed(found)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args and args[0] not in COMMANDS and not args[0].startswith("-"):
            from difflib import get_close_matches

            close = get_close_matches(args[0], COMMANDS, 1)
            hint = f"did you mean {close[0]}?" if close else f"there are {', '.join(COMMANDS)}"
            raise click.UsageError(f"no command {args[0]!r}; {hint}", ctx)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.command(cls=LazyGroup, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="rpl", message="%(prog)s %(version)s")
def rpl() -> None:
    """Read, run, translate and prove industrial robot programs of any brand."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Entry point of the console script. Always ends by SystemExit."""
    if signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        signal.signal(signal.SIGTERM, _terminate)
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler and hasattr(signal, "setitimer"):
        signal.signal(signal.SIGINT, _interrupt)
        signal.signal(signal.SIGALRM, _interrupt)
    _open_streams()
    sys.exit(run(arguments))


def _open_streams() -> None:
    """Streams that the shell has closed (`>&-`) take everything and give nothing."""
    sys.stdin = sys.stdin or os.fdopen(os.open(os.devnull, os.O_RDONLY), encoding="utf-8")
    sys.stdout = sys.stdout or os.fdopen(os.open(os.devnull, os.O_WRONLY), "w", encoding="utf-8")
    sys.stderr = sys.stderr or os.fdopen(os.open(os.devnull, os.O_WRONLY), "w", encoding="utf-8")


def _terminate(number: int, frame: object) -> None:
    """Who is told to end leaves the terminal and its files as they should be."""
    raise SystemExit(_TERMINATED)


def _interrupt(number: int, frame: FrameType | None) -> None:
    """Ctrl-C, as soon as no module is being loaded: those written in C may swallow an exception at their start."""
    within = frame
    while within is not None and not within.f_code.co_filename.startswith("<frozen importlib"):
        within = within.f_back
    if within is None:
        raise KeyboardInterrupt
    signal.setitimer(signal.ITIMER_REAL, _AGAIN_S)


def run(arguments: Sequence[str] | None = None) -> int:
    """Run one command line and give its exit status."""
    try:
        result = rpl.main(list(arguments) if arguments is not None else None, "rpl", standalone_mode=False)
        sys.stdout.flush()
        return result if isinstance(result, int) else OK
    except click.exceptions.Exit as end:
        return int(end.exit_code)
    except click.Abort as end:  # what click makes of Ctrl-C
        _say_where(end.__cause__)
        return _INTERRUPTED
    except click.exceptions.NoArgsIsHelpError as error:
        click.echo(error.format_message(), err=True)
        return USAGE
    except click.ClickException as error:
        _say(f"rpl: {error.format_message()}")
        return USAGE
    except KeyboardInterrupt as stopped:
        _say_where(stopped)
        return _INTERRUPTED
    except SystemExit as end:  # how click ends when whoever read our output went away
        return _TERMINATED if end.code == _TERMINATED else _of_closed_pipe(arguments)
    except BrokenPipeError:
        # Whoever read our output went away: no message, and nothing more to flush at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return _of_closed_pipe(arguments)
    except UsageError as error:
        _say(f"rpl: {error}")
        return USAGE
    except InternalError as error:
        _say(f"rpl: internal error, please report it with the input: {error}")
        return NO
    except RplError as error:
        _say(f"rpl: {error}")
        return NO
    except OSError as error:
        name = f"{error.filename}: " if error.filename else ""
        _say(f"rpl: {name}{error.strerror or error}")
        return USAGE
    except (RecursionError, MemoryError) as error:
        _say(f"rpl: the input is too large or too deeply nested ({type(error).__name__})")
        return NO
    except ModuleNotFoundError as error:
        if error.name is None or error.name.startswith("rpl."):
            _say(f"rpl: this installation is incomplete: {error}")
            return USAGE
        _say(f"rpl: this needs the package {error.name}: pip install 'robot-rpl[kinematics]'")
        return USAGE


def _say_where(stopped: BaseException | None) -> None:
    """What Ctrl-C ended: the work, and where the program was that ran for it."""
    from rpl.runtime.trace import RunInterrupted

    _say(" ".join(("rpl: interrupted", *getattr(stopped, "__notes__", ()))))
    if isinstance(stopped, RunInterrupted):
        for task, origin in stopped.places:
            _say(f"{origin.place}task {task} was here, {stopped.result.time_s:.3f} s after its start")


def _of_closed_pipe(arguments: Sequence[str] | None) -> int:
    words = sys.argv[1:] if arguments is None else list(arguments)
    listing = words[:1] and words[0] in _LISTINGS
    return OK if listing or not _HELP.isdisjoint(words) else _PIPE_CLOSED


def _say(line: str) -> None:
    try:
        click.echo(printable(" ".join(line.splitlines())), err=True)
    except OSError:
        return  # standard error is closed too: the exit status says what is left to say


if __name__ == "__main__":
    main()
