"""Loops, branches, jumps and conditions. Behind it they are the target's."""
