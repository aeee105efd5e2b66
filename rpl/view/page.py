"""The page that plays a run: one HTML file that opens from disk and loads nothing.

It draws by WebGL with a script of its own. The page forbids itself every connection, and texts of programs reach it as
data that scripts set as text, never as markup.
"""

from __future__ import annotations

from importlib import resources

from rpl.report.page import script_json
from rpl.view.document import Row

ARM = "arm.js"  # how an arm moves, as in the page of `rpl run --plot`
TEXTS = ("page.html.j2", "page.css", "motion.js", "drawing.js", "camera.js", "panels.js", "page.js")


def view_page(document: Row) -> str:
    """The whole page as text."""
    import jinja2

    own = resources.files("rpl.view.player")
    texts = {ARM: (resources.files("rpl.report") / ARM).read_text("utf-8")}
    texts |= {name: (own / name).read_text("utf-8") for name in TEXTS}
    environment = jinja2.Environment(
        loader=jinja2.DictLoader(texts), autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True
    )
    return environment.get_template("page.html.j2").render(
        title=document["title"],
        status=document["status"],
        fault=document["fault"],
        json=script_json(document),
        style=texts["page.css"],
        scripts=[texts[name] for name in texts if name.endswith(".js")],
    )
