"""Find the keys that C++ sources read from YAML files with yaml-cpp."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.review.sources.names import FoundName, NameKind

_DECLARED = re.compile(r"\bYAML\s*::\s*Node\b\s*>?\s*(?:const\s*)?&?\s*(?P<name>[A-Za-z_]\w*)")
_TAKEN = re.compile(
    r"\b(?P<name>\w+)\s*(?:=\s*(?:YAML\s*::\s*Load\w*\s*\(|(?P<node>\w+)\s*\[)|:\s*(?P<list>\w+)\s*[)\[])"
)
"""A variable that gets a loaded file, a part of another node, or each item of one."""
_CHAIN = (
    r"(?<![\w.>:])(?:this\s*->\s*)?(?P<node>{names})(?P<chain>(?:\s*\[[^\[\]]*\])+)"
    r"(?!\s*(?:\[|=(?!=)|\.\s*push_back\b))"
)
"""A part of a node, unless it is written."""
_KEY = re.compile(r'\[\s*"(?P<key>[^"\\]+)"\s*\]')
_CONVERTED = re.compile(r"\s*\.\s*as\s*<[^;()]*>\s*\(\s*\)")
"""A conversion without a fallback, which throws an error if the key is missing."""
_CONDITION = re.compile(r"(?:\bif\s*\(|&&|\|\||!|\?)[^;{}]*\Z")
_MAX_CONDITION_CHARACTERS = 200


def find_yaml_keys(text: str, headers: Sequence[str]) -> Iterator[FoundName]:
    """Yield the keys that a C++ source without comments reads from nodes of yaml-cpp.

    A key is required if its value is converted without a fallback, and nothing tests it or catches the error.

    Args:
        text: the source.
        headers: the texts of the included headers of the repository, which may declare members.
    """
    names = {match["name"] for source in (text, *headers) for match in _DECLARED.finditer(source)}
    taken = list(_TAKEN.finditer(text)) if names or "YAML" in text else []
    known = {""}  # what a loaded file is taken from
    while known != names | {""}:
        known = names | {""}
        names = names | {match["name"] for match in taken if (match["node"] or match["list"] or "") in known}
    if not names:
        return
    chains = list(re.finditer(_CHAIN.format(names="|".join(sorted(map(re.escape, names)))), text))
    is_caught = re.search(r"\bcatch\b", text) is not None
    tested = {key["key"] for match in chains if _is_tested(text, match) for key in _KEY.finditer(match["chain"])}
    for match in chains:
        for key in _KEY.finditer(match["chain"]):
            if re.search(rf"\b{match['node']}\s*\[\s*\"{re.escape(key['key'])}\"\s*\]\s*=(?!=)", text):
                continue  # the source writes the key itself
            is_converted = _CONVERTED.match(text, match.end()) is not None
            is_required = is_converted and not is_caught and key["key"] not in tested
            start = match.start("chain") + key.start("key")
            yield FoundName(NameKind.YAML_KEY, key["key"], start, start + len(key["key"]), is_required=is_required)


def _is_tested(text: str, match: re.Match[str]) -> bool:
    """Return whether a part of a node is a condition, or a call may test it."""
    before = text[max(0, match.start() - _MAX_CONDITION_CHARACTERS) : match.start()]
    is_converted = _CONVERTED.match(text, match.end()) is not None
    return not is_converted or _CONDITION.search(before) is not None
