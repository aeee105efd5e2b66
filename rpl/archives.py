"""Archives of controller backups, unpacked in memory: each member whole and by its own name, or an error that names it.

What is damaged, cut off, twice there or too large never makes a shorter program in silence, and what unpacks to more
than any backup holds ends at a limit of bytes and of files.
"""

from __future__ import annotations

import bz2
import gzip
import lzma
import stat
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import PurePosixPath
from typing import Protocol

SUFFIXES = (".zip", ".tar", ".tgz", ".tar.gz", ".tar.bz2", ".tar.xz")
LARGEST_MEMBER = 64 * 2**20
MOST_BYTES = 256 * 2**20
MOST_MEMBERS = 20_000
_CHUNK = 2**20
_BLOCK = 512
_NO_FILE = "it is a link, a pipe or a device, no file"
_GZIP, _BZIP2, _XZ = b"\x1f\x8b", b"BZh", b"\xfd7zXZ"
_DAMAGE = (
    OSError,
    EOFError,
    zipfile.BadZipFile,
    tarfile.TarError,
    zlib.error,
    lzma.LZMAError,
    struct.error,
    RuntimeError,
    ValueError,
    OverflowError,
)


class SupportsRead(Protocol):
    """Bytes in pieces."""

    def read(self, size: int, /) -> bytes: ...


@dataclass(frozen=True, slots=True)
class Member:
    """A file of an archive (name as it stands there) with its bytes, or the reason why it has none. An empty name is
    the archive itself."""

    name: str
    data: bytes | None
    reason: str = ""


def members(data: bytes) -> Iterator[Member]:
    """The files of an archive in order of their names, and what is wrong with it behind them."""
    good: dict[str, bytes] = {}
    bad: list[Member] = []
    try:
        found = _zipped(data) if zipfile.is_zipfile(BytesIO(data)) else _tarred(data)
        total = 0
        for count, member in enumerate(found):
            total += len(member.data or b"")
            if count >= MOST_MEMBERS or total > MOST_BYTES:
                limit = f"{MOST_MEMBERS} files" if count >= MOST_MEMBERS else f"{MOST_BYTES // 2**20} MiB"
                good, bad = {}, [Member("", None, f"it holds more than {limit}: nothing of it is read")]
                break
            if member.data is None:
                bad.append(member)
            elif good.setdefault(member.name, member.data) is not member.data:
                bad.append(Member(member.name, None, "the archive holds two files of this name"))
    except _DAMAGE as error:
        bad.append(Member("", None, _reason(error)))
    yield from (Member(name, good[name]) for name in sorted(good))
    yield from bad


def is_archive(name: str, data: bytes) -> bool:
    """Is this an archive, by its name and by how it begins?"""
    begins = data.startswith((b"PK\x03\x04", _GZIP, _BZIP2, _XZ)) or data[257:262] == b"ustar"
    return begins and name.lower().endswith(SUFFIXES)


def unpacked(data: bytes, largest: int) -> bytes:
    """What a file that is packed by itself (gzip) holds; other files as they are. Raises ValueError with the reason
    when it is damaged or larger than that."""
    if not data.startswith(_GZIP):
        return data
    try:
        return _opened(data, largest)
    except _DAMAGE as error:
        raise ValueError(_reason(error)) from None


def _zipped(data: bytes) -> Iterator[Member]:
    with zipfile.ZipFile(BytesIO(data)) as archive:
        for info in archive.infolist():
            if info.is_dir():
                continue
            name = str(PurePosixPath(info.filename))
            if stat.S_IFMT(info.external_attr >> 16) not in (0, stat.S_IFREG):  # the mode of the file, of Unix only
                yield Member(name, None, _NO_FILE)
                continue
            try:
                with archive.open(info) as stream:
                    member = Member(name, _read(stream, LARGEST_MEMBER))
            except _DAMAGE as error:
                member = Member(name, None, _reason(error))
            yield member


def _tarred(data: bytes) -> Iterator[Member]:
    data = _opened(data, MOST_BYTES)
    with tarfile.open(fileobj=BytesIO(data), mode="r:") as archive:
        for info in archive:
            if info.isdir():
                continue
            name = str(PurePosixPath(info.name))
            try:
                stream = archive.extractfile(info) if info.isfile() or info.islnk() or info.issym() else None
                member = Member(name, _read(stream, LARGEST_MEMBER) if stream is not None else None, _NO_FILE)
            except KeyError:
                member = Member(name, None, "it is a link to what is not in the archive")
            except (*_DAMAGE, RecursionError) as error:  # links that lead in a circle
                member = Member(name, None, _reason(error))
            yield member
        # Behind the last member stands a block of zeros; the library takes a cut or damaged header for the end as well.
        if data[archive.offset : archive.offset + _BLOCK] != bytes(_BLOCK):
            yield Member("", None, f"its end is missing, or what begins at byte {archive.offset} is damaged")


def _opened(data: bytes, most: int) -> bytes:
    """What was packed as a whole; other bytes as they are."""
    if data.startswith(_GZIP):
        with gzip.GzipFile(fileobj=BytesIO(data)) as packed:
            return _read(packed, most)
    if data.startswith(_BZIP2):
        with bz2.BZ2File(BytesIO(data)) as squeezed:
            return _read(squeezed, most)
    if data.startswith(_XZ):
        with lzma.LZMAFile(BytesIO(data)) as pressed:
            return _read(pressed, most)
    return data


def _read(stream: SupportsRead, most: int) -> bytes:
    chunks, size = [], 0
    while chunk := stream.read(_CHUNK):
        size += len(chunk)
        if size > most:
            raise ValueError(f"it is larger than {most // 2**20} MiB")
        chunks.append(chunk)
    return b"".join(chunks)


def _reason(error: Exception) -> str:
    if isinstance(error, EOFError):
        return "its end is missing"
    if isinstance(error, tarfile.ReadError) and "could not be opened" in str(error):
        return "it is neither a zip nor a tar archive, or its end is missing"
    if isinstance(error, RuntimeError) and "encrypted" in str(error):
        return "it is encrypted"
    return f"it is damaged ({error})" if not isinstance(error, ValueError) and str(error) else str(error) or "damaged"
