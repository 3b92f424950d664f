"""Report arguments of launch files that were true or false and now choose between texts."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import phrase, quoted_names
from linkwright.review.file_pair import FilePair
from linkwright.review.launches.outlines import CONDITION, Entry, LaunchOutline

_TERM_END = re.compile(r" and (?=(?:if|unless|after) )")
_SWITCH = re.compile(r"(?:if|unless) \$\((?:var|arg) (?P<name>[\w./-]+)(?: [^()]*)?\)")
"""A condition that is the value of an argument."""
_COMPARISON = re.compile(
    r"(?:[\"']?\$\((?:var|arg) (?P<name>[\w./-]+)(?: [^()]*)?\)[\"']?|\barg\([\"'](?P<key>[\w./-]+)[\"']\))"
    r"\s*[!=]=\s*[\"'](?P<text>[^\"']*)[\"']"
)
"""A comparison of an argument with a text."""
_BOOLEANS = frozenset({"true", "false", "1", "0"})


def report_changed_kinds(pair: FilePair, old: LaunchOutline, new: LaunchOutline) -> None:
    """Report the arguments that switched actions on and off in the old version and choose between texts now.

    Args:
        pair: both versions of the launch file.
        old: the old outline, with the new names of arguments.
        new: the outline of the new file.
    """
    switches = {match["name"] for _, term in _list_terms(old) if (match := _SWITCH.fullmatch(term)) is not None}
    for name in sorted(switches):
        word = re.compile(rf"(?<![\w./-]){re.escape(name)}(?![\w./-])")
        terms = [(entry, term) for entry, term in _list_terms(new) if word.search(term)]
        comparisons = [match for _, term in terms for match in _COMPARISON.finditer(term)]
        texts = {match["text"] for match in comparisons if name in (match["name"], match["key"])}
        is_only_compared = not any(word.search(_COMPARISON.sub("", term)) for _, term in terms)
        if not texts or not is_only_compared or {text.lower() for text in texts} & _BOOLEANS:
            continue
        if _has_told_default(name, old, new):
            continue
        values = quoted_names(sorted(texts))
        text = phrase(
            "argument '{name}' chooses between {values} now, not between true and false", name=name, values=values
        )
        reason = phrase("callers that pass 'true' or 'false' start other nodes")
        pair.add(text, pair.location(terms[0][0].span), reason)


def _list_terms(outline: LaunchOutline) -> Iterator[tuple[Entry, str]]:
    """Yield the terms of the conditions of a file, each with its action."""
    for entry in outline.entries:
        yield from ((entry, term) for term in _TERM_END.split(entry.settings.get(CONDITION, "")) if term)


def _has_told_default(name: str, old: LaunchOutline, new: LaunchOutline) -> bool:
    """Return whether the declared default changes from a boolean to another word, which another line tells."""
    before, after = (
        [entry.settings.get("default", "") for entry in outline.entries if entry.has_value and entry.name == name]
        for outline in (old, new)
    )
    return len(before) == len(after) == 1 and before[0].lower() in _BOOLEANS and after[0].lower() not in _BOOLEANS
