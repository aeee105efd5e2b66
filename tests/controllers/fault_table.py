"""Every fault at every request of a transfer to every maker's virtual controller, and what the controller holds then.

As a command it writes the table of docs/controllers.md: `python -m tests.controllers.fault_table [MAKER...]`; the tests
take samples of the same cases.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from rpl.controllers import journal as journals
from rpl.controllers.link import Link, LinkError
from rpl.controllers.planning import is_temporary, plan
from rpl.controllers.profile import Profile
from rpl.controllers.sending import NotSentError, finish, send
from rpl.controllers.vendors import vendor
from tests.controllers.failing import Killed
from tests.controllers.hosting import MOTION, Hosted, hosted
from tests.controllers.transfers import TRANSFERS, Programs

PAGE = Path(__file__).parents[2] / "docs/controllers.md"
BEGIN, END = "<!-- faults: made by tests/controllers/fault_table.py -->", "<!-- end of faults -->"
PATIENCE_S = 0.5
# No answer of a hostile controller is waited for longer, all of a transfer together (s, on a busy machine).
LONGEST_S = 60.0
BY_REQUEST = ("drop", "before", "estop")
BY_WRITE = ("truncate", "protected", "full")
ONCE = ("busy", "login:1+", "slow:0.05", "slow:3")
HOSTILE = ("names", "huge")
HOSTILE_BY_REQUEST = ("endless", "garbage")
KILL = "kill"


@dataclass(frozen=True)
class Case:
    maker: str
    fault: str

    @property
    def kind(self) -> str:
        """The fault without its number; `+`: it stays."""
        name, _, number = self.fault.partition(":")
        if name == "slow":
            return f"slow ({number} s)"
        return name + (" for good" if number.endswith("+") and name != "login" else "")


@dataclass(frozen=True)
class Ended:
    """old: the controller holds exactly what it held. new: exactly what was brought, and the client says so. journal: a
    journal says that it is unfinished, and it was then finished both ways. `wrong`: anything else."""

    word: str
    wrong: str = ""


def cases(maker: str, step: int = 1) -> Iterator[Case]:
    """All of a maker; `step`: each so many-th request only."""
    requests, writes, steps = measured(maker)
    numbers = range(1, requests + 1, step)
    for name in BY_REQUEST:
        yield from (Case(maker, f"{name}:{number}") for number in numbers)
    yield from (Case(maker, f"drop:{number}+") for number in numbers)
    for name in BY_WRITE:
        yield from (Case(maker, f"{name}:{number}") for number in range(1, writes + 1))
    yield from (Case(maker, f"misread:{number}") for number in range(1, writes + 1))
    yield from (Case(maker, name) for name in (*ONCE, *HOSTILE))
    for name in HOSTILE_BY_REQUEST:
        yield from (Case(maker, f"{name}:{number}") for number in numbers)
    yield from (Case(maker, f"{KILL}:{number}") for number in range(1, steps + 1))


def measured(maker: str) -> tuple[int, int, int]:
    """Requests and writes of a whole transfer when nothing goes wrong, and the steps that it tells of."""
    told: list[str] = []
    with tempfile.TemporaryDirectory() as name, _standing(maker, "") as here:
        where = Path(name)
        _transfer(_profile(here, where), _folder(where, TRANSFERS[maker]), told.append)
        kinds = [one.kind for one in here.cabinet.transcript.requests]
        assert _new(here, maker).wrong == ""
        return here.cabinet.requests, kinds.count("write"), len(told)


def _standing(maker: str, fault: str):  # type: ignore[no-untyped-def]
    programs = TRANSFERS[maker]
    files = {programs.below + name: data for name, data in programs.old.items()}
    return hosted(maker, files, fault)


def _profile(here: Hosted, where: Path, patience_s: float = 10.0) -> Profile:
    return here.profile(where, patience_s, user="operator", given_password=here.cabinet.password)


def _folder(where: Path, programs: Programs) -> Path:
    folder = where / "programs"
    folder.mkdir()
    for name, data in programs.new.items():
        (folder / name).write_bytes(data)
    return folder


def _connect(profile: Profile) -> Link:
    return vendor(profile.maker).connect(profile)


def _transfer(profile: Profile, folder: Path, tell) -> None:  # type: ignore[no-untyped-def]
    link = _connect(profile)
    try:
        planned = plan(link, profile, folder)
        if planned.against:
            raise RefusedPlan("; ".join(planned.against))
        send(link, _connect, profile, planned, tell)
    finally:
        link.close()


class RefusedPlan(Exception):
    """Something spoke against the transfer; nothing was written."""


def ended(case: Case) -> Ended:
    """Carry a transfer out with this fault, and look at what the controller holds."""
    programs = TRANSFERS[case.maker]
    name, _, number = case.fault.partition(":")
    count = 0

    def tell(text: str) -> None:
        nonlocal count
        count += 1
        if name == KILL and count == int(number):
            raise Killed

    began = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary, _standing(case.maker, "" if name == KILL else case.fault) as here:
        where = Path(temporary)
        profile, said = _profile(here, where, PATIENCE_S), ""
        try:
            _transfer(profile, _folder(where, programs), tell)
            found = _new(here, case.maker)
        except (LinkError, RefusedPlan) as error:
            said = str(error)
            found = _old(here, case.maker, temporaries=False)
        except (NotSentError, Killed) as error:
            said = str(error)
            found = _unfinished(here, case.maker, profile)
        if here.kinds() & MOTION:
            return Ended(found.word, f"it was told to {', '.join(sorted(here.kinds() & MOTION))}")
        if time.monotonic() - began > LONGEST_S:
            return Ended(found.word, f"it took {time.monotonic() - began:.0f} s")
        return Ended(found.word, f"{found.wrong}; said: {said}") if found.wrong else found


def _held(here: Hosted, maker: str) -> dict[str, bytes]:
    """What the controller holds, behind the back of its interfaces."""
    below = TRANSFERS[maker].below
    store = here.cabinet.store
    names = [name for name, _ in store._files.values()]
    return {name.removeprefix(below): store.kept(name) for name in names}


def _is(here: Hosted, maker: str, wanted: Mapping[str, bytes]) -> bool:
    same, held = vendor(maker).rules.same, _held(here, maker)
    known = {name: data for name, data in held.items() if not is_temporary(name)}
    return set(known) == set(wanted) and all(same(name, wanted[name], data) for name, data in known.items())


def _new(here: Hosted, maker: str) -> Ended:
    good = _is(here, maker, TRANSFERS[maker].after) and not any(map(is_temporary, _held(here, maker)))
    return Ended("new", "" if good else f"it holds {sorted(_held(here, maker))}")


def _old(here: Hosted, maker: str, temporaries: bool) -> Ended:
    good = _is(here, maker, TRANSFERS[maker].old)
    left = [name for name in _held(here, maker) if is_temporary(name)]
    if good and left and not temporaries:
        return Ended("old", f"it is left with {left}")
    return Ended("old", "" if good else f"it holds {sorted(_held(here, maker))}")


def _unfinished(here: Hosted, maker: str, profile: Profile) -> Ended:
    """The transfer failed: either all is as it was, or a journal tells, and can be finished both ways."""
    journal = journals.unfinished(profile.state_folder, profile.name)
    if journal is None:
        return _old(here, maker, temporaries=False)
    (journal.folder.parent / journals.LOCK).unlink(missing_ok=True)
    here.cabinet.faults.name = ""
    here.cabinet.release_emergency_stop()
    finish(_connect, profile, journal, True)
    forwards = _new(here, maker)
    journal.at(journal.step)
    finish(_connect, profile, journal, False)
    backwards = _old(here, maker, temporaries=False)
    return Ended("journal", forwards.wrong or backwards.wrong)


def table(makers: Sequence[str]) -> tuple[str, list[str]]:
    """The table in Markdown, and what went wrong."""
    counts: dict[tuple[str, str], Counter[str]] = {}
    wrong = []
    for maker in makers:
        began = time.monotonic()
        for case in cases(maker):
            try:
                found = ended(case)
            except Exception as error:  # noqa: BLE001 - whatever it is, it is told and the table goes on
                found = Ended("old", f"{type(error).__name__}: {error}")
            counts.setdefault((case.kind, maker), Counter())["wrong" if found.wrong else found.word] += 1
            if found.wrong:
                wrong.append(f"{maker} {case.fault}: {found.wrong}")
        print(f"{maker}: {time.monotonic() - began:.0f} s", file=sys.stderr)
    kinds = list(dict.fromkeys(kind for kind, _ in counts))
    lines = [f"| fault | {' | '.join(makers)} |", f"|---|{'---|' * len(makers)}"]
    for kind in kinds:
        cells = (_cell(counts.get((kind, maker), Counter())) for maker in makers)
        lines.append(f"| {kind} | {' | '.join(cells)} |")
    total: Counter[str] = sum(counts.values(), Counter())
    summary = f"{sum(total.values())} cases: {_cell(total)}."
    return "\n".join([summary, "", *lines]), wrong


def _cell(found: Counter[str]) -> str:
    words = [f"{found[word]} {word}" for word in ("old", "new", "journal", "wrong") if found[word]]
    return ", ".join(words) or "-"


def main() -> int:
    makers = sys.argv[1:] or list(TRANSFERS)
    made, wrong = table(makers)
    for line in wrong:
        print(line, file=sys.stderr)
    print(made)
    if len(makers) == len(TRANSFERS) and not wrong:
        text = PAGE.read_text("utf-8")
        head, rest = text.split(BEGIN)
        PAGE.write_text(f"{head}{BEGIN}\n\n{made}\n\n{END}{rest.split(END)[1]}", "utf-8")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
