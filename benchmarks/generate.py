"""Long programs for the measurements: point lists with the logic between them that real ones have."""

from __future__ import annotations

import random


def krl(lines: int, seed: int = 1) -> str:
    """A KRL program of about so many lines."""
    rng = random.Random(seed)
    text = ["DEF long()", "DECL INT i", "BAS(#INITMOV,0)", "$VEL.CP=0.25", "i=0"]
    while len(text) < lines - 1:
        x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
        a, b, c = rng.uniform(-90, 90), rng.uniform(60, 90), rng.uniform(-90, 90)
        kind = rng.random()
        if kind < 0.75:
            text.append(f"LIN {{X {x:.3f},Y {y:.3f},Z {z:.3f},A {a:.4f},B {b:.4f},C {c:.4f}}} C_DIS")
        elif kind < 0.85:
            text.append(f"$OUT[{rng.randint(1, 64)}]={rng.choice(('TRUE', 'FALSE'))}")
        elif kind < 0.92:
            text.append(f"i=i+{rng.randint(1, 9)} ; counts")
        elif kind < 0.97:
            text += [f"IF i>{rng.randint(1, 99)} THEN", "  i=0", "ENDIF"]
        else:
            text.append(f"WAIT SEC {rng.uniform(0.1, 1):.2f}")
    return "\n".join([*text, "END", ""])


def rapid(lines: int, seed: int = 1) -> str:
    """A RAPID module of about so many lines."""
    rng = random.Random(seed)
    text = ["MODULE long", "  VAR num i:=0;", "  PROC main()"]
    while len(text) < lines - 2:
        x, y, z = rng.uniform(300, 500), rng.uniform(-200, 200), rng.uniform(300, 500)
        kind = rng.random()
        if kind < 0.75:
            target = f"[[{x:.3f},{y:.3f},{z:.3f}],[0.707107,0,0.707107,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
            text.append(f"    MoveL {target},v{rng.choice((100, 200, 500))},z{rng.choice((1, 5, 10))},tool0;")
        elif kind < 0.85:
            text.append(f"    SetDO do{rng.randint(1, 64)},{rng.randint(0, 1)};")
        elif kind < 0.92:
            text.append(f"    i:=i+{rng.randint(1, 9)}; ! counts")
        elif kind < 0.97:
            text += [f"    IF i>{rng.randint(1, 99)} THEN", "      i:=0;", "    ENDIF"]
        else:
            text.append(f"    WaitTime {rng.uniform(0.1, 1):.2f};")
    return "\n".join([*text, "  ENDPROC", "ENDMODULE", ""])


def tp(lines: int, seed: int = 1) -> str:
    """A TP listing of about so many lines: a quarter of them statements, the rest the points they go to."""
    rng = random.Random(seed)
    text: list[str] = []
    points: list[str] = []
    while len(text) + len(points) < lines - 12:
        kind = rng.random()
        if kind < 0.75:
            number = len(points) // 6 + 1
            ending = rng.choice(("FINE", "CNT50", "CNT100"))
            text.append(f"L P[{number}] {rng.choice((100, 250, 500))}mm/sec {ending}")
            x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
            w, p, r = rng.uniform(-180, 180), rng.uniform(-90, 90), rng.uniform(-180, 180)
            points += [
                f"P[{number}]{{",
                "   GP1:",
                "\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',",
                f"\tX = {x:9.3f}  mm,\tY = {y:9.3f}  mm,\tZ = {z:9.3f}  mm,",
                f"\tW = {w:9.3f} deg,\tP = {p:9.3f} deg,\tR = {r:9.3f} deg",
                "};",
            ]
        elif kind < 0.85:
            text.append(f"DO[{rng.randint(1, 64)}]={rng.choice(('ON', 'OFF'))}")
        elif kind < 0.92:
            text.append(f"R[1:count]=R[1]+{rng.randint(1, 9)}")
        elif kind < 0.97:
            text += [f"IF (R[1]>{rng.randint(1, 99)}) THEN", "R[1]=0", "ENDIF"]
        else:
            text.append(f"WAIT {rng.uniform(0.1, 1):.2f}(sec)")
    numbered = [f"{number:4}:  {line} ;" for number, line in enumerate(text, 1)]
    head = ["/PROG  LONG", "/ATTR", 'COMMENT\t\t= "long";', "DEFAULT_GROUP\t= 1,*,*,*,*;", "/MN"]
    return "\n".join([*head, *numbered, "/POS", *points, "/END", ""])


