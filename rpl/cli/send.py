"""`rpl send`: programs from a folder to a controller, all of them or none."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from rpl.cli.controllers import config_option, connect, connection, named
from rpl.cli.output import json_option, print_json, say
from rpl.errors import UsageError
from rpl.showing import counted

if TYPE_CHECKING:
    from rpl.controllers.planning import Plan
    from rpl.controllers.profile import Profile
    from rpl.controllers.sending import Outcome


@click.command("send")
@click.argument("arguments", nargs=-1, required=True, metavar="DIR NAME|URL")
@click.option("--write", is_flag=True, help="Write; else it is only said what would be written.")
@click.option("--resume", is_flag=True, help="Finish a transfer that was broken off: bring the new programs.")
@click.option("--roll-back", is_flag=True, help="Bring back what a broken off transfer, or the last one, replaced.")
@click.option("--at-rest", is_flag=True, help="I have looked: it stands, where the controller does not say so.")
@click.option("--prove", "origin", metavar="PATH", help="Send only what is proved equal to this program.")
@click.option("--accept-alike", is_flag=True, help="With --prove: the verdict alike is enough.")
@click.option("--robot", metavar="R", help="With --prove: arm of the origin, and of the controller unless --to-robot.")
@click.option("--to-robot", metavar="R", help="With --prove: arm of the controller.")
@click.option("--cell", metavar="F.toml", help="With --prove: surroundings of both runs.")
@config_option
@json_option
def command(
    arguments: tuple[str, ...],
    write: bool,
    resume: bool,
    roll_back: bool,
    at_rest: bool,
    origin: str | None,
    accept_alike: bool,
    robot: str | None,
    to_robot: str | None,
    cell: str | None,
    config: Path | None,
    as_json: bool,
) -> int:
    """Send the programs of a folder to a controller. Nothing is ever started, selected or switched on.

    Without --write it is said what would be written and what speaks against it. With --write a backup is made, all
    files are written, read back and compared; if anything fails, the old ones are brought back. Exit status 0 when all
    was done (or could be), 1 when something speaks against it or it failed.
    """
    if resume or roll_back:
        if len(arguments) != 1 or write or origin is not None or (resume and roll_back):
            raise UsageError("--resume and --roll-back take the controller alone: rpl send --resume NAME")
        return _finish(named(arguments[0], config), resume, as_json)
    if len(arguments) != 2:
        raise UsageError("name a folder and a controller: rpl send DIR NAME")
    from rpl.controllers.planning import plan

    folder, profile = Path(arguments[0]), named(arguments[1], config)
    verdict = _proved(folder, origin, accept_alike, (robot, to_robot), cell) if origin is not None else None
    with connection(profile) as link:
        planned = plan(link, profile, folder, at_rest)
        if not write or planned.against or not planned.to_write:
            return _shown(profile, planned, verdict, as_json, write)
        from rpl.controllers.sending import send

        if not as_json:
            _show(profile, planned)
        outcome = send(link, connect, profile, planned, lambda text: say(f"rpl: {text}", err=True))
    return _told(profile, outcome, planned, as_json)


def _shown(profile: Profile, planned: Plan, verdict: str | None, as_json: bool, write: bool) -> int:
    """A dry run, or a transfer that is not begun."""
    status = 1 if planned.against else 0
    if as_json:
        print_json({"controller": profile.name, "written": False, "verdict": verdict, "plan": planned.as_json()})
        return status
    _show(profile, planned)
    for text in planned.against:
        say(f"rpl: {text}", err=True)
    if planned.against:
        say("nothing was written: the above speaks against it")
    elif not planned.to_write:
        say("nothing was written: the controller holds these programs already")
    elif not write:
        say("nothing was written: this is what --write would do")
    return status


def _show(profile: Profile, planned: Plan) -> None:
    from rpl.controllers.showing import Status

    say(f"to           {profile.name} ({profile.address})")
    for line in Status(planned.identity, planned.state).lines():
        say(line)
    for line in planned.lines():
        say(line)


def _told(profile: Profile, outcome: Outcome, planned: Plan | None, as_json: bool) -> int:
    journal = outcome.journal
    if as_json:
        document = {
            "controller": profile.name,
            "written": journal.step == "done",
            "step": journal.step,
            "journal": str(journal.folder),
            "files": [{"name": item.name, "old": item.old, "new": item.new} for item in journal.items],
            "remarks": list(outcome.remarks),
            "plan": planned.as_json() if planned is not None else None,
        }
        print_json(document)
        return 0
    for remark in outcome.remarks:
        say(f"rpl: {remark}", err=True)
    count = counted(len(journal.items), "file")
    if journal.step == "done":
        say(f"sent {count} to {profile.name}, read back and compared; the backup is in {journal.folder}")
    else:
        say(f"{profile.name} holds {count} of {journal.folder}/old again, read back and compared")
    return 0


def _finish(profile: Profile, forwards: bool, as_json: bool) -> int:
    from rpl.controllers.journal import last_done, unfinished
    from rpl.controllers.sending import finish

    journal = unfinished(profile.state_folder, profile.name)
    if journal is None and not forwards:
        journal = last_done(profile.state_folder, profile.name)
    if journal is None:
        what = "is unfinished" if forwards else "can be rolled back"
        raise UsageError(f"no transfer to {profile.name} {what} ({profile.state_folder})")
    outcome = finish(connect, profile, journal, forwards, lambda text: say(f"rpl: {text}", err=True))
    return _told(profile, outcome, None, as_json)


def _proved(
    folder: Path, origin: str, accept_alike: bool, robots: tuple[str | None, str | None], cell: str | None
) -> str:
    """The verdict on the folder and its origin. Raises SourceError when it is not good enough to be sent."""
    from rpl.cli.proofs import answer, programs_of, with_arms
    from rpl.errors import SourceError
    from rpl.proof.certificate import Question

    question = Question(origin, str(folder), robot=robots[0], to_robot=robots[1], cell=cell)
    programs = programs_of(question)
    result = answer(with_arms(question, programs), programs)
    if result.verdict != "equal" and not (accept_alike and result.verdict == "alike"):
        raise SourceError(f"nothing is sent: {folder} and {origin}: {result.headline()}")
    say(f"rpl: {folder} and {origin}: {result.headline()}", err=True)
    return result.verdict
