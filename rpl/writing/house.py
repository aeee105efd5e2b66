"""A plant's own templates: the folder of `--templates`, with one folder for each target that it has macros for."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path

from rpl.errors import UsageError

__all__ = ["house_files"]


def house_files(folder: Path, target: str, targets: Sequence[str]) -> dict[str, str]:
    """The plant's template files for a target, path -> text. Raises UsageError when there are none, for a folder of no
    target, and for a file that is no text."""
    if not folder.is_dir():
        raise UsageError(f"there is no folder {folder} of templates")
    for entry in sorted(folder.iterdir()):
        if entry.is_dir() and not entry.name.startswith((".", "_")) and entry.name not in targets:
            close = get_close_matches(entry.name, targets, 1)
            hint = f"; did you mean {close[0]}?" if close else f": there are {', '.join(targets)}"
            raise UsageError(f"{entry}: there is no target {entry.name!r}{hint}")
    found = {}
    own = folder / target
    for path in sorted(own.glob("*.j2")) if own.is_dir() else ():
        try:
            found[str(path)] = path.read_text("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise UsageError(f"{path} cannot be read as text: {error}") from None
    if not found:
        raise UsageError(f"no template for {target} stands in {folder}: {own} has no file that ends in .j2")
    return found
