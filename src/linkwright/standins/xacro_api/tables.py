"""The symbol tables of properties and macros in the API of the module ``xacro``."""

from __future__ import annotations

import sys
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.standins.xacro_api import color
from linkwright.standins.xacro_api.errors import XacroException
from linkwright.standins.xacro_api.evaluation import eval_text
from linkwright.standins.xacro_api.stacks import STATE, print_location
from linkwright.xacro.expressions.scope import parse_literal

_DOCUMENT_VERBOSITY, _FULL_VERBOSITY = 2, 3
"""The verbosities above which the properties of the document, or all properties, are logged."""


class Table(dict[str, Any]):
    """A symbol table with a parent table.

    Strings are evaluated on first access.

    Args:
        parent: the parent table; a plain dict contains the names that xacro provides.

    Attributes:
        parent: the parent table, or the dict of the names that xacro provides.
        root: the table of the names that xacro provides.
        depth: the number of parent tables, without the names that xacro provides.
        unevaluated: the names whose values are not evaluated yet.
        recursive: the names that are being evaluated.
    """

    def __init__(self, parent: dict[str, Any] | None = None) -> None:
        super().__init__()
        self.parent: dict[str, Any] = {} if parent is None else parent
        self.root: dict[str, Any] = parent.root if isinstance(parent, Table) else self.parent
        self.depth: int = parent.depth + 1 if isinstance(parent, Table) else 0
        self.unevaluated: set[str] = set()
        self.recursive: list[str] = []

    def __getitem__(self, key: str) -> Any:
        if not dict.__contains__(self, key):
            return self.parent[key]
        if key in self.unevaluated:
            self._evaluate(key)
        value = dict.__getitem__(self, key)
        self._log("use", key, value)
        return value

    def __setitem__(self, key: str, value: Any) -> None:
        self._setitem(key, value, unevaluated=True)

    def __delitem__(self, key: str) -> None:
        table: dict[str, Any] = self
        while isinstance(table, Table):
            dict.pop(table, key, None)
            table.unevaluated.discard(key)
            table = table.parent
        if key in self.root:
            color.warning(f"Cannot remove global symbol: {key}")

    def __contains__(self, key: object) -> bool:
        return dict.__contains__(self, key) or key in self.parent

    def __str__(self) -> str:
        return f"{dict.__repr__(self)}\n  parent: {self.parent}"

    def top(self) -> Table:
        """Return the outermost table that does not contain the names that xacro provides."""
        table = self
        while table.parent is not table.root and isinstance(table.parent, Table):
            table = table.parent
        return table

    @staticmethod
    def _eval_literal(value: Any) -> Any:
        return parse_literal(value)

    def _setitem(self, key: str, value: Any, unevaluated: bool) -> None:
        if key in self.root:
            color.warning(f"redefining global symbol: {key}")
            print_location()
        value = parse_literal(value)
        dict.__setitem__(self, key, value)
        self.unevaluated.discard(key)
        if unevaluated and isinstance(value, str):
            self.unevaluated.add(key)
        self._log("set", key, value)

    def _evaluate(self, key: str) -> None:
        if key in self.recursive:
            cycle = " -> ".join([*self.recursive, key])
            raise XacroException(
                f"the property '{key}' depends on itself: {cycle}; "
                'write lazy_eval="false" in the definition of one of them'
            )
        self.recursive.append(key)
        try:
            value = parse_literal(eval_text(dict.__getitem__(self, key), self))
        finally:
            self.recursive.remove(key)
        dict.__setitem__(self, key, value)
        self.unevaluated.discard(key)

    def _log(self, action: str, key: str, value: Any) -> None:
        level = STATE.verbosity
        if level > _FULL_VERBOSITY or (level > _DOCUMENT_VERBOSITY and self.parent is self.root):
            file = STATE.filestack[-1] if STATE.filestack else None
            print(f"{' ' * self.depth}{action} {key}: {value} ({file})", file=sys.stderr)


class NameSpace(Table):
    """The symbol table of an include with a namespace.

    Its names are also available as attributes.
    """

    def __getattr__(self, item: str) -> Any:
        if item.startswith("__"):
            raise AttributeError(item)
        try:
            return self[item]
        except KeyError:
            raise NameError(phrase("name '{item}' is not defined", item=item)) from None
