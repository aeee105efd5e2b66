"""Types, values, numbers and built-in functions. Behind it they are the target's."""
