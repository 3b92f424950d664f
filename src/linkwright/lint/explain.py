"""The documentation pages of codes: docstrings of rules, or sections of ``pages/``.

Each file of ``pages/`` has a section ``## CODE: title`` for each code of one package.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from linkwright.diagnostics import Phrase, joined, nearest, phrase, term, title_of_page
from linkwright.lint.option import OptionValue
from linkwright.lint.registry import all_rules, find_rule
from linkwright.lint.rule import Rule
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import dataclass

PAGES = Path(__file__).parent / "pages"
_PAGE_SECTION = lazy_pattern(r"^## ([A-Z]+[0-9]{3}): (.+?)\n(.*?)(?=^## [A-Z]+[0-9]{3}: |\Z)", re.MULTILINE | re.DOTALL)

_HEADINGS: dict[str, str] = {
    heading: heading for heading in (phrase("## Why"), phrase("## Example"), phrase("## Use instead"))
}
"""The headings in the docstrings of rules. They are translated, whereas the text between them is in English only."""


@dataclass(frozen=True, slots=True)
class Page:
    """The documentation page of a code.

    Texts that can be translated are phrases.

    Attributes:
        code: the code of the diagnostic.
        title: a description of the reported problem, in one line without a full stop.
        text: the rest, in Markdown.
        name: the name of the rule; empty for a diagnostic that does not belong to a rule.
    """

    code: str
    title: Phrase
    text: Phrase
    name: str = ""

    @property
    def markdown(self) -> Phrase:
        """The page as Markdown."""
        header_lines: list[str] = [phrase("# {code}: {title}", code=self.code, title=self.title)]
        if self.name:
            header_lines = [f"# {self.code}: {self.name}", "", phrase("{title}.", title=self.title)]
        return _join_lines(*header_lines, "", self.text)


def find_page(code_or_name: str) -> Page | None:
    """Return the page of a code or rule name, ignoring case, or None if there is none."""
    rule = find_rule(code_or_name)
    return make_rule_page(rule) if rule else read_room_pages().get(code_or_name.strip().upper())


def make_rule_page(rule: Rule) -> Page:
    """Return the page of a rule: its docstring, the setting that enables it, and its options."""
    from inspect import cleandoc  # Imported here because a check does not print pages.

    title, _, text = cleandoc(rule.__doc__ or "").partition("\n")
    severity = phrase(
        "Severity: {severity}. {state}", severity=term(rule.severity.value), state=_describe_default(rule)
    )
    lines = [severity, "", *(_HEADINGS.get(line, line) for line in text.strip().splitlines())]
    if rule.options:
        lines += ["", phrase("## Options"), ""]
        lines += [
            phrase("- `{name}` (default `{value}`): {meaning}", name=name, value=to_toml(default), meaning=meaning)
            for name, default, meaning in ((option.name, option.default, option.meaning) for option in rule.options)
        ]
        lines += ["", "```toml", f"[options.{rule.name}]"]
        lines += [f"{option.name} = {to_toml(option.default)}" for option in rule.options]
        lines += ["```"]
    return Page(rule.code, title_of_page(title.rstrip(".")), _join_lines(*lines), rule.name)


@cache
def read_room_pages() -> dict[str, Page]:
    """Return the pages of the diagnostics that do not belong to rules, by code."""
    pages = {}
    for file in sorted(PAGES.glob("*.md")):
        for code, title, text in _PAGE_SECTION.findall(file.read_text(encoding="utf-8")):
            pages[code] = Page(code, title_of_page(title.strip()), Phrase(text.strip()))
    return pages


def known_codes() -> tuple[str, ...]:
    """Return all codes that have a page."""
    return (*(rule.code for rule in all_rules()), *read_room_pages())


def find_similar_codes(text: str) -> list[str]:
    """Return the codes and rule names that are similar to a text, for suggestions."""
    upper = text.upper()
    names = [rule.name for rule in all_rules()]
    codes = known_codes()
    same_room = [code for code in codes if code[:-1] == upper[:-1]] if upper[-1:].isdigit() else []
    return list(dict.fromkeys([*nearest(text, names), *nearest(upper, codes), *same_room[:3]]))[:4]


def to_toml(value: OptionValue) -> str:
    """Return an option's value in TOML syntax."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return f"[{', '.join(to_toml(item) for item in value)}]"
    return repr(value)


def _describe_default(rule: Rule) -> Phrase:
    if rule.default:
        return phrase("On by default.")
    return phrase('Off by default; `extend-select = ["{code}"]` enables it.', code=rule.code)


def _join_lines(*lines: str) -> Phrase:
    return joined(lines, "\n")
