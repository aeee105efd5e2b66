"""How long a large backup takes to be read, linked and reported: `rpl project` on 500 programs of four languages.

    python benchmarks/project_speed.py [--programs 500] [--statements 60] [--from DIALECT] [--into FOLDER]

The programs are the same each time: each moves to points of its own, waits for signals, sets signals, branches, counts
and calls two others, so that all hang together. The times are of the whole command in a process of its own.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

Files = Iterator[tuple[str, str]]


def called(number: int, count: int) -> list[int]:
    """The programs that a program calls: each but the first is called by one."""
    return [other for other in (2 * number + 1, 2 * number + 2) if other < count]


def steps(number: int, count: int, statements: int) -> Iterator[tuple[str, int]]:
    """What a program does, in words that every language has: (kind, number)."""
    rng = random.Random(number)
    calls = called(number, count)
    kinds = ("move", "move", "move", "line", "line", "set", "wait", "count", "branch")
    for step in range(statements):
        if calls and step % (statements // 3) == statements // 3 - 1:
            yield "call", calls.pop(0)
        else:
            yield rng.choice(kinds), rng.randrange(1, 33)


def krl(count: int, statements: int) -> Files:
    for number in range(count):
        text, data, rng = [f"DEF K{number:03}()", "BAS(#INITMOV,0)"], [f"DEFDAT K{number:03}"], random.Random(-number)
        for at, (kind, value) in enumerate(steps(number, count, statements)):
            x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
            if kind in ("move", "line"):
                data.append(f"DECL E6POS XP{at}={{X {x:.3f},Y {y:.3f},Z {z:.3f},A 0.0,B 90.0,C 0.0,S 2,T 10}}")
            text.append(
                {
                    "move": f"PTP XP{at} C_PTP",
                    "line": f"LIN XP{at} C_DIS",
                    "set": f"$OUT[{value}]=TRUE",
                    "wait": f"WAIT FOR $IN[{value}]",
                    "count": f"COUNTED=COUNTED+{value}",
                    "branch": f"IF COUNTED>{value} THEN\nCOUNTED=0\nENDIF",
                    "call": f"K{value:03}()",
                }[kind]
            )
        yield f"KRC/R1/Program/K{number:03}.src", "\n".join([*text, "END", ""])
        yield f"KRC/R1/Program/K{number:03}.dat", "\n".join([*data, "ENDDAT", ""])
    yield "KRC/R1/System/$config.dat", "DEFDAT $CONFIG\nDECL GLOBAL INT COUNTED=0\nENDDAT\n"


def rapid(count: int, statements: int) -> Files:
    for number in range(count):
        text, data, rng = [f"  PROC A{number:03}()"], [f"MODULE MA{number:03}"], random.Random(-number)
        for at, (kind, value) in enumerate(steps(number, count, statements)):
            x, y, z = rng.uniform(300, 500), rng.uniform(-200, 200), rng.uniform(300, 500)
            if kind in ("move", "line"):
                place = f"[[{x:.3f},{y:.3f},{z:.3f}],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
                data.append(f"  LOCAL CONST robtarget p{at}:={place};")
            text.append(
                {
                    "move": f"    MoveJ p{at},v500,z10,tool0;",
                    "line": f"    MoveL p{at},v200,fine,tool0;",
                    "set": f"    SetDO do{value},1;",
                    "wait": f"    WaitDI di{value},1;",
                    "count": f"    counted:=counted+{value};",
                    "branch": f"    IF counted>{value} THEN\n      counted:=0;\n    ENDIF",
                    "call": f"    A{value:03};",
                }[kind]
            )
        yield f"RAPID/TASK1/PROGMOD/MA{number:03}.mod", "\n".join([*data, *text, "  ENDPROC", "ENDMODULE", ""])
    yield "RAPID/TASK1/SYSMOD/base.sys", "MODULE base(SYSMODULE)\n  PERS num counted:=0;\nENDMODULE\n"


_POINT = (
    "P[{}]{{\n   GP1:\n\tUF : 1, UT : 1,\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {:9.3f} mm,\tY = {:9.3f} mm,\t"
    "Z = {:9.3f} mm,\n\tW =   180.000 deg,\tP =     0.000 deg,\tR =     0.000 deg\n}};"
)


def tp(count: int, statements: int) -> Files:
    for number in range(count):
        text, data, rng = [], list[str](), random.Random(-number)
        for kind, value in steps(number, count, statements):
            if kind in ("move", "line"):
                x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
                data.append(_POINT.format(len(data) + 1, x, y, z))
            line = {
                "move": f"J P[{len(data)}] 50% CNT50",
                "line": f"L P[{len(data)}] 200mm/sec FINE",
                "set": f"DO[{value}]=ON",
                "wait": f"WAIT DI[{value}]=ON",
                "count": f"R[1]=R[1]+{value}",
                "branch": f"IF R[1]>{value},CALL T{count:03}",
                "call": f"CALL T{value:03}",
            }[kind]
            text.append(f"{len(text) + 1:4}:  {line} ;")
        yield f"T{number:03}.LS", _listing(f"T{number:03}", text, data)
    yield f"T{count:03}.LS", _listing(f"T{count:03}", ["   1:  R[1]=0 ;"], [])


def _listing(name: str, text: list[str], data: list[str]) -> str:
    head = [f"/PROG  {name}", "/ATTR", f"LINE_COUNT\t= {len(text)};", "DEFAULT_GROUP\t= 1,*,*,*,*;", "/MN"]
    return "\n".join([*head, *text, "/POS", *data, "/END", ""])


def inform(count: int, statements: int) -> Files:
    for number in range(count):
        text, data, rng = list[str](), list[str](), random.Random(-number)
        for at, (kind, value) in enumerate(steps(number, count, statements)):
            if kind in ("move", "line"):
                values = ",".join(str(rng.randrange(-40_000, 40_000)) for _ in range(6))
                data.append(f"C{len(data):05}={values}")
            text.append(
                {
                    "move": f"MOVJ C{len(data) - 1:05} VJ=50.00",
                    "line": f"MOVL C{len(data) - 1:05} V=200.0",
                    "set": f"DOUT OT#({value}) ON",
                    "wait": f"WAIT IN#({value})=ON",
                    "count": f"ADD I000 {value}",
                    "branch": f"JUMP *L{at} IF I000<{value}\nSET I000 0\n*L{at}",
                    "call": f"CALL JOB:Y{value:03}",
                }[kind]
            )
        head = ["/JOB", f"//NAME Y{number:03}", "//POS", f"///NPOS {len(data)},0,0,0,0,0", "///TOOL 0"]
        head += ["///POSTYPE PULSE", "///PULSE", *data, "//INST", "///DATE 2026/01/01 08:00", "///ATTR SC,RW"]
        yield f"Y{number:03}.JBI", "\r\n".join([*head, "///GROUP1 RB1", "NOP", *text, "END", ""])


LANGUAGES: dict[str, Callable[[int, int], Files]] = {"krl": krl, "rapid": rapid, "tp": tp, "inform": inform}


def write(home: Path, names: list[str], programs: int, statements: int) -> None:
    """One backup for each language, with its share of the programs."""
    for name in names:
        for path, text in LANGUAGES[name](programs // len(names), statements):
            file = home / name / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8", newline="")


def measure(home: Path) -> None:
    command = [sys.executable, "-m", "rpl.cli.main", "project", str(home), "--json"]
    begun, before = time.perf_counter(), os.times()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    wall, after = time.perf_counter() - begun, os.times()
    used = after.children_user + after.children_system - before.children_user - before.children_system
    if done.returncode != 0:
        raise SystemExit(f"rpl project ends with {done.returncode}: {done.stderr[-2000:]}")
    found = json.loads(done.stdout)
    said = {key: len(found[key]) for key in ("files", "programs", "entries", "missing", "signals", "data")}
    counts = ", ".join(f"{count} {key}" for key, count in said.items())
    total = sum(one["statements"] for one in found["files"])
    print(f"{counts}, {total} statements: {wall:.1f} s, {used:.1f} s of processor time")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=int, default=500)
    parser.add_argument("--statements", type=int, default=60)
    parser.add_argument("--from", dest="names", action="append", choices=LANGUAGES, help="only this language")
    parser.add_argument("--into", type=Path, help="keep the backup in this folder")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        home = given.into or Path(made)
        write(home, given.names or list(LANGUAGES), given.programs, given.statements)
        measure(home)


if __name__ == "__main__":
    main()
