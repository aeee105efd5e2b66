"""Hypothesis strategies for well-typed RPL programs.

A drawn program has numbers, truth values, texts, an array, a record, poses, routines with values and references, all
structures, jumps, bits, waits with and without a limit, outputs and moves. It always ends, never divides by zero and
stays inside of the arm's reach, so that a run that fails is a fault of ours.
"""

from __future__ import annotations

from hypothesis import strategies as st

ARM = "kuka_kr6r900sixx"

_FRAME = """MODULE generated
    RECORD part (weight: REAL, count: INT, good: BOOL)
    CONST home: JOINTS = {{j1: 0, j2: -90, j3: 90, j4: 0, j5: 60, j6: 0}}
    CONST left: JOINTS = {{j1: 30, j2: -80, j3: 85, j4: 10, j5: 65, j6: -20}}
    CONST near: POSE = {{x: 480, y: 80, z: 680, a: 170, b: 30, c: 180}}
    CONST far: POSE = {{x: 520, y: -60, z: 640, a: 180, b: 20, c: 170}}
    VAR i: INT = 0
    VAR k: INT = 0
    VAR n: INT = 3
    VAR m: INT = -2
    VAR x: REAL = 0.5
    VAR y: REAL = -1.25
    VAR b: BOOL = FALSE
    VAR late: BOOL = FALSE
    VAR t: STRING[30] = "abc"
    VAR list: ARRAY[4] OF INT
    VAR bolt: part = {{weight: 1.5, count: 2, good: TRUE}}
    VAR place: POSE
    PROCEDURE main()
        place = near
        list[1] = 1
        list[2] = -4
        list[3] = 7
        list[4] = 0
        MOVE TO home JOINT SPEED 50 %
{main}
        SET do[9] TO n > m
        SET do[10] TO b
        SET do[11] TO bolt.good AND THEN bolt.count > 2
        SET do[12] TO place.x > 490
    END PROCEDURE
    PROCEDURE work(c: INT, r: REAL)
{work}
    END PROCEDURE
    PROCEDURE bump(REFERENCE c: INT, by: INT)
        c = (c + by) MOD 40
    END PROCEDURE
    FUNCTION pick(c: INT): INT
        IF c > 2 THEN
            RETURN c - n
        END IF
        RETURN list[c MOD 2 + 2] + c
    END FUNCTION
    FUNCTION heavy(p: part): BOOL
        RETURN p.weight > 2.0
    END FUNCTION
END MODULE
"""

_small = st.integers(-9, 9)
_whole_names = st.sampled_from(("n", "m"))


