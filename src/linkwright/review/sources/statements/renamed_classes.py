"""Find classes of a source that have another name, so that their code is compared with the old code."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace

from linkwright.review.sources.statements.code import Code, Part

_LITERAL_OR_WORD = re.compile(r""""(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|\w+""")
_CONSTRUCTOR, _DESTRUCTOR = "()", "~()"
_MIN_SIMILARITY = 0.5
"""The minimum share of common methods among the methods of a class that has another name."""


def find_renamed_classes(old: Code, new: Code) -> dict[str, str]:
    """Return the new names of the classes that only have another name, by their old names.

    Such a class has most methods of the old one, or most statements of one without methods. The new version does not
    mention the old name.
    """
    sides = [_list_methods(code) for code in (old, new)]
    removed, added = ({name: sides[i][name] for name in sides[i] if name not in sides[1 - i]} for i in (0, 1))
    words = {word for part in _list_parts(new) for word in _LITERAL_OR_WORD.findall(part.text)}
    renamed: dict[str, str] = {}
    for name, methods in removed.items():
        scores = {
            other: len(methods & others) / len(methods | others)
            for other, others in added.items()
            if other not in renamed.values() and _split(name)[0] == _split(other)[0]
        }
        best = max(scores, key=lambda other: scores[other], default=None)
        if best is not None and scores[best] >= _MIN_SIMILARITY and _split(name)[1] not in words:
            renamed[name] = best
    return renamed


def rename_classes(code: Code, renamed: Mapping[str, str]) -> Code:
    """Return code with other names of classes."""
    if not renamed:
        return code
    words = {_split(name)[1]: _split(other)[1] for name, other in renamed.items()}

    def rename(text: str) -> str:
        return _LITERAL_OR_WORD.sub(lambda match: words.get(match[0], match[0]), text)

    def rename_parts(parts: Mapping[str, list[Part]]) -> dict[str, list[Part]]:
        return {
            rename(name): [part._replace(text=rename(part.text)) for part in items] for name, items in parts.items()
        }

    return replace(code, functions=rename_parts(code.functions), outside=rename_parts(code.outside))


def _list_methods(code: Code) -> dict[str, set[str]]:
    """Return the names of the methods of each class, or the statements of a class without methods.

    Constructors and destructors have marks instead of names.
    """
    methods: dict[str, set[str]] = {}
    for function in code.functions:
        scope, method = _split(function)
        if scope:
            class_name = _split(scope)[1]
            marks = {class_name: _CONSTRUCTOR, f"~{class_name}": _DESTRUCTOR}
            methods.setdefault(scope, set()).add(marks.get(method, method))
    for name, parts in code.outside.items():
        if name and name not in methods and len(parts) > 1:
            word = re.compile(rf"\b{re.escape(_split(name)[1])}\b")
            methods[name] = {word.sub(_CONSTRUCTOR, part.text) for part in parts[1:]}
    return methods


def _list_parts(code: Code) -> list[Part]:
    return [part for parts in (*code.functions.values(), *code.outside.values()) for part in parts]


def _split(name: str) -> tuple[str, str]:
    """Return the scope and the last part of a qualified name."""
    scope, _, short = name.rpartition("::" if "::" in name else ".")
    return scope, short


def drop_reported(renamed: Mapping[str, str], reported: Iterable[str]) -> dict[str, str]:
    """Return the renamed classes without those that other lines about the source report as added or removed.

    Args:
        renamed: the new names by the old ones.
        reported: the other lines about the source.
    """
    lines = [line for line in reported if " renamed to " not in line]
    return {
        name: other
        for name, other in renamed.items()
        if not any(f"'{_split(word)[1]}'" in line for line in lines for word in (name, other))
    }
