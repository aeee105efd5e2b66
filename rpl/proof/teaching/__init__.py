"""Re-teaching: taught data of two programs is moved alike, and the proof is made again.

`data` lists what a program's pendant teaches, `pairs` finds the same in the other program, `moving` says how far each
goes, `retaught` proves again and names what does not mean the same any more.
"""
