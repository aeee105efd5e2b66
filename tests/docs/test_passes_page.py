"""The page of the passes says what they say."""

from passes_page import PAGE, page

from rpl.passes.legalise.pipeline import PASSES


def test_the_page_of_the_passes_is_current() -> None:
    assert PAGE.read_text("utf-8") == page(), "python tests/docs/passes_page.py makes it anew"


def test_every_pass_says_what_it_does() -> None:
    assert [one.name for one in PASSES if not one.purpose] == []
