"""The page of what controllers refuse says what the rules say."""

from loading_page import PAGE, page

from rpl import registry


def test_the_page_of_loading_is_current() -> None:
    assert PAGE.read_text("utf-8") == page(), "python tests/docs/loading_page.py makes it anew"


def test_every_rule_has_a_name_of_its_own() -> None:
    loaders = [registry.dialect(name).loading for name in registry.dialect_names()]
    names = [rule.name for loading in loaders if loading is not None for rule in loading().rules]
    assert len(names) == len(set(names))
