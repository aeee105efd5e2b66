"""Moves to taught points as KUKA's inline forms, which the pendant opens and touches up.

`moves`: what the form of a move says; `wanted`: which settings are asked for where; `data`: the names and data lists'
lines; `written`: the folds around them.
"""
