"""The parameters of macros, and the blocks in macro calls."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.grammar import PREFIX, XACRO
from linkwright.language.outline import OutlineElement
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import Parameter, parse_parameters


def macro_parameters(macro: NameDefinition) -> tuple[Parameter, ...]:
    """Return the parameters of a macro, or an empty tuple if they cannot be parsed."""
    try:
        return tuple(parse_parameters(macro.detail))
    except Fault:
        return ()


def called_macro(tag: str, names: Sequence[NameDefinition]) -> NameDefinition | None:
    """Return the macro that a tag calls, or None for other tags."""
    if not tag.startswith(PREFIX) or tag in XACRO:
        return None
    called = tag.removeprefix(PREFIX).rpartition(".")[2]
    return next((name for name in names if name.kind is NameKind.MACRO and name.name == called), None)


def block_parameters(element: OutlineElement, names: Sequence[NameDefinition]) -> Iterator[tuple[OutlineElement, str]]:
    """Yield the blocks in a macro call, each with the name of its parameter.

    A xacro element may expand to any number of blocks, so the iteration ends at the first one.
    """
    macro = called_macro(element.tag.name, names)
    blocks = [] if macro is None else [parameter.name for parameter in macro_parameters(macro) if parameter.is_block]
    for child, name in zip(element.children, blocks, strict=False):
        if child.tag.name.startswith(PREFIX):
            return
        yield child, name
