"""What variables and places hold.

On every way to a statement, whatever its kind: `heldvalues`. Over the whole program: texts `heldtexts`, whole numbers
`wholes`, bounds of subscripts `intervals`, what is set once at the start `beginning` (asked by
`rewriting.walk.unchanged_in`). Places made in the lines in front: `straightplaces`. Read before it is set:
`firstreads`. Worked out of taught data: `taughtvalues`. Numbers of tools and frames in a controller's tables:
`framenumbers`.
"""
