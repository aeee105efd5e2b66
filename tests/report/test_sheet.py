"""The page of `rpl translate --report`: opens from disk, loads nothing, and has every line of source and result."""

from html.parser import HTMLParser
from pathlib import Path

import pytest

from rpl.cli.main import run
from rpl.source import decode

# Elements without an end.
VOID = {"meta", "input", "br"}
LOADING = {"src", "href", "srcset", "data", "action", "poster", "background", "formaction", "manifest"}
DATA = """DEFDAT cell PUBLIC
SIGNAL doGrip $OUT[7]
DECL FRAME TABLE={X 450,Y -100,Z 20,A 0,B 0,C 0}
DECL E6POS XPICK={X 525,Y 0,Z 890,A 0,B 90,C 0,S 2,T 2,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}
DECL INT parts=3
ENDDAT
"""
PROGRAM = """DEF cell()
DECL INT i
; <b>5 & 6</b> "quoted" 'twice' </pre></script> {{ 7 * 7 }} {% raw %} | pipe ` tick
PTP {A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}
$TOOL={X 0,Y 0,Z 120,A 0,B 0,C 0}
$BASE=TABLE
FOR i = 1 TO parts
  LIN {X 100,Y 0,Z 600,A 0,B 90,C 0}
  doGrip = i < 2 AND parts > 1
ENDFOR
ANIN ON x = 1.0 * y + 2.0
END
"""


class Page(HTMLParser):
    """Checks that elements nest, and keeps them with their text."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: dict[str, list[str]] = {}
        self.feed(text)
        self.close()
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)
            self.texts.setdefault(tag, []).append("")

    def handle_endtag(self, tag: str) -> None:
        assert self.open and self.open.pop() == tag, tag

    def handle_data(self, data: str) -> None:
        for tag in self.open:
            self.texts[tag][-1] += data


@pytest.fixture(scope="module", params=["rapid", "tp", "val3"])
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Page, str]:
    folder = tmp_path_factory.mktemp(str(request.param))
    home = folder / "in"
    home.mkdir()
    (home / "cell.src").write_bytes(PROGRAM.replace("\n", "\r\n").encode())
    (home / "cell.dat").write_bytes(DATA.replace("\n", "\r\n").encode())
    call = [
        "translate",
        str(home),
        "--to",
        str(request.param),
        "--robot",
        "kuka_kr6r900sixx",
        "-o",
        str(folder / "out"),
    ]
    for name in ("page.html", "page.md"):
        assert run([*call, "--report", str(folder / name)]) == 3
    return folder, Page((folder / "page.html").read_text("utf-8")), (folder / "page.md").read_text("utf-8")


def test_the_page_loads_nothing(made: tuple[Path, Page, str]) -> None:
    _, page, _ = made
    for tag, attributes in page.tags:
        assert tag not in ("link", "iframe", "img", "object", "embed", "base"), tag
        assert not LOADING & set(attributes), (tag, attributes)
    policies = [one["content"] for tag, one in page.tags if "http-equiv" in one]
    assert policies and "default-src 'none'" in str(policies[0])
    assert not any(word in text for text in (*page.texts["script"], *page.texts["style"]) for word in ("http", "url("))


def test_every_line_of_source_and_result_is_there(made: tuple[Path, Page, str]) -> None:
    folder, page, _ = made
    shown = page.texts["pre"]
    for text in (PROGRAM, DATA):
        assert all(line in shown for line in text.splitlines())
    for path in (folder / "out").rglob("*"):
        if path.is_file() and path.suffix not in (".toml", ".json", ".cfg"):
            lines = decode(path.read_bytes())[0].replace("\r\n", "\n").rstrip("\n").split("\n")
            missing = [line for line in lines if line not in shown]
            assert not missing, (path.name, missing)


def test_the_verdict_comes_first_and_losses_stand_at_their_line(made: tuple[Path, Page, str]) -> None:
    _, page, text = made
    assert page.texts["p"][0].startswith("workable: ") and "1 statement stops" in page.texts["p"][0]
    assert text.startswith("**workable: ")
    rows = [row for row in page.texts["tr"] if row.startswith("11ANIN ON")]
    assert len(rows) == 1 and "loss" in rows[0]


def test_source_and_result_stand_side_by_side(made: tuple[Path, Page, str]) -> None:
    folder, page, _ = made
    [row] = [row for row in page.texts["tr"] if row.startswith("8  LIN {X 100")]
    assert {"rapid": "MoveL", "tp": "L P[", "val3": "movel"}[folder.name[:-1]] in row


def test_the_checklist_has_the_order_of_a_cell(made: tuple[Path, Page, str]) -> None:
    _, page, text = made
    titles = [title.partition(". ")[2] for title in page.texts["h3"] if ". " in title and title[0].isdigit()]
    order = ["Frames and tools", "Signals", "Data with numbers and retained values", "Points to touch up"]
    assert titles == [*order, "Places to check"]
    labels = [label.strip() for label in page.texts["label"]]
    assert any(label.startswith("digital out 7 doGrip is ") for label in labels)
    assert any(label.startswith("TABLE") for label in labels) and "$TOOL={X 0,Y 0,Z 120,A 0,B 0,C 0}" in labels
    assert text.count("- [ ] ") == len(labels) == len([1 for tag, _ in page.tags if tag == "input"])
    assert "localStorage" in page.texts["script"][0]


def test_texts_of_programs_are_no_marks_in_markdown(made: tuple[Path, Page, str]) -> None:
    _, _, text = made
    [row] = [line for line in text.splitlines() if "pipe" in line and line.startswith("| 3 |")]
    assert row.count("|") == 5 and "`" not in row and "<b>" not in row and "</pre>" not in row


def test_deviations_stand_at_the_move(tmp_path: Path) -> None:
    program = tmp_path / "demo.src"
    moves = "".join(f"LIN {{X {x},Y {y},Z 890,A 0,B 90,C 0}} C_DIS\n" for x, y in ((525, 0), (525, 200), (400, 200)))
    start = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 10,A6 0}\n"
    program.write_text(f"DEF demo()\n$APO.CDIS=40\n$VEL.CP=0.5\n{start}{moves}{start}END\n")
    page = tmp_path / "page.html"
    call = [
        "translate",
        str(program),
        "--to",
        "tp",
        "--robot",
        "kuka_kr6r900sixx",
        "--prove",
        "-o",
        str(tmp_path / "o"),
    ]
    run([*call, "--report", str(page)])
    rows = Page(page.read_text("utf-8")).texts["tr"]
    assert any("LIN {X 525,Y 0" in row and "turning-speed" in row and row.rstrip().endswith(" %") for row in rows)


@pytest.mark.parametrize(
    ("name", "said"), [("page.pdf", "writes .html or .md"), ("mine.html", "was not written by rpl")]
)
def test_another_kind_and_files_of_others_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, said: str
) -> None:
    program = tmp_path / "demo.src"
    program.write_text("DEF demo()\nEND\n")
    (tmp_path / "mine.html").write_text("<p>mine</p>")
    call = ["translate", str(program), "--to", "rapid", "-o", str(tmp_path / "out"), "--report", str(tmp_path / name)]
    assert run(call) == 2
    assert said in capsys.readouterr().err and not (tmp_path / "out").exists()
