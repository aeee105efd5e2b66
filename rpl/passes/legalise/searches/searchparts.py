"""Search moves in the form that the target has: some give the place they found, some only say whether they did.

A target that only says it: the robot stands at the place then, unless it went on. A target that only gives the place
gets a variable for it; whether anything was found, an error handler finds out where the target has them.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import SearchResult, Watched
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

NO_PLACE = code(
    "search-place-lost", Severity.LOSS, "the target does not say where the condition came true while it moves on"
)
NO_HIT = code("search-hit-lost", Severity.LOSS, "the target does not say whether the condition came true")
_NOT_FOUND = "ERR_WHLSEARCH"
_ALREADY = "ERR_SIGSUPSEARCH"


@legalising(unless=lambda context: "Search" not in context.capabilities.statements)
def search_parts(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with search moves."""
    raises = _NOT_FOUND in rules_of(context.source).errors

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        missed: list[ir.Name] = []

        def change(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.Move) and statement.search is not None:
                if _by_handler(statement.search, editor, raises):
                    if not missed:
                        missed.append(editor.temporary("missed", ir.BoolType()))
                    return _handled(statement, statement.search, editor, missed[0])
                if editor.capabilities.interrupts.watched is Watched.ALL:
                    return _told(statement, statement.search, editor, raises)
                return _fitted(statement, statement.search, editor, raises)
            return (inside(statement, lambda inner: map_body(inner, change)),)

        done = edit_bodies(routine, lambda body: map_body(body, change))
        if not missed:
            return done
        said: ir.Body = (ir.Assign(missed[0], ir.BoolLiteral(True)), ir.TryNext())
        return replace(done, handlers=(ir.Handler((ir.Name(_NOT_FOUND),), said), *done.handlers))

    return edit_routines(program, context, work)


def _by_handler(search: ir.Search, editor: Editor, raises: bool) -> bool:
    """Can only an error handler find out what the program asks for, whether the condition came true?"""
    can = editor.capabilities
    unknown = search.hit is not None and SearchResult.HIT not in can.motion.search_results
    named = _NOT_FOUND in rules_of(editor.context.target).errors
    return unknown and named and can.errors.handlers and not raises and search.stop != "none"


def _handled(move: ir.Move, search: ir.Search, editor: Editor, missed: ir.Name) -> ir.Body:
    """A search that raises an error where it finds nothing. Where the condition holds at once there is no move."""
    assert search.hit is not None  # as the caller has found
    place = search.found or editor.temporary("found", ir.TargetType(editor.context.source))
    way: ir.Body = (
        ir.Assign(missed, ir.BoolLiteral(False)),
        replace(move, search=replace(search, found=place, hit=None)),
        ir.Assign(search.hit, ir.Unary("not", missed)),
    )
    if search.edge == "either":
        return expansion(move.origin, way)
    there = search.condition if search.edge == "rising" else ir.Unary("not", search.condition)
    at_once: list[ir.Statement] = [ir.Assign(search.hit, ir.BoolLiteral(True))]
    if search.found is not None:
        at_once.append(ir.Assign(search.found, ir.Builtin("current_target", ())))
    inner = tuple(replace(one, origin=replace(move.origin, comments=())) for one in way)
    return expansion(move.origin, (ir.If(((there, tuple(at_once)),), inner),))


def _told(move: ir.Move, search: ir.Search, editor: Editor, raises: bool) -> ir.Body:
    """A search that says whether it found, and the errors of the source language as the program's own."""
    if search.hit is not None or not raises:
        return (move,)
    hit = editor.temporary("hit", ir.BoolType())
    before: ir.Body = ()
    if search.edge != "either" and search.stop != "none" and _ALREADY in rules_of(editor.context.source).errors:
        there = search.condition if search.edge == "rising" else ir.Unary("not", search.condition)
        before = (ir.If(((there, (ir.Raise(ir.Name(_ALREADY)),)),)),)
    failed = ir.If(((ir.Unary("not", hit), (ir.Raise(ir.Name(_NOT_FOUND)),)),))
    return expansion(move.origin, (*before, replace(move, search=replace(search, hit=hit)), failed))


def _fitted(move: ir.Move, search: ir.Search, editor: Editor, raises: bool) -> ir.Body:
    says = editor.capabilities.motion.search_results
    report = editor.context.diagnostics.report
    if search.hit is not None and SearchResult.HIT not in says:
        report(NO_HIT, move.origin)
        return (move,)
    if search.found is None and SearchResult.HIT not in says:
        place = editor.temporary("found", ir.TargetType(editor.context.source))
        return (replace(move, search=replace(search, found=place)),)
    if search.found is None or SearchResult.FOUND in says:
        return _told(move, search, editor, raises) if "hit" in says else (move,)
    if search.stop == "none":
        report(NO_PLACE, move.origin)
        return (move,)
    hit = search.hit if search.hit is not None else editor.temporary("hit", ir.BoolType())
    done = replace(move, search=replace(search, found=None, hit=hit))
    reached = ir.Assign(search.found, ir.Builtin("current_target", ()))
    failed: ir.Body = (ir.Raise(ir.Name(_NOT_FOUND)),) if raises else ()
    stand = () if "WaitForMotion" not in editor.capabilities.statements else (ir.WaitForMotion(),)
    return expansion(move.origin, (done, *stand, ir.If(((hit, (reached,)),), failed)))
