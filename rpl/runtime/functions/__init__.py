"""What neutral functions, procedures and system variables do. `neutral` is the table of functions, `procedures` that of
procedures, `system` that of variables of the controller; the others are the matters that the functions are about.
"""
