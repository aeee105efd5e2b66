"""Lines of a program as text, layout apart: what `output_measures.py` counts and compares.

A line is code, data (a declaration, a point of a list, a constant stored at the head) or nothing (comment, empty line,
header of the file). Comments and layout never count, so nothing can be won by moving code into them; data is told
apart by what stands in the line, not by the file that holds it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import PurePosixPath

_TOKEN = re.compile(r'"(?:[^"]|"")*"|\'[^\']*\'|\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+|[A-Za-z_$#][\w$]*|\S')
_NUMBER = re.compile(r"\d|\.\d")
_NAMED_NUMBER = re.compile(r"\[(-?\d+)\s*:[^\]\"]*\]")
_LITERAL = re.compile(r"^(?:p?\[[\d\s.,eE+\-]*\]|[-+]?[\d.]+(?:[eE][-+]?\d+)?|True|False|\"[^\"]*\")$", re.ASCII)
_STORED = re.compile(r"^(?:global\s+|local\s+)?(\w+)\s*=\s*(.*)$")
_KRL_DATA = re.compile(
    r"(?:GLOBAL\s+)?(?:DECL|INT|REAL|BOOL|CHAR|E6POS|E6AXIS|POS|AXIS|FRAME|SIGNAL|STRUC|ENUM|EXT|EXTFCT)\b",
    re.IGNORECASE,
)
_RAPID_DATA = re.compile(r"(?:LOCAL\s+|TASK\s+)*(?:PERS|CONST|VAR|ALIAS)\b", re.IGNORECASE)
_RAPID_BLOCK = re.compile(
    r"(?:THEN|ELSE|DO|:|ENDIF|ENDFOR|ENDWHILE|ENDTEST|ENDPROC|ENDFUNC|ENDTRAP|ENDMODULE|ENDRECORD|ERROR|UNDO|BACKWARD)$"
    r"|^(?:LOCAL\s+)?(?:PROC|FUNC|TRAP|RECORD|MODULE|TEST)\b",
    re.IGNORECASE,
)
_RAPID_HEADER = re.compile(r"%%%|VERSION\s*:|LANGUAGE\s*:|%%%$", re.IGNORECASE)
_VPLUS_DATA = re.compile(
    r"(?:AUTO|LOCAL|GLOBAL)\b|SET\s+#?[\w.\[\]]+\s*=\s*#?(?:TRANS|PPOINT)\([\d\s.,eE+\-]*\)$", re.IGNORECASE
)
_RPL_DATA = re.compile(r"(?:SIGNAL|CONST|RETAIN|VAR|RECORD|ENUM)\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Lines:
    """What stands in one text, each line in its normal form (`normal`)."""

    code: tuple[str, ...]
    data: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Layout:
    """How a language is cut into lines. Files of other endings are side files: they are not counted at all."""

    suffixes: frozenset[str]
    cut: Callable[[str, bool], Iterator[tuple[str, bool]]]
    case_sensitive: bool = False
    data_suffixes: frozenset[str] = frozenset()


def lines_of(language: str, path: str, text: str) -> Lines | None:
    """The lines of one file, None for a side file."""
    layout, suffix = LAYOUTS[language], PurePosixPath(path.replace("\\", "/")).suffix.lower()
    if suffix not in layout.suffixes:
        return None
    code: list[str] = []
    data: list[str] = []
    for line, is_data in layout.cut(text, suffix in layout.data_suffixes):
        shown = normal(line, layout.case_sensitive)
        if shown:
            (data if is_data else code).append(shown)
    return Lines(tuple(code), tuple(data))


def normal(line: str, case_sensitive: bool = False) -> str:
    """The line without layout: one blank between two words and none elsewhere, numbers to three places without zeros
    behind, capitals folded where the language does not tell them apart, the name beside a number (`R[1:count]`) and
    the end of the statement left out. Texts in quotes stay as they are."""
    parts: list[str] = []
    for token in _TOKEN.findall(_NAMED_NUMBER.sub(r"[\1]", line).rstrip("; \t\r")):
        word = _number(token) if _NUMBER.match(token) else token
        if not case_sensitive and word[0] not in "\"'":
            word = word.lower()
        if parts and (parts[-1][-1].isalnum() or parts[-1][-1] == "_") and (word[0].isalnum() or word[0] == "_"):
            parts.append(" ")
        parts.append(word)
    return "".join(parts)


def _number(token: str) -> str:
    try:
        value = round(float(token), 3)
    except ValueError:
        return token
    return f"{value:.3f}".rstrip("0").rstrip(".")


def without_comment(line: str, begins: str) -> str:
    """The line up to its comment; what stands in double quotes begins none."""
    quoted = False
    for at, sign in enumerate(line):
        quoted ^= sign == '"'
        if not quoted and line.startswith(begins, at):
            return line[:at]
    return line


def _krl(text: str, data: bool) -> Iterator[tuple[str, bool]]:
    for line in text.splitlines():
        found = without_comment(line, ";").strip()
        if found and not found.startswith("&") and not re.match(r"(?:DEFDAT|ENDDAT)\b", found, re.IGNORECASE):
            yield found, data or bool(_KRL_DATA.match(found))


def _rapid(text: str, data: bool) -> Iterator[tuple[str, bool]]:
    begun, record = "", False
    for line in text.splitlines():
        found = without_comment(line, "!").strip()
        if not found or _RAPID_HEADER.match(found):
            continue
        begun = f"{begun} {found}".strip()
        if not (begun.endswith(";") or _RAPID_BLOCK.search(begun)):
            continue
        for one in _statements(begun):
            record = record or bool(re.match(r"(?:LOCAL\s+)?RECORD\b", one, re.IGNORECASE))
            yield one, record or bool(_RAPID_DATA.match(one))
            record = record and not re.match(r"ENDRECORD\b", one, re.IGNORECASE)
        begun = ""
    if begun:
        yield begun, data


def _statements(line: str) -> list[str]:
    """The statements of a line, cut at the semicolons outside of texts."""
    return [one for part in re.findall(r'(?:"[^"]*"|[^;"])+;?', line) if (one := part.strip(" ;\t"))]


def _tp(text: str, _data: bool) -> Iterator[tuple[str, bool]]:
    body, _, points = text.partition("/MN")[2].partition("/POS")
    begun = ""
    for line in body.splitlines():
        found = re.match(r"\s*(\d*)\s*:\s?(.*)$", line)
        if found is None:
            continue
        begun = f"{begun} {found[2].strip()}".strip()
        if not begun.endswith(";"):
            continue
        whole, begun = begun.rstrip("; \t"), ""
        if whole and not whole.startswith(("!", "--", "//")):
            yield whole, False
    for name in re.findall(r"^\s*(P\[\d+)", points, re.MULTILINE):
        yield f"{name}]", True


def _inform(text: str, _data: bool) -> Iterator[tuple[str, bool]]:
    instructions = False
    for line in text.splitlines():
        found = line.strip()
        if found.startswith("//INST"):
            instructions = True
        if not found or found.startswith(("/", "'")):
            continue
        if instructions:
            yield found.partition(" //")[0], False
        elif re.match(r"[A-Z]+\d+=", found):
            yield found.partition("=")[0], True


def _urscript(text: str, _data: bool) -> Iterator[tuple[str, bool]]:
    """Constants that are stored at the head of the program are data, and places wherever they are stored."""
    depth, begun = 0, False
    for line in text.splitlines():
        found = without_comment(line, "#").strip()
        if not found:
            continue
        stored = _STORED.match(found)
        constant = stored is not None and bool(_LITERAL.match(stored[2]))
        place = constant and stored is not None and "[" in stored[2]
        data = place or (constant and depth <= 1 and not begun)
        yield found, data
        opens = found.endswith(":") and not re.match(r"(?:elif|else)\b", found)
        begun = begun or (depth == 1 and not data and not re.match(r"(?:def|thread)\b|end$", found))
        depth += 1 if opens else -1 if found == "end" else 0


def _vplus(text: str, _data: bool) -> Iterator[tuple[str, bool]]:
    section = False
    for line in text.splitlines():
        found = without_comment(line, ";").strip()
        if not found:
            continue
        if re.match(r"\.(?:LOCATIONS|REALS|STRINGS|DOUBLES)\b", found, re.IGNORECASE):
            section = True
        elif re.match(r"\.PROGRAM\b", found, re.IGNORECASE):
            section = False
            yield found, False
        elif re.match(r"\.END\b", found, re.IGNORECASE):
            section = False
        else:
            yield found, section or bool(_VPLUS_DATA.match(found))


def _val3(text: str, data: bool) -> Iterator[tuple[str, bool]]:
    if data:
        yield from ((name, True) for name in re.findall(r"<Data\s+name=\"[^\"]*\"", text))
        return
    yield from ((name, True) for name in re.findall(r"<Local\s+name=\"[^\"]*\"", text))
    for line in "\n".join(re.findall(r"<!\[CDATA\[(.*?)\]\]>", text, re.DOTALL)).splitlines():
        found = without_comment(line, "//").strip()
        if found and found not in ("begin", "end"):
            yield found, False


def _rpl(text: str, _data: bool) -> Iterator[tuple[str, bool]]:
    for line in text.splitlines():
        found = without_comment(line, "--").strip()
        if found:
            yield found, bool(_RPL_DATA.match(found))


LAYOUTS = {
    "krl": Layout(frozenset((".src", ".sub", ".dat")), _krl, data_suffixes=frozenset((".dat",))),
    "rapid": Layout(frozenset((".mod", ".modx", ".prg", ".sys", ".sysx")), _rapid),
    "tp": Layout(frozenset((".ls",)), _tp),
    "inform": Layout(frozenset((".jbi",)), _inform),
    "urscript": Layout(frozenset((".script", ".urscript")), _urscript, case_sensitive=True),
    "vplus": Layout(frozenset((".v2", ".pg", ".lc", ".re", ".st")), _vplus),
    "val3": Layout(frozenset((".pgx", ".dtx")), _val3, case_sensitive=True, data_suffixes=frozenset((".dtx",))),
    "rpl": Layout(frozenset((".rpl",)), _rpl),
}
