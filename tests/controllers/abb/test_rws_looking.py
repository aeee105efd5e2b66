"""What is seen of a controller: one look, and values as they change."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

from rpl.controllers.link import LostError, RefusedError
from rpl.controllers.vendors import vendor
from tests.controllers.hosting import Hosted, hosted

pytest.importorskip("aiohttp", reason="the extra `rws` is not installed")
pytest.importorskip("cryptography", reason="the extra `rws` is not installed")

SAMPLE = Path(__file__).parents[3] / "samples/rapid/project"
FILES = {path.name: path.read_bytes() for path in sorted(SAMPLE.iterdir())}


@pytest.fixture(scope="module")
def here() -> Iterator[Hosted]:
    with hosted("abb", FILES, robot="abb_irb120_3_58") as found:
        yield found


def profile(here: Hosted, folder: Path, generation: str) -> Any:
    return here.profile(folder, user="Default User", given_password="robot", options={"generation": generation})


@pytest.mark.parametrize("generation", ["1", "2"])
def test_one_look_says_where_the_robot_stands(here: Hosted, tmp_path: Path, generation: str) -> None:
    here.cabinet.set_signal("doLamp", 1)
    look = vendor("abb").status
    assert look is not None
    found = look(profile(here, tmp_path, generation))
    assert found.joints == pytest.approx(here.cabinet.joints)
    assert found.xyz_mm == pytest.approx((374.0, 0.0, 630.0))
    assert found.orientation["q1"] == pytest.approx(0.5**0.5)
    assert found.signals["doLamp"] == 1
    assert found.state.mode == "AUTO"


@pytest.mark.parametrize("generation", ["1", "2"])
def test_changes_are_told_and_rests_too(here: Hosted, tmp_path: Path, generation: str) -> None:
    here.cabinet.set_signal("doLamp", 0)
    here.cabinet.set_variable("tools.nDone", lambda old: 0)
    watch = vendor("abb").watch
    assert watch is not None
    samples = watch(profile(here, tmp_path, generation), ["doLamp", "mode", "T_ROB1/tools/nDone"], 0.05)
    assert next(samples).values == {"doLamp": 0, "mode": "AUTO", "T_ROB1/tools/nDone": 0}
    here.cabinet.set_signal("doLamp", 1)
    assert next(one for one in islice(samples, 400) if one.values["doLamp"] == 1)
    here.cabinet.set_variable("tools.nDone", lambda old: 7)
    assert next(one for one in islice(samples, 400) if one.values["T_ROB1/tools/nDone"] == 7)
    samples.close()  # type: ignore[attr-defined]


def test_what_is_not_there_cannot_be_watched(here: Hosted, tmp_path: Path) -> None:
    watch = vendor("abb").watch
    assert watch is not None
    with pytest.raises(RefusedError):
        next(watch(profile(here, tmp_path, "1"), ["T_ROB1/tools/nobody"], 0.05))


def test_watching_ends_with_the_controller(tmp_path: Path) -> None:
    watch = vendor("abb").watch
    assert watch is not None
    with hosted("abb", FILES) as here:
        samples = watch(profile(here, tmp_path, "1"), [], 0.05)
        next(samples)
        next(samples)
    with pytest.raises(LostError):
        list(islice(samples, 100))
