"""What only the source's language has around a program: its prelude, marks of its editor, names of its own for neutral
things.
"""
