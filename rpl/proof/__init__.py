"""Proof by running: two programs on the emulated robot, their traces compared, the first difference explained.

This package imports nothing on its own; `rpl.proof.prove` decides, `rpl.proof.compare` says what equal means.
"""
