"""The page of the templates says what they say."""

from templates_page import PAGE, page


def test_the_page_of_the_templates_is_current() -> None:
    assert PAGE.read_text("utf-8") == page(), "python tests/docs/templates_page.py makes it anew"
