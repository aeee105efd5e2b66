"""What is known of a program: effects, uses, settings and places in force, values, order of moves. Nothing is
rewritten here.
"""
