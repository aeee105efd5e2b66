"""KRL's own kinematic functions, as routines of the prelude: the last argument says whether there is an answer.

`INVERSE(E6POS, E6AXIS start, INT error)` gives the axes of a point, `FORWARD(E6AXIS, INT error)` the point of axes,
both with the tool and base in force; the error is 0 where it worked. No manual at hand describes them; users do.
"""

from __future__ import annotations

from rpl import ir

# M: another number than 0 in the last argument says that there is no answer; which one says why is not known.
NO_ANSWER = 1


def kinematics() -> tuple[ir.Routine, ...]:
    """INVERSE and FORWARD. M: S and T of the point choose the posture; without them it is the one nearest to start."""
    point, start = ir.Name("POINT"), ir.Name("START")
    inverse: ir.Body = (
        ir.If(
            (
                (
                    ir.Builtin("is_reachable", (point, start)),
                    (_error(0), ir.Return(ir.Builtin("target_to_joints_near", (point, start)))),
                ),
            )
        ),
        _error(NO_ANSWER),
        ir.Return(start),
    )
    forward: ir.Body = (_error(0), ir.Return(ir.Builtin("joints_to_target", (ir.Name("AXES"),))))
    target, joints = ir.TargetType("krl"), ir.JointsType()
    error = ir.Parameter("ERR", ir.IntType(), "reference")
    return (
        ir.Routine(
            "INVERSE",
            "function",
            (ir.Parameter("POINT", target), ir.Parameter("START", joints), error),
            joints,
            body=inverse,
            scope="global",
        ),
        ir.Routine("FORWARD", "function", (ir.Parameter("AXES", joints), error), target, body=forward, scope="global"),
    )


def _error(number: int) -> ir.Statement:
    return ir.Assign(ir.Name("ERR"), ir.IntLiteral(number))
