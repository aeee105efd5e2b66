"""docs/templates.md: how statements look in each target, macro by macro, from the macros themselves.

python tests/docs/templates_page.py        writes the page
"""

from __future__ import annotations

import sys
from pathlib import Path

from rpl import registry
from rpl.writing.templates import macro_texts

PAGE = Path(__file__).parents[2] / "docs" / "templates.md"
_HEAD = """# A house style of your own

The tables of this page are generated from the templates: `python tests/docs/templates_page.py` makes it.

How a statement looks is a [Jinja](https://jinja.palletsprojects.com/en/stable/templates/) macro of its target.
Python decides words and values (names, numbers, expressions, which form of a statement it is), the macro decides
layout, order and comments. A plant puts its own macros into `DIR/<target>/*.j2`, under any file name, and gives the
folder to `rpl translate`. Macros that are not there stay as they are. `rpl templates TARGET` lists the macros and
their words; `rpl templates TARGET -o DIR` writes copies to begin with. A macro takes those of the words that it
names.

```text
-- house.j2: how our plant writes RAPID
{% macro module(header, remarks, name, attributes, behind, declarations, routines) %}
! ------------------------------------------------
! Plant 7, line 4: do not edit without the cell book
! ------------------------------------------------
{{ shipped.module(header, remarks, name, attributes, behind, declarations, routines) }}
{% endmacro %}

{% macro remark(text) %}
! {{ text | trim }}
{% endmacro %}

{% macro move(word, options, via, target, speed, events, zone, tool, frame, load, actions) %}
{{ word }}{{ options ~ ", " if options else " " }}{{ via ~ ", " if via }}{{ target }}, {{ speed }},
{{- " " ~ events ~ "," if events }} {{ zone }}, {{ tool }}{{ "\\\\WObj:=" ~ frame if frame }}
{{- "\\\\TLoad:=" ~ load if load }}
{%- for action in actions %}, {{ action }}{% endfor %};

{% endmacro %}
```

```sh
mkdir -p house/rapid
mv house.j2 house/rapid/
rpl translate samples/krl/palletiser --to rapid --templates house -o written
rpl templates rapid
rpl templates krl -o house
```

- A macro's lines stand between its tags, without indentation: what is written indents, numbers and wraps them.
  Lines of tags leave nothing behind.
- `shipped.<macro>(...)` is the macro that the target brings, to put lines around it. Macros whose names begin with
  `_` are helpers of their file.
- What the macros wrote is read back and compared with what the target's own write. A word that a macro has lost
  (the tool of a move) or an instruction that it has added is the error `template-changes-program` at that line;
  what cannot be read is `template-not-read`.
- Refused with the file and line of the macro: one that the target has not, a word that it does not get, an error of
  Jinja's syntax, one that fails (with the place of the statement in the source) or that gives no text.
- Templates see texts only and run in Jinja's sandbox.
"""


def page() -> str:
    lines = [_HEAD]
    for name in registry.target_names():
        texts = macro_texts(registry.target_package(name))
        if not texts:
            continue
        lines += [f"## {registry.target(name).title}", ""]
        for file in sorted({one.file for one in texts.values()}):
            lines += [f"`{name}/{file}`", "", "| macro | words | for |", "|---|---|---|"]
            for one in texts.values():
                if one.file == file:
                    words = ", ".join(f"`{word}`" for word in one.words)
                    lines.append(f"| `{one.name}` | {words} | {one.note.replace('|', chr(92) + '|')} |")
            lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(0 if PAGE.write_text(page(), "utf-8") else 1)