def urscript(lines: int, seed: int = 1) -> str:
    """A URScript program of about so many lines."""
    rng = random.Random(seed)
    text = ["def long():", "  i = 0"]
    while len(text) < lines - 1:
        x, y, z = rng.uniform(-0.5, 0.5), rng.uniform(-0.6, -0.3), rng.uniform(0.1, 0.5)
        a, b, c = rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-2, 2)
        kind = rng.random()
        if kind < 0.75:
            pose = f"p[{x:.5f}, {y:.5f}, {z:.5f}, {a:.5f}, {b:.5f}, {c:.5f}]"
            text.append(f"  movel({pose}, a=1.2, v={rng.choice((0.1, 0.25, 0.5))}, r={rng.choice((0.001, 0.005))})")
        elif kind < 0.85:
            text.append(f"  set_standard_digital_out({rng.randint(0, 7)}, {rng.choice(('True', 'False'))})")
        elif kind < 0.92:
            text.append(f"  i = i + {rng.randint(1, 9)} # counts")
        elif kind < 0.97:
            text += [f"  if i > {rng.randint(1, 99)}:", "    i = 0", "  end"]
        else:
            text.append(f"  sleep({rng.uniform(0.1, 1):.2f})")
    return "\n".join([*text, "end", ""])


def vplus(lines: int, seed: int = 1) -> str:
    """A V+ program of about so many lines."""
    rng = random.Random(seed)
    text = [".PROGRAM long()", "\tAUTO i", "\ti = 0"]
    while len(text) < lines - 1:
        x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(100, 300)
        a, c = rng.uniform(-90, 90), rng.uniform(-90, 90)
        kind = rng.random()
        if kind < 0.75:
            text.append(f"\tMOVES TRANS({x:.3f},{y:.3f},{z:.3f},{a:.4f},180,{c:.4f})")
        elif kind < 0.85:
            text.append(f"\tSIGNAL {rng.choice(('', '-'))}{rng.randint(1, 64)}")
        elif kind < 0.92:
            text.append(f"\ti = i+{rng.randint(1, 9)} ; counts")
        elif kind < 0.97:
            text += [f"\tIF i > {rng.randint(1, 99)} THEN", "\t    i = 0", "\tEND"]
        else:
            text.append(f"\tSPEED {rng.randint(50, 500)} MMPS ALWAYS")
    return "\n".join([*text, ".END", ""])


def inform(lines: int, seed: int = 1) -> str:
    """An INFORM job of about so many lines: moves and, in front of them, the points they go to."""
    rng = random.Random(seed)
    text: list[str] = []
    points: list[str] = []
    while len(text) + len(points) < lines - 16:
        kind = rng.random()
        if kind < 0.75:
            x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
            a, b, c = rng.uniform(-180, 180), rng.uniform(-90, 90), rng.uniform(-180, 180)
            text.append(f"MOVL C{len(points):05} V={rng.choice((100, 250, 500))}.0 PL={rng.randint(0, 4)}")
            points.append(f"C{len(points):05}={x:.3f},{y:.3f},{z:.3f},{a:.4f},{b:.4f},{c:.4f}")
        elif kind < 0.85:
            text.append(f"DOUT OT#({rng.randint(1, 64)}) {rng.choice(('ON', 'OFF'))}")
        elif kind < 0.92:
            text.append(f"ADD I000 {rng.randint(1, 9)}")
        elif kind < 0.97:
            text.append(f"SET I000 {rng.randint(1, 9)} IF I000>{rng.randint(10, 99)}")
        else:
            text.append(f"TIMER T={rng.uniform(0.1, 1):.2f}")
    head = ["/JOB", "//NAME LONG", "//POS", f"///NPOS {len(points)},0,0,0,0,0", "///TOOL 0", "///POSTYPE ROBOT"]
    middle = ["//INST", "///DATE 2024/05/06 09:30", "///ATTR SC,RW", "///GROUP1 RB1", "NOP"]
    return "\n".join([*head, "///RECTAN", "///RCONF 1,0,0,0,0,0", *points, *middle, *text, "END", ""])


def rpl(lines: int, seed: int = 1) -> str:
    """An RPL program of about so many lines."""
    rng = random.Random(seed)
    text = ["ENTRY long", "", "MODULE long", "    PROCEDURE long()", "        VAR i: INT = 0"]
    while len(text) < lines - 2:
        x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
        a, b, c = rng.uniform(-90, 90), rng.uniform(60, 90), rng.uniform(-90, 90)
        kind = rng.random()
        if kind < 0.75:
            pose = f"{{x: {x:.3f}, y: {y:.3f}, z: {z:.3f}, a: {a:.4f}, b: {b:.4f}, c: {c:.4f}}}"
            text.append(
                f"        MOVE LINEAR TO {pose} SPEED {rng.choice((100, 250))} mm/s BLEND {rng.randint(1, 9)} mm"
            )
        elif kind < 0.85:
            text.append(f"        SET do[{rng.randint(1, 64)}] TO {rng.choice(('ON', 'OFF'))}")
        elif kind < 0.92:
            text.append(f"        i = i + {rng.randint(1, 9)} -- counts")
        elif kind < 0.97:
            text += [f"        IF i > {rng.randint(1, 99)} THEN", "            i = 0", "        END IF"]
        else:
            text.append(f"        WAIT {rng.uniform(0.1, 1):.2f} s")
    return "\n".join([*text, "    END PROCEDURE", "END MODULE", ""])


