"""The robot's side of a run: from a programmed target to a planned move, the queue of moves, what happens on the path.

`chain` makes a planned move of a target, `orders` is what a task hands over, `queue` drives it in `pieces`; the others
are one matter each: stops, searches, actions on the path, corners, robots that move together.
"""
