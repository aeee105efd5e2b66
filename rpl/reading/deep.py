"""Statements whose expressions are nested very deeply: superfluous brackets fall away, what is left has a limit.

Every later room follows expressions by calls of its own, so that a depth beyond all sense is refused where the
statement is read. What the statement is without the deep part tells whether it opens, divides or ends a block.
"""

from __future__ import annotations

from lark import Token, Tree

__all__ = ["DEEPEST_TREE", "depth_of", "shallow", "tokens_of", "without_depth"]

# Levels of a statement's tree: a call in a call takes up to four, an operator or a pair of brackets one.
DEEPEST_TREE = 5_000
# Trees of a pair of brackets around one expression, as the grammars name them.
_BRACKETS = ("group", "parenthesis")


def shallow(tree: Tree[Token]) -> Tree[Token]:
    """The tree, without brackets around brackets where it is deeper than the limit: `((a))` means what `(a)` means.

    The tree is changed in place."""
    if depth_of(tree) <= DEEPEST_TREE:
        return tree
    work = [tree]
    while work:
        node = work.pop()
        for at, child in enumerate(node.children):
            if isinstance(child, Tree):
                node.children[at] = inner = _innermost(child)
                work.append(inner)
    return tree


def depth_of(tree: Tree[Token]) -> int:
    """The levels of a tree."""
    level, depth = [tree], 0
    while level:
        depth += 1
        level = [child for node in level for child in node.children if isinstance(child, Tree)]
    return depth


def tokens_of(tree: Tree[Token]) -> list[Token]:
    """The words of a tree in the order in which they are written."""
    found: list[Token] = []
    work: list[Tree[Token] | Token] = [tree]
    while work:
        node = work.pop()
        if isinstance(node, Tree):
            work.extend(reversed(node.children))
        elif node is not None:  # an optional part that is not there
            found.append(node)
    return found


def without_depth(tree: Tree[Token]) -> Tree[Token]:
    """A tree of the same kind of statement, whose deep expressions are cut short: a part takes the place of the
    whole that is made by the same rule. The tree is changed in place."""
    while depth_of(tree) > DEEPEST_TREE:
        path = _deepest_path(tree)
        lowest = {node.data: at for at, node in enumerate(path)}
        at = next((at for at, node in enumerate(path) if at > 0 and lowest[node.data] > at), None)
        if at is None:  # no rule leads back to itself: no depth comes of it
            return tree
        above, below = path[at - 1], path[lowest[path[at].data]]
        above.children = [below if child is path[at] else child for child in above.children]
    return tree


def _innermost(tree: Tree[Token]) -> Tree[Token]:
    """The last of brackets that hold nothing but brackets."""
    while tree.data in _BRACKETS and len(tree.children) == 1:
        inner = tree.children[0]
        if not isinstance(inner, Tree) or inner.data != tree.data or len(inner.children) != 1:
            break
        tree = inner
    return tree


def _deepest_path(tree: Tree[Token]) -> list[Tree[Token]]:
    """The nodes from the root to one that lies deepest."""
    levels: list[list[tuple[Tree[Token], int]]] = [[(tree, 0)]]
    while levels[-1]:
        below = [
            (child, at) for at, (node, _) in enumerate(levels[-1]) for child in node.children if isinstance(child, Tree)
        ]
        levels.append(below)
    path: list[Tree[Token]] = []
    at = 0
    for level in reversed(levels[:-1]):
        node, at = level[at]
        path.append(node)
    return path[::-1]
