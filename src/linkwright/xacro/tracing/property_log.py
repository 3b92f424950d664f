"""The log of property definitions and uses that ``xacro --verbosity 3`` and ``4`` print."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.diagnostics import LinkwrightError
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expander import Expander, Site
from linkwright.xacro.expressions.scope import Lazy, Scope
from linkwright.xacro.session import Inputs, Session
from linkwright.xacro.tags.directives import DIRECTIVES
from linkwright.xacro.tracing.references import format_value
from linkwright.xacro.tracing.traced import PROBE, TracedSession, expand_traced, recorded_probe
from linkwright.xmltree import Element


def log_properties(inputs: Inputs, write_line: Callable[[str], None], *, everywhere: bool) -> None:
    """Expand a file and log its properties.

    An error ends the log but is not raised.

    Args:
        inputs: the inputs of the expansion.
        write_line: the function that receives each line of the log.
        everywhere: whether to also log the properties and parameters of macros and namespaces.
    """
    log = _Log(write_line, everywhere=everywhere)
    try:
        expand_traced(inputs, TracedSession(inputs), {**DIRECTIVES, PROBE: log.probe})
    except LinkwrightError:
        write_line("the expansion ends here")


class _Log:
    """A logger that replaces a scope's names with a `_Table` at the first probe in it."""

    def __init__(self, write_line: Callable[[str], None], *, everywhere: bool) -> None:
        self._write_line = write_line
        self._everywhere = everywhere

    def probe(self, expander: Expander, site: Site) -> None:
        """Start logging the scope of a probe, unless it is logged already."""
        scope, target = site.scope, site.node.origin
        depth = _count_enclosing_scopes(scope)
        if scope.values.__class__ is dict and (depth == 1 or self._everywhere):
            session = expander.session
            existing_values, scope.values = scope.values, _Table(session, self._write_line, depth - 1)
            if session.frame is not None:
                session.current_node = session.frame.site  # the location in the log of parameters that already exist
            for name, value in existing_values.items():
                scope.values[name] = value
        if not (isinstance(target, Element) and target.tag == "xacro:macro"):
            site.parent.children.append(recorded_probe(None))


class _Table(dict[str, Any]):
    """The names of a scope, with a log of each access."""

    __slots__ = ("_indent", "_session", "_unevaluated", "_write_line")

    def __init__(self, session: Session, write_line: Callable[[str], None], depth: int) -> None:
        super().__init__()
        self._session = session
        self._write_line = write_line
        self._indent = " " * depth
        self._unevaluated: set[str] = set()

    def __setitem__(self, name: str, value: Any) -> None:
        super().__setitem__(name, value)
        if name in self._unevaluated:  # a lazy property that is evaluated at its first use, not a new definition
            self._unevaluated.discard(name)
            self._log("use", name, value)
        else:
            self._log("set", name, value)

    def __getitem__(self, name: str) -> Any:
        value = super().__getitem__(name)
        if isinstance(value, Lazy):
            self._unevaluated.add(name)
        else:
            self._log("use", name, value)
        return value

    def get(self, name: str, default: Any = None) -> Any:
        """Return the value of a name, or `default` if there is none, and log the use."""
        return self[name] if name in self else default  # noqa: SIM401 - this is the implementation of `get`

    def _log(self, action: str, name: str, value: Any) -> None:
        if isinstance(value, Scope):
            return
        if isinstance(value, Element):
            text = f"<{value.tag}>"
        else:
            text = value.text if isinstance(value, Lazy) else format_value(value)
        node = self._session.current_node
        span = node.span() if isinstance(node, Element) else None
        if span is None and node is not None and node.source is not None:
            span = node.source.span(node.offset)
        self._write_line(f"{self._indent}{action} {name}: {text} ({span or self._session.file})")


def _count_enclosing_scopes(scope: Scope) -> int:
    """Return the number of scopes that enclose a scope."""
    depth = 0
    while scope.parent is not None:
        scope, depth = scope.parent, depth + 1
    return depth
