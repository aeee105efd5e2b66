"""Reserved words and placeholders of RAPID: what no declaration can be named, and what the editor leaves behind."""

from __future__ import annotations


def words(text: str) -> frozenset[str]:
    """The words of a list."""
    return frozenset(text.split())


# RAPID kernel reference, list of reserved words, without the module attributes (they are reserved nowhere else).
RESERVED = words(
    """ALIAS AND BACKWARD CASE CONNECT CONST DEFAULT DIV DO ELSE ELSEIF ENDFOR ENDFUNC ENDIF ENDMODULE ENDPROC ENDRECORD
    ENDTEST ENDTRAP ENDWHILE ERROR EXIT FALSE FOR FROM FUNC GOTO IF INOUT LOCAL MOD MODULE NOT OR PERS PROC RAISE RECORD
    RETRY RETURN STEP TASK TEST THEN TO TRAP TRUE TRYNEXT UNDO VAR WHILE WITH XOR"""
)
MODULE_ATTRIBUTES = frozenset(("SYSMODULE", "NOSTEPIN", "VIEWONLY", "READONLY", "NOVIEW"))
PLACEHOLDERS = words("SMT EXP ID VAR ARG TDN DDN RDN PAR ALT DIM EIT CSE")