GENERATORS = {
    "krl": (krl, "long.src"),
    "rapid": (rapid, "long.mod"),
    "tp": (tp, "long.ls"),
    "urscript": (urscript, "long.script"),
    "vplus": (vplus, "long.v2"),
    "inform": (inform, "LONG.JBI"),
    "rpl": (rpl, "long.rpl"),
}


def krl_points(lines: int, seed: int = 1) -> str:
    """A list of KRL points of so many lines."""
    rng = random.Random(seed)
    text = ["DEF points()", "$VEL.CP=0.25", "$APO.CDIS=5"]
    while len(text) < lines - 1:
        x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
        a, b, c = rng.uniform(-90, 90), rng.uniform(60, 90), rng.uniform(-90, 90)
        text.append(f"LIN {{X {x:.3f},Y {y:.3f},Z {z:.3f},A {a:.4f},B {b:.4f},C {c:.4f}}} C_DIS")
    return "\n".join([*text, "END", ""])


def rapid_points(lines: int, seed: int = 1) -> str:
    """A list of RAPID points of so many lines, with the tool held about one way."""
    rng = random.Random(seed)
    text = ["MODULE points", "  PROC main()"]
    while len(text) < lines - 2:
        x, y, z = rng.uniform(300, 500), rng.uniform(-200, 200), rng.uniform(300, 500)
        rotation = [middle + rng.gauss(0, 0.004) for middle in (0.5, 0.0, 0.866, 0.0)]
        length = sum(part * part for part in rotation) ** 0.5
        written = ",".join(f"{part / length:.7f}" for part in rotation)
        target = f"[[{x:.3f},{y:.3f},{z:.3f}],[{written}],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"
        text.append(f"    MoveL {target},v200,z1,tool0;")
    return "\n".join([*text, "  ENDPROC", "ENDMODULE", ""])


def tp_points(lines: int, seed: int = 1) -> str:
    """A TP listing of about so many lines: moves, and six lines for the point of each."""
    rng = random.Random(seed)
    text, points = [], []
    for number in range(1, max(lines - 7, 7) // 7 + 1):
        text.append(f"{number:4}:L P[{number}] 250mm/sec CNT50    ;")
        x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
        w, p, r = rng.uniform(-180, 180), rng.uniform(-90, 90), rng.uniform(-180, 180)
        points += [
            f"P[{number}]{{",
            "   GP1:",
            "\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',",
            f"\tX = {x:9.3f}  mm,\tY = {y:9.3f}  mm,\tZ = {z:9.3f}  mm,",
            f"\tW = {w:9.3f} deg,\tP = {p:9.3f} deg,\tR = {r:9.3f} deg",
            "};",
        ]
    return "\n".join(["/PROG  POINTS", "/ATTR", 'COMMENT\t\t= "";', "/MN", *text, "/POS", *points, "/END", ""])


POINTS = {
    "krl": (krl_points, "points.src"),
    "rapid": (rapid_points, "points.mod"),
    "tp": (tp_points, "points.ls"),
}


def rapid_taught(lines: int, seed: int = 1) -> str:
    """A RAPID module of so many lines: taught points by name, and as many moves to them."""
    rng = random.Random(seed)
    data, text = ["MODULE taught"], ["  PROC main()"]
    for number in range(10, 5 * (lines - 4) + 1, 10):
        x, y, z = rng.uniform(300, 500), rng.uniform(-200, 200), rng.uniform(300, 500)
        flags = f"{rng.randint(-1, 1)},{rng.randint(-1, 1)},{rng.randint(-1, 1)},0"
        target = f"[[{x:.2f},{y:.2f},{z:.2f}],[0.707107,0,0.707107,0],[{flags}],[9E9,9E9,9E9,9E9,9E9,9E9]]"
        data.append(f"  CONST robtarget p{number}:={target};")
        text.append(f"    MoveL p{number},v{rng.choice((100, 200, 500))},z10,tool0;")
    return "\n".join([*data, *text, "  ENDPROC", "ENDMODULE", ""])


def krl_taught(lines: int, seed: int = 1) -> str:
    """A KRL data list of so many taught points."""
    rng = random.Random(seed)
    text = ["DEFDAT taught PUBLIC"]
    for number in range(1, lines - 1):
        x, y, z = rng.uniform(400, 600), rng.uniform(-200, 200), rng.uniform(300, 600)
        a, b, c = rng.uniform(-90, 90), rng.uniform(60, 90), rng.uniform(-90, 90)
        flags = f"S {rng.choice((2, 6))},T {rng.choice((2, 35))}"
        place = f"X {x:.4f},Y {y:.4f},Z {z:.4f},A {a:.4f},B {b:.4f},C {c:.4f},{flags}"
        text.append(f"DECL E6POS XP{number}={{{place},E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}}")
    return "\n".join([*text, "ENDDAT", ""])


TAUGHT = {"rapid": (rapid_taught, "taught.mod"), "krl": (krl_taught, "taught.dat")}
