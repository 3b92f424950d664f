"""Find arguments of descriptions whose values reach nothing."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field

from linkwright.review.parts.include_graph import IncludeGraph
from linkwright.review.parts.outline import STATEMENTS, MacroOutline, Outline
from linkwright.xmltree import Element

_XACRO = "xacro:"
_DYNAMIC_CALL = "xacro:call"
_COMPUTED_ARGUMENT = re.compile(r"\$\(arg\s+[^)\s]*\$|\bxacro\.arg\b")
"""A use of an argument whose name is an expression."""


def is_unused_argument(graph: IncludeGraph, path: str, name: str) -> bool:
    """Return whether no value of an argument reaches the robots with a file.

    A parameter of a macro that ignores it is not a use.

    Args:
        graph: the includes of the version that declares the argument.
        path: the file that declares the argument.
        name: the name of the argument.
    """
    outlines = graph.find_outlines_of_robots(path)
    return outlines is not None and not _Uses(outlines).reaches_argument(name)


def reads_argument(graph: IncludeGraph, path: str, name: str) -> bool:
    """Return whether a file, or a file that it includes, may read an argument, whatever it does with the value."""
    written = _make_pattern(name)
    return graph.declares(path, lambda outline: next(_find_uses(outline.root, written), None) is not None)


def _make_pattern(name: str) -> re.Pattern[str]:
    return re.compile(rf"\$\(arg\s+{re.escape(name)}\s*\)|{_COMPUTED_ARGUMENT.pattern}")


@dataclass
class _Uses:
    """The uses of values in the files of robots."""

    outlines: Collection[Outline]
    ignored: dict[tuple[str, str], bool] = field(default_factory=dict)

    def reaches_argument(self, name: str) -> bool:
        """Return whether a value of an argument reaches a robot."""
        written = _make_pattern(name)
        return any(self._is_reached(outline.root, written) for outline in self.outlines)

    def _is_reached(self, root: Element, written: re.Pattern[str]) -> bool:
        """Return whether an element uses a value, except in parameters that macros ignore."""
        return any(
            parameter is None or not self._ignores(element.tag.removeprefix(_XACRO), parameter)
            for element, parameter in _find_uses(root, written)
        )

    def _ignores(self, macro: str, parameter: str) -> bool:
        """Return whether no definition of a macro uses a parameter.

        The macros that it calls see the parameter, too, unless they have one of the same name.
        """
        key = macro, parameter
        if key not in self.ignored:
            self.ignored[key] = True  # a recursive call passes the value on, which is not a use
            definitions = [outline.macros[macro] for outline in self.outlines if macro in outline.macros]
            self.ignored[key] = bool(definitions) and not any(
                parameter not in definition.parameters or self._uses_parameter(definition, parameter)
                for definition in definitions
            )
        return self.ignored[key]

    def _uses_parameter(self, macro: MacroOutline, parameter: str) -> bool:
        """Return whether a macro, or a macro that sees its parameter, uses the parameter."""
        written = re.compile(rf"(?<![\w.]){re.escape(parameter)}(?!\w)")
        in_expression = re.compile(rf"\$\{{[^}}]*{written.pattern}|\$\(.*{written.pattern}.*\)")
        return any(
            seeing is None or self._is_reached(seeing.element, in_expression)
            for seeing in self._find_seeing_macros(macro, parameter)
        )

    def _find_seeing_macros(self, macro: MacroOutline, parameter: str) -> Iterator[MacroOutline | None]:
        """Yield a macro and those that it calls and that have no parameter of this name; None for unknown ones."""
        pending, visited = [macro], {macro.name}
        while pending:
            current = pending.pop()
            yield current
            for element in current.element.walk():
                if element.tag == _DYNAMIC_CALL:
                    yield None
                name = element.tag.removeprefix(_XACRO)
                if element.tag in STATEMENTS or name == element.tag or name in visited:
                    continue
                visited.add(name)
                called = [outline.macros[name] for outline in self.outlines if name in outline.macros]
                if not called:
                    yield None
                pending += (other for other in called if parameter not in other.parameters)


def _find_uses(root: Element, written: re.Pattern[str]) -> Iterator[tuple[Element, str | None]]:
    """Yield the elements that use a value, with the parameter that a call of a macro passes it as."""
    for element in root.walk():
        is_call = element.tag.startswith(_XACRO) and element.tag not in STATEMENTS
        for attribute, value in element.attributes.items():
            if written.search(value):
                yield element, attribute if is_call else None
        if written.search(element.text()):
            yield element, None
