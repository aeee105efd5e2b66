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


GENERATORS = {"krl": (krl, "long.src"), "rapid": (rapid, "long.mod")}
