"""The values that the conditions of a description compare with its arguments."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from linkwright.descriptions.argument_sets.calling import ArgumentSet
from linkwright.loading.deferred import lazy_pattern
from linkwright.xmltree import Document, Element

_ARGUMENT = r"\$\(arg\s+([\w.-]+)\s*\)"
_OPERAND = rf"""(?:['"]?{_ARGUMENT}['"]?|\barg\(\s*['"]([\w.-]+)['"]\s*\)|\b([A-Za-z_]\w*))"""
_TEXT = lazy_pattern(r"""'([^'$]+)'|"([^"$]+)\"""")
_COMPARISON = lazy_pattern(rf"""{_OPERAND}\s*(?:==\s*((?:'[^'$]+')|(?:"[^"$]+"))|in\s*[\[({{]([^\])}}]*))""")
_CONDITION_TAGS = frozenset({"xacro:if", "xacro:unless"})


def compared_values(documents: Iterable[Document]) -> tuple[ArgumentSet, ...]:
    """Return an uncertain argument set for each value to which a condition compares one.

    An argument is also recognized through a property that contains it, as in
    ``<xacro:property name="side" value="$(arg side)"/>``. Macro parameters are not followed.

    Args:
        documents: the unexpanded files of a description.
    """
    elements = [element for document in documents for element in document.root.walk()]
    names = dict(_find_argument_names(elements))
    compared_sets: dict[tuple[str, str], ArgumentSet] = {}
    for element in elements:
        if element.tag not in _CONDITION_TAGS:
            continue
        for operand, value in _find_comparisons(element.attributes.get("value", "")):
            if operand in names:
                argument_set = ArgumentSet(
                    {names[operand]: value}, (), element.attribute_span("value"), is_certain=False
                )
                compared_sets.setdefault((names[operand], value), argument_set)
    return tuple(compared_sets.values())


def empty_defaults(documents: Iterable[Document]) -> tuple[str, ...]:
    """Return the names of the arguments with an empty default.

    An empty default often means that callers must pass a value.
    """
    return tuple(dict.fromkeys(name for name, default in _list_defaults(documents) if not default))


def usable_defaults(documents: Iterable[Document]) -> frozenset[str]:
    """Return the names of the arguments with a default that is not empty."""
    return frozenset(name for name, default in _list_defaults(documents) if default)


def _list_defaults(documents: Iterable[Document]) -> Iterator[tuple[str, str]]:
    """Yield the name and the default of each argument that has one."""
    for element in (element for document in documents for element in document.root.walk()):
        if element.tag == "xacro:arg" and {"name", "default"} <= element.attributes.keys():
            yield element.attributes["name"], element.attributes["default"]


def _find_argument_names(elements: Iterable[Element]) -> Iterator[tuple[str, str]]:
    """Yield the name of each argument, and of each property that contains an argument.

    Each name is paired with the name of the argument.
    """
    for element in elements:
        name = element.attributes.get("name", "")
        if element.tag == "xacro:arg":
            yield name, name
        elif element.tag == "xacro:property":
            match = re.fullmatch(rf"\s*{_ARGUMENT}\s*", element.attributes.get("value", ""))
            if match is not None:
                yield name, match[1]


def _find_comparisons(condition: str) -> Iterator[tuple[str, str]]:
    """Yield each operand of ``==`` and ``in``, paired with each text that it is compared with."""
    for *operands, single_text, text_list in _COMPARISON.findall(condition):
        operand = next(filter(None, operands))
        for match in _TEXT.findall(single_text or text_list):
            yield operand, next(filter(None, match))