def whole(depth: int = 2) -> st.SearchStrategy[str]:
    """Whole numbers that stay small."""
    leaves = st.sampled_from(("n", "m", "list[2]", "bolt.count", "to_int(x)", "to_nearest(y)"))
    leaf = st.one_of(_small.map(lambda v: f"({v})" if v < 0 else str(v)), leaves)
    if depth == 0:
        return leaf
    inner = whole(depth - 1)
    bits = st.tuples(inner, st.sampled_from(("band", "bor", "bxor")), st.integers(0, 15))
    return st.one_of(
        leaf,
        st.tuples(inner, st.sampled_from("+-"), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        st.tuples(inner, st.integers(2, 5)).map(lambda t: f"({t[0]} * {t[1]})"),
        st.tuples(inner, st.sampled_from(("div", "mod")), st.integers(2, 7)).map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        bits.map(lambda t: f"(abs({t[0]}) {t[1]} {t[2]})"),
        inner.map(lambda e: f"abs({e})"),
        inner.map(lambda e: f"pick({e} mod 2 + 2)"),
    )


def real() -> st.SearchStrategy[str]:
    leaf = st.one_of(
        st.sampled_from(("x", "y", "0.5", "2.25", "-3.75", "bolt.weight")), whole(0).map(lambda e: f"to_real({e})")
    )
    return st.one_of(
        leaf,
        st.tuples(leaf, st.sampled_from("+-*"), leaf).map(lambda t: f"({t[0]} {t[1]} ({t[2]}))"),
        st.tuples(leaf, st.sampled_from(("2", "8"))).map(lambda t: f"(({t[0]}) / {t[1]})"),
        leaf.map(lambda e: f"sqrt(abs({e}))"),
    )


def truth(depth: int = 2) -> st.SearchStrategy[str]:
    comparison = st.tuples(whole(1), st.sampled_from(("<", ">", "<=", ">=", "=", "<>")), whole(1))
    leaf = st.one_of(
        comparison.map(lambda t: f"({t[0]} {t[1]} {t[2]})"),
        st.sampled_from(
            ("b", "late", "bolt.good", "heavy(bolt)", 't = "abc"', 'text_part(t, 1, 2) = "ab"', "place.x > 481")
        ),
    )
    if depth == 0:
        return leaf
    inner = truth(depth - 1)
    joined = st.tuples(inner, st.sampled_from(("AND", "OR", "AND THEN", "OR ELSE", "XOR")), inner)
    return st.one_of(leaf, inner.map(lambda e: f"(NOT ({e}))"), joined.map(lambda t: f"(({t[0]}) {t[1]} ({t[2]}))"))


_FIXED = (
    "MOVE TO left JOINT SPEED 40 %",
    "MOVE TO home JOINT SPEED 80 %",
    "MOVE LINEAR TO near SPEED 200 mm/s",
    "MOVE LINEAR TO far SPEED 250 mm/s",
    "MOVE LINEAR TO place SPEED 250 mm/s",
    "MOVE LINEAR TO near SPEED 200 mm/s\nMOVE LINEAR BY {x: 8, z: -5} SPEED 200 mm/s",
    "WAIT 0.1 s",
    "WAIT UNTIL di[1] TIMEOUT 0.3 s FLAG late",
    "WAIT UNTIL NOT di[1] TIMEOUT 0.2 s FLAG late",
    "place = near : {x: 12, y: -4, z: 6, a: 0, b: 0, c: 0}",
    "place = near",
    "place.x = 500",
    "bolt = {weight: 2.5, count: 1, good: FALSE}",
    "bolt.good = NOT bolt.good",
    "bolt.count = (bolt.count + 1) MOD 5",
    't = "abc"',
    't = text_part(t, 1, 2) & "xy"',
    "n = text_length(t)",
    "PULSE do[13] TO ON FOR 0.1 s\nWAIT 0.2 s",
)


def simple() -> st.SearchStrategy[str]:
    """One statement, or a few that belong together."""
    return st.one_of(
        st.tuples(_whole_names, whole()).map(lambda t: f"{t[0]} = {t[1]} mod 50"),
        real().map(lambda e: f"x = {e}\nIF abs(x) > 100 THEN\nx = 1.5\nEND IF"),
        truth().map(lambda e: f"b = {e}"),
        st.tuples(st.integers(1, 4), whole(1)).map(lambda t: f"list[{t[0]}] = {t[1]} mod 20"),
        whole(1).map(lambda e: f"list[abs({e}) mod 4 + 1] = 2"),
        st.tuples(st.integers(1, 8), truth(1)).map(lambda t: f"SET do[{t[0]}] TO {t[1]}"),
        st.tuples(st.sampled_from(("n", "m", "list[3]")), whole(1)).map(lambda t: f"bump({t[0]}, {t[1]} mod 9)"),
        st.sampled_from(_FIXED),
    )


def block(depth: int) -> st.SearchStrategy[str]:
    statement = simple() if depth == 0 else st.one_of(simple(), simple(), nested(depth))
    return st.lists(statement, min_size=1, max_size=4).map("\n".join)


def nested(depth: int) -> st.SearchStrategy[str]:
    inner = block(depth - 1)
    counter = "ik"[depth % 2]
    leaving = st.sampled_from(("", "IF n > 20 THEN EXIT", "IF m < -5 THEN CONTINUE"))
    return st.one_of(
        st.tuples(truth(1), inner, inner).map(lambda t: f"IF {t[0]} THEN\n{t[1]}\nELSE\n{t[2]}\nEND IF"),
        st.tuples(truth(1), inner, truth(0), inner).map(
            lambda t: f"IF {t[0]} THEN\n{t[1]}\nELSEIF {t[2]} THEN\n{t[3]}\nEND IF"
        ),
        st.tuples(st.integers(-1, 2), st.integers(0, 3), leaving, inner).map(
            lambda t: f"FOR {counter} = {t[0]} TO {t[1]}\n{t[2]}\n{t[3]}\nEND FOR"
        ),
        st.tuples(st.integers(2, 3), st.integers(0, 3), inner).map(
            lambda t: f"FOR {counter} = {t[0]} TO {t[1]} STEP -1\n{t[2]}\nEND FOR"
        ),
        st.tuples(st.integers(1, 3), leaving.filter(lambda e: "CONTINUE" not in e), inner).map(
            lambda t: f"{counter} = {t[0]}\nWHILE {counter} > 0\n{counter} = {counter} - 1\n{t[1]}\n{t[2]}\nEND WHILE"
        ),
        st.tuples(st.integers(1, 3), inner).map(
            lambda t: f"{counter} = {t[0]}\nREPEAT\n{counter} = {counter} - 1\n{t[1]}\nUNTIL {counter} <= 0"
        ),
        st.tuples(whole(1), inner, inner, inner).map(
            lambda t: f"SWITCH abs({t[0]}) mod 4\nCASE 0, 1\n{t[1]}\nCASE 2\n{t[2]}\nDEFAULT\n{t[3]}\nEND SWITCH"
        ),
    )


@st.composite
def programs(draw: st.DrawFn) -> str:
    """A whole program."""
    calls = st.tuples(whole(1), real()).map(lambda t: f"work({t[0]}, {t[1]})")
    leap = st.tuples(truth(0), block(0)).map(lambda t: f"IF {t[0]} THEN GOTO over\n{t[1]}\nLABEL over")
    parts = draw(st.lists(st.one_of(block(2), block(2), calls), min_size=1, max_size=4))
    if draw(st.booleans()):
        parts.insert(draw(st.integers(0, len(parts))), draw(leap))
    work = draw(block(1))
    return _FRAME.format(main="\n".join(parts), work=f"n = n + c mod 10\ny = r\n{work}")
