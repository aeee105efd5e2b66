"""Fetching many programs by FTP: is it the line that takes the time, or us?

    python benchmarks/fetch_programs.py [PROGRAMS] [BYTES] [DELAY_MS]...

A server of its own process that does nothing but answer (its time is not ours) gives PROGRAMS files (usually 1000) of
BYTES (usually 20000) each; every answer is late by DELAY_MS (usually 0 and 2: a controller is not quick). What is
measured: time, bytes/s, and how much of the time this process was busy. Bound by the line: a small share.
"""

from __future__ import annotations

import multiprocessing
import socket
import sys
import tempfile
import time
from multiprocessing.connection import Connection
from pathlib import Path

from rpl.controllers.fetching import fetched
from rpl.controllers.profile import Profile
from rpl.controllers.vendors import vendor

HOST = "127.0.0.1"


def answer(ready: Connection, programs: int, size: int, delay_s: float) -> None:
    """As little of an FTP server as a client that fetches needs."""
    body = (b"!a line of a program ;\r\n" * (size // 23 + 1))[:size]
    names = "".join(f"P{number:05}.LS\r\n" for number in range(programs)).encode()
    listener = socket.create_server((HOST, 0))
    ready.send(listener.getsockname()[1])
    peer, _ = listener.accept()
    peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    data: socket.socket | None = None
    plain = {"USER": "331 password", "PASS": "230 in", "TYPE": "200 binary", "CWD": "250 there", "QUIT": "221 bye"}
    with peer, peer.makefile("rb") as lines:
        peer.sendall(b"220 ready\r\n")
        for line in lines:
            word = line.split()[0].decode().upper()
            time.sleep(delay_s)
            if word == "PASV":
                data = socket.create_server((HOST, 0))
                high, low = divmod(data.getsockname()[1], 256)
                peer.sendall(f"227 Entering Passive Mode (127,0,0,1,{high},{low})\r\n".encode())
            elif word in ("RETR", "NLST") and data is not None:
                sent = names if word == "NLST" else body
                peer.sendall(f"150 opening ({len(sent)} bytes)\r\n".encode())
                connection, _ = data.accept()
                with connection, data:
                    connection.sendall(sent)
                peer.sendall(b"226 done\r\n")
            else:
                peer.sendall(f"{plain.get(word, '502 not here')}\r\n".encode())


def measured(programs: int, size: int, delay_s: float) -> str:
    """One line of the report."""
    mine, its = multiprocessing.Pipe()
    server = multiprocessing.Process(target=answer, args=(its, programs, size, delay_s), daemon=True)
    server.start()
    made = vendor("fanuc")
    with tempfile.TemporaryDirectory() as folder:
        profile = Profile(
            "here", made.name, made.rules, made.ports, made.path, HOST, mine.recv(), state_folder=Path(folder)
        )
        link = made.connect(profile)
        began, busy = time.perf_counter(), time.process_time()
        total = count = 0
        for one in fetched(link, profile, False, lambda done, of: None):
            (Path(folder) / one.name).write_bytes(one.data or b"")
            total += len(one.data or b"")
            count += 1
        took, worked = time.perf_counter() - began, time.process_time() - busy
        link.close()
    server.join(timeout=10.0)
    late = f"{delay_s * 1000.0:g} ms late"
    return (
        f"{count} programs, {total / 1e6:.1f} MB, answers {late:<9} {took:7.2f} s  {total / took / 1e6:7.2f} MB/s  "
        f"busy {worked:.2f} s ({worked / took:.0%}), {worked / count * 1000.0:.2f} ms a program"
    )


def main() -> None:
    numbers = [float(word) for word in sys.argv[1:]]
    programs, size, *delays = [*map(int, numbers[:2]), *numbers[2:]] if len(numbers) >= 2 else [1000, 20_000]
    for delay_ms in delays or (0.0, 2.0):
        print(measured(int(programs), int(size), delay_ms / 1000.0), flush=True)


if __name__ == "__main__":
    main()
