"""Report the environment variables and arguments that a description newly reads."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import counted, joined, quoted_names
from linkwright.review.parts.include_graph import IncludeGraphs
from linkwright.review.parts.outline import ARG
from linkwright.review.parts.part_pair import PartPair
from linkwright.review.parts.unused_arguments import is_unused_argument, reads_argument
from linkwright.xmltree import Element

_VARIABLE = re.compile(r"\$\((?:opt)?env\s+(\w+)")
_FALLBACK = r"\$\(optenv\s+{}\s+([^()]*)\)"
_ARGUMENT = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_WORD = re.compile(r"\w+")


def compare_readings(pair: PartPair, graphs: IncludeGraphs) -> None:
    """Report the environment variables that no description read before, and arguments that had no use.

    Default values of arguments are in the lines about the arguments. A finding names an argument that certainly had
    no effect.

    Args:
        pair: both versions of a file, with the other changes.
        graphs: the includes of both versions.
    """
    shown = set(_WORD.findall(" ".join(str(change.sentence) for change in pair.changes)))
    readers: dict[str, Element] = {}
    for name, element in _find_readers(pair.new.root, _VARIABLE):
        readers.setdefault(name, element)
    outlines = graphs.old.iterate_outlines() if readers.keys() - shown else ()
    known = {name for _, outline in outlines for name, _ in _find_readers(outline.root, _VARIABLE, is_default=True)}
    names = [name for name in readers if name not in known]
    if not shown.issuperset(names):
        text = counted(
            "environment variable {names} is read now",
            "environment variables {names} are read now",
            len(names),
            names=joined([_add_fallback(name, readers[name]) for name in names]),
        )
        pair.add(text, None, readers[names[0]])
    old, new = (dict(_find_readers(outline.root, _ARGUMENT)) for outline in (pair.old, pair.new))
    used = [
        name
        for name in new
        if name not in old and name in pair.new.arguments and name in pair.old.arguments
        if not reads_argument(graphs.old, pair.old_path, name)
        and not is_unused_argument(graphs.old, pair.old_path, name)
    ]
    if used:
        text = counted(
            "argument {names} is used now", "arguments {names} are used now", len(used), names=quoted_names(used)
        )
        pair.add(text, None, new[used[0]])


def _add_fallback(name: str, reader: Element) -> str:
    """Return the name of a variable, with its value if it is not set."""
    pattern = re.compile(_FALLBACK.format(re.escape(name)))
    match = next(filter(None, map(pattern.search, (*reader.attributes.values(), reader.text()))), None)
    return f"'{name}' ({match[1].strip()})" if match is not None and match[1].strip() else f"'{name}'"


def _find_readers(
    root: Element, pattern: re.Pattern[str], *, is_default: bool = False
) -> Iterator[tuple[str, Element]]:
    """Yield the names that match a pattern, each with an element that reads it.

    Args:
        root: the root element of a description.
        pattern: a pattern with the name as its group.
        is_default: whether the defaults of arguments count.
    """
    for element in root.walk():
        if is_default or element.tag != ARG:
            texts = *element.attributes.values(), element.text()
            yield from ((name, element) for text in texts for name in pattern.findall(text))
