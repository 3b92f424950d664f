"""The lookup of names in expressions, and the conversion of texts to values.

Scopes form a chain. A macro call opens a scope whose parent is the caller's scope (dynamic scoping, as in ros/xacro).
An include with a namespace opens a `Namespace`. The outermost scope contains the names that the language provides.

Strings that look like numbers or booleans are converted to such values, and conditions accept some strings as true.
Both rules come from ros/xacro, and real robots rely on them: ``007`` is 7 and ``true`` is True, but ``TRUE``,
``0x10`` and ``1_000`` are strings.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from linkwright.diagnostics import Phrase, Span, phrase
from linkwright.loading.lean_typing import Any, Protocol
from linkwright.xacro.faults import Fault
from linkwright.xacro.limits import Budget, Limits
from linkwright.xmltree import Element, Text

_NEVER_A_LITERAL = frozenset('ABCDEGHJKLMOPQRSUVWXYZabcdeghjklmopqrsuvwxyz$/<>(["')
"""The characters with which neither a number nor a boolean begins."""
_BOOLEANS = {"true": True, "True": True, "false": False, "False": False}


def parse_literal(value: Any) -> Any:
    """Return the number or boolean that a string represents, or else the value itself.

    Single quotes around a string are removed, and prevent its conversion.
    """
    if not isinstance(value, str) or not value:
        return value
    if value[0] == "'" and value[-1] == "'" and len(value) >= 2:
        return value[1:-1]
    if "_" in value or value[0] in _NEVER_A_LITERAL:
        return value
    return parse_number_or_boolean(value)


@lru_cache(maxsize=4096)
def parse_number_or_boolean(text: str) -> Any:
    """Return the number or boolean that a text represents, or else the text."""
    if "." not in text:
        try:
            return int(text)
        except ValueError:
            pass
    try:
        return float(text)
    except ValueError:
        return _BOOLEANS.get(text, text)


def evaluate_truth(value: Any) -> bool:
    """Return the truth value of a condition.

    A string must be ``true``, ``True``, ``false``, ``False`` or an integer. Other values have Python's truth value.

    Raises:
        ValueError: if the value is any other string.
    """
    if not isinstance(value, str):
        return bool(value)
    boolean = _BOOLEANS.get(value)
    return bool(int(value)) if boolean is None else boolean


class Context(Protocol):
    """The interface that the evaluation of expressions needs from a `Session`.

    Attributes:
        arguments: the value of every argument passed or declared so far, by name.
        limits: the limits of the expansion.
        budget: the remaining budget.
        file: the file being processed.
        current_node: the element or text being processed.
        current_attribute: the attribute of `current_node` that is being evaluated, or None.
        property_stack: the names of the nested properties being evaluated, outermost first.
    """

    arguments: dict[str, str]
    limits: Limits
    budget: Budget
    file: str
    current_node: Element | Text | None
    current_attribute: str | None
    property_stack: list[str]

    @property
    def working_directory(self) -> str:
        """The working directory: the value of ``$(cwd)``."""
        ...

    def evaluate(self, text: str, scope: Scope) -> Any:
        """Return the value of a text in a scope.

        Raises:
            Fault: if the evaluation fails.
        """
        ...

    def warn(self, code: str, message: Phrase, span: Span | None = None, hint: Phrase | None = None) -> object:
        """Record a finding that does not stop the expansion.

        The default of `span` is the location of the text being evaluated.
        """
        ...

    def argument(self, name: str) -> str:
        """Return the value of an argument.

        Raises:
            Fault: if the argument is neither declared nor passed.
        """
        ...

    def package(self, name: str) -> str:
        """Return the share folder of a package.

        Raises:
            Fault: if the package is not found.
        """
        ...

    def undefined_name_fault(self, name: str, environment: Environment, start: int, end: int) -> Fault:
        """Return the fault for a name that no scope defines."""
        ...

    def attribute_hint(self, owner: Any, name: str) -> Phrase | None:
        """Return a hint with a similar name for an attribute that a value does not have, or None."""
        ...


class Lazy:
    """The text of a property that is not yet evaluated, and the location of the text."""

    __slots__ = ("attribute", "element", "resolving", "text")

    def __init__(self, text: str, element: Element | None, attribute: str) -> None:
        self.text = text
        self.element = element
        self.attribute = attribute
        self.resolving = False


class Scope:
    """A table of names, with its parent scope."""

    __slots__ = ("parent", "session", "values")

    def __init__(self, parent: Scope | None, session: Context, values: dict[str, Any] | None = None) -> None:
        self.parent = parent
        self.session = session
        self.values: dict[str, Any] = {} if values is None else values

    def lookup(self, name: str) -> Any:
        """Return the value of a name.

        A lazy property is evaluated at its first lookup.

        Raises:
            KeyError: if no scope of the chain defines the name.
            Fault: if the evaluation fails.
        """
        scope: Scope | None = self
        while scope is not None:
            values = scope.values
            if name in values:
                value = values[name]
                return scope._resolve(name, value) if value.__class__ is Lazy else value
            scope = scope.parent
        raise KeyError(name)

    def __contains__(self, name: str) -> bool:
        scope: Scope | None = self
        while scope is not None:
            if name in scope.values:
                return True
            scope = scope.parent
        return False

    def define(
        self, name: str, value: Any, *, lazy: bool = False, element: Element | None = None, attribute: str = "value"
    ) -> None:
        """Define a name in this scope, converting its value by the literal rule (see `parse_literal`).

        Args:
            name: the name, without a prefix.
            value: the value; a string is converted by the literal rule.
            lazy: whether a string is evaluated only at the first lookup of the name.
            element: the element that contains the text, for messages.
            attribute: the attribute of the element that contains the text.
        """
        literal_value = parse_literal(value)
        if lazy and isinstance(literal_value, str):
            if "$" in literal_value:
                literal_value = Lazy(literal_value, element, attribute)
            elif literal_value is not value:  # the string was quoted
                literal_value = parse_literal(literal_value)
        self.values[name] = literal_value

    def assign(self, name: str, value: Any) -> None:
        """Define a property in this scope, for ``name := value`` in an expression."""
        self.define(name, value, lazy=True)

    def bind(self, name: str, value: Any) -> None:
        """Assign a value to a name in this scope without converting the value."""
        self.values[name] = value

    def inner(self) -> Local:
        """Return the environment of a lambda or comprehension that is evaluated in this scope."""
        return Local(self, {})

    def remove(self, name: str) -> None:
        """Remove a name from every scope of the chain except the outermost scope."""
        scope = self
        while scope.parent is not None:
            scope.values.pop(name, None)
            scope = scope.parent

    def document_scope(self) -> Scope:
        """Return the scope of the document, which is directly inside the outermost scope."""
        scope = self
        while scope.parent is not None and scope.parent.parent is not None:
            scope = scope.parent
        return scope

    def names(self) -> Iterator[str]:
        """Yield all names that are visible in this scope, except blocks, for suggestions."""
        scope: Scope | None = self
        while scope is not None:
            yield from (name for name in scope.values if not name.startswith("*"))
            scope = scope.parent

    def blocks(self) -> Iterator[str]:
        """Yield the names of all blocks that are visible in this scope, with their asterisks."""
        scope: Scope | None = self
        while scope is not None:
            yield from (name for name in scope.values if name.startswith("*"))
            scope = scope.parent

    def _resolve(self, name: str, lazy: Lazy) -> Any:
        property_stack = self.session.property_stack
        if lazy.resolving:
            cycle = " -> ".join([*property_stack[property_stack.index(name) :], name])
            hint = phrase('write lazy_eval="false" in the definition of one of them')
            raise Fault(
                "XAC203",
                phrase("the property '{name}' depends on itself: {cycle}", name=name, cycle=cycle),
                hint=hint,
            )
        if len(property_stack) >= self.session.limits.depth:
            raise Fault(
                "XAC601", phrase("more than {count} properties depend on one another", count=len(property_stack))
            )
        session = self.session
        outer_location = session.current_node, session.current_attribute
        if lazy.element is not None:
            session.current_node, session.current_attribute = lazy.element, lazy.attribute
        lazy.resolving = True
        property_stack.append(name)
        try:
            value = parse_literal(self.session.evaluate(lazy.text, self))
        except Fault as fault:
            if lazy.element is not None:
                fault.locate_in_attribute(lazy.element, lazy.attribute)
            fault.next_note = phrase("the property '{name}' is used here", name=name)
            raise
        finally:
            lazy.resolving = False
            session.current_node, session.current_attribute = outer_location
            property_stack.pop()
        self.values[name] = value
        return value


class Namespace(Scope):
    """The scope of an include with a namespace.

    Expressions access its properties with a dot.
    """

    __slots__ = ()


class Local:
    """The environment of a lambda or comprehension: variables and the enclosing environment."""

    __slots__ = ("_enclosing", "_values", "session")

    def __init__(self, enclosing: Environment, values: dict[str, Any]) -> None:
        self._enclosing = enclosing
        self._values = values
        self.session: Context = enclosing.session

    def lookup(self, name: str) -> Any:
        """Return the value of a name in this or an enclosing environment; see `Scope.lookup`."""
        if name in self._values:
            return self._values[name]
        return self._enclosing.lookup(name)

    def bind(self, name: str, value: Any) -> None:
        """Assign a value to a variable."""
        self._values[name] = value

    def assign(self, name: str, value: Any) -> None:
        """Define a property in the enclosing scope, for ``name := value``."""
        self._enclosing.assign(name, value)

    def inner(self) -> Local:
        """Return the environment of a lambda or comprehension inside this environment."""
        return Local(self, {})

    def blocks(self) -> Iterator[str]:
        """Yield the names of all blocks that are visible in this environment; see `Scope.blocks`."""
        return self._enclosing.blocks()

    def names(self) -> Iterator[str]:
        """Yield all names that are visible in this environment."""
        yield from self._values
        yield from self._enclosing.names()


Environment = Scope | Local
