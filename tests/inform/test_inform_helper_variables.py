"""Variables that the writer itself needs: none is data of the program."""

from test_inform_from_others import jobs_of


def test_a_helper_is_no_element_that_is_chosen_at_run_time() -> None:
    """All numbers that a controller is delivered with are taken, some of them by elements of an array only."""
    singles = "\n".join(f"VAR r{n}: REAL = {n}.5" for n in range(92))
    total = " + ".join(f"r{n}" for n in range(92))
    text = f"""VAR row: ARRAY[8] OF REAL
VAR i: INT
VAR whole: INT
VAR good: BOOL = TRUE
{singles}
FOR i = 1 TO 8
    row[i] = 10.0 * i
END FOR
whole = to_nearest({total})
FOR i = 1 TO 8
    whole = to_nearest(row[i] * 0.26)
    IF abs(row[i] - 10.0 * i) > 0.001 THEN good = FALSE
END FOR
SET do[1] TO good AND whole = 21
"""
    jobs, _, met = jobs_of("rpl", text)
    assert any("[D" in line for line in jobs["MAIN"])
    assert met == {1}
