"""The page about a run: one HTML file that opens from disk and loads nothing.

The drawing library stands inside the page, and the page forbids itself every connection. Texts of the program reach the
page escaped: by the template in the table, as JSON in the data, by the script where the library reads markup.
"""

from __future__ import annotations

import json
from importlib import resources
from typing import TYPE_CHECKING

from rpl.errors import UsageError

if TYPE_CHECKING:
    from rpl.report.document import RunDocument
    from rpl.report.motion import MoveRow

MISSING = "--plot needs the plotly package: pip install 'robot-rpl[plot]'"


def drawing_library() -> str:
    """The script of the drawing library. Raises UsageError when it is not installed."""
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise UsageError(MISSING) from error
    script: str = get_plotlyjs()
    return script


def page(document: RunDocument, library: str) -> str:
    """The whole page as text; `library` is the script of `drawing_library`."""
    import jinja2

    folder = resources.files("rpl.report")
    texts = {name: (folder / name).read_text("utf-8") for name in ("page.html.j2", "page.css", "arm.js", "page.js")}
    environment = jinja2.Environment(
        loader=jinja2.DictLoader(texts), autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True
    )
    data = document.data
    return environment.get_template("page.html.j2").render(
        heading=document.heading,
        data=data,
        rows=[_cells(number, row, document) for number, row in enumerate(shown_rows(document))],
        notes=document.notes,
        json=script_json(data),
        library=library,
        style=texts["page.css"],
        script=texts["arm.js"] + texts["page.js"],
    )


def shown_rows(document: RunDocument) -> tuple[MoveRow, ...]:
    """The moves that the table has."""
    shown = document.data.get("moves", [])
    assert isinstance(shown, list)
    return document.moves[: len(shown)]


def script_json(value: object) -> str:
    """JSON that may stand in a script element: nothing in it can end the element or begin another one."""
    text = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _cells(number: int, row: MoveRow, document: RunDocument) -> dict[str, object]:
    """One row of the table as it is read."""
    text = document.labels.table_text(row.origin)
    return {
        "number": number,
        "place": document.labels.place(row.origin),
        "file": row.origin.file,
        "text": text,
        "kind": row.kind + (" (cut off)" if row.interrupted else ""),
        "start": f"{row.start_s:.3f}",
        "duration": f"{row.end_s - row.start_s:.3f}",
        "length": f"{row.length_mm:.1f}",
        "top": f"{row.top_speed_mm_s:.0f}",
        "speed": f"{100.0 * row.speed.share:.0f} % J{row.speed.axis + 1}",
        "acceleration": f"{100.0 * row.acceleration.share:.0f} % J{row.acceleration.axis + 1}",
        "margin": f"{100.0 * row.margin.share:.0f} % J{row.margin.axis + 1}",
        "exceeds": max(row.speed.share, row.acceleration.share * document.limits_known) > 1.005
        or row.margin.share < 0.0,
    }
