"""Registers and signals by the panel interface are those of the program that runs, and stay without one."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterator

import pytest

from rpl.controllers.fanuc import snpx
from rpl.controllers.fanuc.listing import listing_of
from rpl.controllers.fanuc.snpx import Place, SnpxClient
from rpl.controllers.link import RefusedError
from tests.controllers.hosting import Hosted, hosted

pytest.importorskip("pyftpdlib", reason="the virtual controller needs pyftpdlib")

# Register 1 lets it go on; 2 counts, 4 is chosen by 3; a position is changed and gone to; texts are copied.
MAIN = """R[2]=0 ;
   2:  LBL[1] ;
   3:  WAIT R[1]=1 ;
   4:  R[1]=0 ;
   5:  R[2]=R[2]+1 ;
   6:  R[R[3]]=R[5]*2 ;
   7:  PR[7]=PR[6] ;
   8:  PR[7,3]=R[5] ;
   9:  SR[2]=SR[1] ;
  10:  DO[4]=DI[3] ;
  11:J PR[8] 100% FINE ;
  12:  JMP LBL[1]"""
AGAIN = "R[9]=R[2]+R[20] ;\n   2:  PR[9]=PR[7]"
NUMBERS = b"""[*NUMREG*]$NUMREG  Storage: SHADOW  Access: RW  : ARRAY[200] OF Numeric Reg
  [5] = 40.500000  'depth'
  [20] = 3  'kept'
[*NUMREG*]$MAXREGNUM  Storage: CMOS  Access: RW  : INTEGER = 200
"""
FILES = {
    "MAIN.LS": listing_of(MAIN, "", "MAIN").encode(),
    "AGAIN.LS": listing_of(AGAIN, "", "AGAIN").encode(),
    "NUMREG.VA": NUMBERS,
}
HERE = Place((400.0, 10.0, 300.0, 180.0, 0.0, 0.0), ())
JOINTS = Place((0.0,) * 6, (5.0, 10.0, -10.0, 0.0, -60.0, 0.0))
PATIENCE_S = 20.0
WAITS = 8  # the line of the text where MAIN waits


@pytest.fixture
def here() -> Iterator[Hosted]:
    with hosted("fanuc", FILES, robot="fanuc_lrmate200id") as found:
        yield found


@pytest.fixture
def panel(here: Hosted) -> Iterator[SnpxClient]:
    client = SnpxClient("127.0.0.1", here.endpoints.ports["snpx"], PATIENCE_S)
    yield client
    client.close()


def until(here: Hosted, holds: Callable[[], bool]) -> None:
    """The program runs on when somebody looks."""
    end = time.monotonic() + PATIENCE_S
    while not holds():
        assert time.monotonic() < end
        here.cabinet.advance()
        time.sleep(0.01)


class Registers:
    """A window over each bank."""

    def __init__(self, panel: SnpxClient) -> None:
        self.panel = panel
        self.numbers, self.places = panel.window("R[1]", 80, "0"), panel.window("PR[1]", 500)
        self.texts = panel.window("SR[1]", 80)

    def number(self, index: int) -> float:
        (found,) = struct.unpack("<f", self.panel.words(self.numbers + 2 * index - 2, 2))
        return float(found)

    def give(self, index: int, value: float) -> None:
        self.panel.ask(snpx.WRITE, snpx.REGISTERS, self.numbers - 1 + 2 * index - 2, 2, struct.pack("<f", value))

    def place(self, index: int) -> bytes:
        return self.panel.words(self.places + 50 * index - 50, 50)

    def give_place(self, index: int, data: bytes) -> None:
        self.panel.ask(snpx.WRITE, snpx.REGISTERS, self.places - 1 + 50 * index - 50, 50, data)

    def text(self, index: int) -> str:
        return snpx.text_of(self.panel.words(self.texts + 40 * index - 40, 40))

    def give_text(self, index: int, text: str) -> None:
        data = text.encode().ljust(80, b"\x00")
        self.panel.ask(snpx.WRITE, snpx.REGISTERS, self.texts - 1 + 40 * index - 40, 40, data)


def started(here: Hosted, name: str) -> None:
    assert not here.cabinet.select([f"{name}.LS"], name)
    here.cabinet.start()


def test_what_dumps_say_is_there_without_a_program(panel: SnpxClient) -> None:
    registers = Registers(panel)
    assert [registers.number(index) for index in (5, 20, 6)] == [40.5, 3.0, 0.0]
    registers.give(6, 2.5)
    assert registers.number(6) == 2.5


def test_the_program_that_runs_sees_what_is_written_and_shows_what_it_writes(here: Hosted, panel: SnpxClient) -> None:
    registers = Registers(panel)
    registers.give(3, 4)
    registers.give_place(6, snpx.position_bytes(HERE, joints=False))
    started(here, "MAIN")
    until(here, lambda: here.cabinet.line == WAITS)
    registers.give_place(8, snpx.position_bytes(Place(HERE.xyzwpr, ()), joints=False))
    registers.give_text(1, "twelve")
    panel.ask(snpx.WRITE, snpx.INPUTS, 2, 1, b"\x04")  # DI[3]
    registers.give(5, 30.5)
    registers.give(1, 1)
    until(here, lambda: registers.number(2) == 1.0 and here.cabinet.line == WAITS)
    assert (registers.number(1), registers.number(4), registers.text(2)) == (0.0, 61.0, "twelve")
    found = snpx.position_of(registers.place(7))
    assert found.xyzwpr == pytest.approx((400.0, 10.0, 30.5, 180.0, 0.0, 0.0))
    assert snpx.has_pose(registers.place(7)) and not snpx.has_joints(registers.place(7))
    assert panel.bits(snpx.OUTPUTS, 4, 1) == [True]
    assert here.cabinet.flange is not None
    assert [float(each) for each in here.cabinet.flange[:3, 3]] == pytest.approx(HERE.xyzwpr[:3], abs=0.01)


def test_registers_stay_when_a_program_ends_and_are_those_of_the_next(here: Hosted, panel: SnpxClient) -> None:
    registers = Registers(panel)
    registers.give_place(6, snpx.position_bytes(HERE, joints=False))
    registers.give_place(8, snpx.position_bytes(HERE, joints=False))
    registers.give(3, 4)
    started(here, "MAIN")
    registers.give(1, 1)
    until(here, lambda: registers.number(2) == 1.0 and here.cabinet.line == WAITS)
    here.cabinet.stop()
    assert (registers.number(2), registers.number(4)) == (1.0, 81.0)
    started(here, "AGAIN")
    until(here, lambda: here.cabinet.phase == "stopped")
    assert registers.number(9) == 4.0
    assert snpx.position_of(registers.place(9)).xyzwpr == pytest.approx((400.0, 10.0, 40.5, 180.0, 0.0, 0.0))


def test_joints_in_a_position_that_the_program_has_as_a_pose_are_refused(here: Hosted, panel: SnpxClient) -> None:
    registers = Registers(panel)
    started(here, "MAIN")
    with pytest.raises(RefusedError):
        registers.give_place(6, snpx.position_bytes(JOINTS, pose=False))


def test_a_program_that_is_called_by_the_socket_has_them_too(here: Hosted, panel: SnpxClient) -> None:
    import socket

    registers = Registers(panel)
    registers.give(2, 39)
    with socket.create_connection(("127.0.0.1", here.endpoints.ports["mappdk"]), PATIENCE_S) as peer:
        assert peer.recv(1024) == b"0:success"
        peer.sendall(b"mappdkcall:AGAIN\n")
        assert peer.recv(1024) == b"0:success"
    assert registers.number(9) == 42.0
