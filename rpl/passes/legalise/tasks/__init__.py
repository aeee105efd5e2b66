"""Programs that run side by side: begun, ended, waited for, kept apart. Behind it a program has the control of tasks
that the target has.
"""
