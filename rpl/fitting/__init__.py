"""Adjusts the motion parameters of a controller to a recorded log: `log` reads one, `shapes` finds the motions in it,
`squares` is the least squares, `adjust` the two ways of fitting: with the program that was run, and without."""
