"""Find parameters of C++ functions that change places although the types of the parameters stay the same."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.installed_paths import is_exported_header
from linkwright.review.sources.cpp.functions import read_parameters
from linkwright.review.sources.cpp.text import find_closing_bracket
from linkwright.review.sources.names import HEADER_SUFFIXES, NameKind, SourceNames
from linkwright.review.sources.namespaces import HeaderChange
from linkwright.review.sources.reading import read_source_names
from linkwright.review.sources.statements.code import Code
from linkwright.review.versions import Version


def compare_argument_order(old: SourceNames, new: SourceNames) -> Iterator[HeaderChange]:
    """Yield the public functions of a header whose parameters of equal types have another order.

    Calls with the old order still build.
    """
    spans = {item.name: item.span for item in new.of_kind(NameKind.FUNCTION)}
    for key, after in new.parameter_names.items():
        name, _ = key
        before = old.parameter_names.get(key, ())
        if before == after or "" in before or sorted(before) != sorted(after) or name not in spans:
            continue
        text, reason = _describe(name, before, after)
        yield HeaderChange(text, spans[name], reason)


def _describe(name: str, old: Sequence[str], new: Sequence[str]) -> tuple[Phrase, Phrase]:
    """Return the change of a function, and the reason why it is breaking."""
    text = phrase(
        "function '{name}': parameters ({old}) -> ({new}) change places",
        name=name,
        old=", ".join(old),
        new=", ".join(new),
    )
    return text, phrase("code that calls '{name}' builds, but passes the values in the old order", name=name)


class SwappedDefinition(NamedTuple):
    """A function whose definition has its parameters in another order.

    Attributes:
        name: the name of the function.
        text: the change in one line.
        reason: the reason why it is breaking if others can call it.
        line: the line of the definition in the new version.
    """

    name: str
    text: Phrase
    reason: Phrase
    line: int


def find_swapped_definitions(old: Code, new: Code) -> Iterator[SwappedDefinition]:
    """Yield the functions of a source whose parameters of equal types change places although their code does not."""
    for name, parts in new.functions.items():
        before = old.functions.get(name, ())
        if not before or before[0].text == parts[0].text or old.get_body(name) != new.get_body(name):
            continue
        sides = [_read_parameters(name, part.text) for part in (before[0], parts[0])]
        (old_types, old_names), (new_types, new_names) = sides
        is_swapped = old_names != new_names and sorted(old_names) == sorted(new_names) and "" not in old_names
        if is_swapped and old_types == new_types:
            yield SwappedDefinition(name, *_describe(name, old_names, new_names), parts[0].first_line)


def _read_parameters(name: str, head: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the types and names of the parameters in the first statement of a function."""
    match = re.search(rf"\b{re.escape(name.rpartition('::')[2])} (?=\()", head)
    if match is None:
        return (), ()
    return read_parameters(head[match.end() + 1 : find_closing_bracket(head, match.end())])


def is_declared_without_order(version: Version, package: str, name: str) -> bool:
    """Return whether an exported header of a package declares a function, but does not name all of its parameters."""
    short = name.rpartition("::")[2]
    for path in version.paths(HEADER_SUFFIXES, package):
        if short in version.text(path) and is_exported_header(version, package, path):
            declared = read_source_names(version.file(path)).parameter_names
            own = [names for (other, _), names in declared.items() if f"::{name}".endswith(f"::{other}")]
            if own and all("" in names for names in own):
                return True
    return False
