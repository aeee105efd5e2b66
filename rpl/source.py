"""Bytes to text and back: encodings, line ends, spans and positions.

A `Source` keeps the bytes that were read. Its text decodes them without loss: `source.encoded()` gives back the same
bytes, whatever the encoding was. Positions are offsets into the text; lines and columns are derived when asked for.
"""

from __future__ import annotations

import errno
import stat
from bisect import bisect_right
from dataclasses import dataclass, field
from pathlib import Path

# No robot program is larger (bytes).
LARGEST_FILE = 256 * 1024 * 1024
# Order matters: a strict decoder that fails is a proof that the text is something else. Latin-1 never fails.
_ENCODINGS = ("utf-8", "cp1252", "latin-1")


@dataclass(frozen=True, slots=True, eq=False)
class Source:
    """One input file. `text` keeps its line ends as they were (`\\r\\n`, `\\n`, `\\r`), so offsets map to bytes."""

    path: str
    data: bytes = field(repr=False)
    text: str = field(repr=False)
    encoding: str
    _line_starts: list[int] = field(default_factory=list, repr=False)

    def encoded(self) -> bytes:
        """The text encoded again; equals `data` by construction."""
        return self.text.encode(self.encoding)

    def position(self, offset: int) -> tuple[int, int]:
        """One-based line and column of a text offset."""
        starts = self.line_starts()
        line = bisect_right(starts, offset)
        return line, offset - starts[line - 1] + 1

    def line_starts(self) -> list[int]:
        """Offsets at which lines begin (computed once)."""
        if not self._line_starts:
            starts = self._line_starts
            starts.append(0)
            find = self.text.find
            if "\n" in self.text or "\r" not in self.text:
                at = find("\n")
                while at >= 0:
                    starts.append(at + 1)
                    at = find("\n", at + 1)
            else:
                at = find("\r")
                while at >= 0:
                    starts.append(at + 1)
                    at = find("\r", at + 1)
        return self._line_starts

    @property
    def name(self) -> str:
        """File name without folder and last suffix."""
        return Path(self.path).stem


@dataclass(frozen=True, slots=True)
class Comment:
    """A remark of the source (text without the comment sign). `behind`: it stood on the line of its statement.
    `layout`: it is a mark of the source's editor, such as a fold."""

    text: str
    behind: bool = False
    layout: bool = False


@dataclass(frozen=True, slots=True)
class Origin:
    """Where a node came from: a span of a source (offsets, end exclusive) and the comments that travel with it."""

    source: Source | None = None
    start: int = 0
    end: int = 0
    comments: tuple[Comment, ...] = ()

    @property
    def file(self) -> str:
        return self.source.path if self.source else ""

    @property
    def line(self) -> int:
        return self.source.position(self.start)[0] if self.source else 0

    @property
    def column(self) -> int:
        return self.source.position(self.start)[1] if self.source else 0

    @property
    def place(self) -> str:
        """`file:line: `, what stands before a message; nothing where there is no source."""
        return f"{self.file}:{self.line}: " if self.source else ""

    @property
    def text(self) -> str:
        """The source text of the span."""
        return self.source.text[self.start : self.end] if self.source else ""


NOWHERE = Origin()


def decode(data: bytes) -> tuple[str, str]:
    """Text and encoding of `data` such that encoding the text gives `data` again.

    Controllers write 8-bit code pages; newer tools write UTF-8, some with a byte order mark or UTF-16 with one.
    """
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        codec = "utf-16-le" if data.startswith(b"\xff\xfe") else "utf-16-be"
        try:
            text = data.decode(codec, "surrogatepass")
        except UnicodeDecodeError:  # its end is missing
            text = "\x00"
        if "\x00" not in text and text.encode(codec, "surrogatepass") == data:
            return text, codec
    for encoding in _ENCODINGS:
        try:
            return data.decode(encoding), encoding
        except UnicodeDecodeError:
            continue
    return data.decode("latin-1"), "latin-1"


def source_from_bytes(path: str, data: bytes) -> Source:
    text, encoding = decode(data)
    return Source(path, data, text, encoding)


def source_from_text(path: str, text: str) -> Source:
    return Source(path, text.encode("utf-8"), text, "utf-8")


def read_bytes(path: Path | str, largest: int | None = None) -> bytes:
    """The bytes of a file. Raises OSError when it cannot be read, is larger than that, or is no file: a pipe or a
    device may never end."""
    about = Path(path).stat()
    if stat.S_ISDIR(about.st_mode):
        raise IsADirectoryError(errno.EISDIR, "it is a folder", str(path))
    if not stat.S_ISREG(about.st_mode):
        raise OSError(errno.EINVAL, "it is a pipe or a device, no file", str(path))
    if largest is not None and about.st_size > largest:
        raise OSError(errno.EFBIG, f"it is larger than {largest // 2**20} MiB", str(path))
    return Path(path).read_bytes()


def read_source(path: Path | str) -> Source:
    """Read one file. Raises OSError when it cannot be read."""
    return source_from_bytes(str(path), read_bytes(path))
