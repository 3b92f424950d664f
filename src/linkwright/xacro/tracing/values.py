"""The values of expressions, and of the texts that contain them, in each macro call."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from linkwright.diagnostics import LinkwrightError
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expander import Expander
from linkwright.xacro.expressions.scope import Scope
from linkwright.xacro.expressions.template import TokenKind, tokenize
from linkwright.xacro.faults import Fault, Frame
from linkwright.xacro.limits import recursion_limit_for
from linkwright.xacro.session import Inputs, Session, read_main_document
from linkwright.xacro.tags.directives import DIRECTIVES
from linkwright.xacro.tags.macro_calls import call_macro
from linkwright.xacro.tracing.references import Reference, format_value, references
from linkwright.xmltree import Element
from linkwright.xmltree.positions import attribute_value_range

_MAX_EVALUATIONS = 100
"""The number of evaluations that are recorded for each expression."""


class Evaluation(NamedTuple):
    """One evaluation of an expression.

    Attributes:
        value: the value in Python notation; a string has quotes.
        frame: the innermost macro call or include that contains the expression, or None for the main file.
        names: the names in the expression, each with its value in Python notation.
    """

    value: str
    frame: Frame | None
    names: tuple[tuple[str, str], ...]


@dataclass(slots=True)
class EvaluatedExpression:
    """An expression, a substitution, or a text that contains such parts, with its values.

    Attributes:
        file: the name of the file.
        start: the character offset in the text of the file.
        end: the offset after the last character.
        evaluations: the evaluations, in their order.
    """

    file: str
    start: int
    end: int
    evaluations: list[Evaluation]

    @property
    def values(self) -> tuple[str, ...]:
        """The different values, in the order of their first evaluations."""
        return tuple(dict.fromkeys(evaluation.value for evaluation in self.evaluations))


def evaluate_expressions(inputs: Inputs) -> list[EvaluatedExpression]:
    """Expand a description, and return the expressions that were evaluated.

    If the expansion fails, the result contains the expressions evaluated before the error. Expressions that change a
    value, such as ``${items.pop(0)}``, are left out, because the recorder evaluates each expression a second time.

    Args:
        inputs: the inputs of the expansion.
    """
    session = _RecordingSession(inputs)
    try:
        document = read_main_document(session, inputs.text)
        with recursion_limit_for(inputs.limits):
            Expander(session, DIRECTIVES, call_macro).walk(document)
    except LinkwrightError:
        pass
    return [*session.expressions.values()]


class _RecordingSession(Session):
    """A session that records the value of each evaluated expression."""

    def __init__(self, inputs: Inputs) -> None:
        super().__init__(inputs.name, inputs.arguments, inputs.packages, inputs.limits, inputs.root_dir, inputs.overlay)
        self.expressions: dict[tuple[str, int, int], EvaluatedExpression] = {}

    def evaluate(self, text: str, scope: Scope) -> Any:
        value = super().evaluate(text, scope)
        self._record(text, scope)
        return value

    def evaluate_text(self, text: str, scope: Scope) -> str:
        value = super().evaluate_text(text, scope)
        self._record(text, scope)
        return value

    def _record(self, text: str, scope: Scope) -> None:
        node = self.current_node
        if "$" not in text or node is None or node.source is None or self.may_change_values(text):
            return
        if self.current_attribute == "params" and isinstance(node, Element) and text == node.attributes.get("params"):
            return  # a list of parameters; the value of each default is recorded when a call needs it
        start = self._find_start(text)
        if start is None:
            return
        name = node.source.name
        for part_start, part_end in _find_ranges(text):
            key = (name, start + part_start, start + part_end)
            expression = self.expressions.get(key)
            if expression is None:
                expression = self.expressions[key] = EvaluatedExpression(*key, [])
            if len(expression.evaluations) < _MAX_EVALUATIONS:
                part = text[part_start:part_end]
                names = tuple(self._list_names(part, scope))
                expression.evaluations.append(Evaluation(self._format_value(part, scope), self.frame, names))

    def _find_start(self, text: str) -> int | None:
        """Return the offset in the file of a text under evaluation, or None if it is not found."""
        node = self.current_node
        assert node is not None
        assert node.source is not None
        source = node.source.text
        begin, end = node.offset, node.offset
        if isinstance(node, Element):
            value_range = attribute_value_range(source, node.offset, self.current_attribute or "")
            if value_range is None:
                return None
            begin, end = value_range
        else:
            end = begin + len(node.data)
        offset = source.find(text, begin, end)
        return offset if offset >= 0 and source.find(text, offset + 1, end) < 0 else None

    def _list_names(self, part: str, scope: Scope) -> Iterator[tuple[str, str]]:
        for reference in _find_references(part):
            if reference.command is None and part[2:-1].strip() != reference.path:
                value = self._format_value(f"${{{reference.path}}}", scope)
                if value:
                    yield reference.path, value

    def _format_value(self, text: str, scope: Scope) -> str:
        try:
            value = super().evaluate(text, scope)
        except (Fault, LinkwrightError, KeyError):
            return ""
        return "" if callable(value) or isinstance(value, Scope) else format_value(value)


@lru_cache(maxsize=4096)
def _find_references(text: str) -> tuple[Reference, ...]:
    return tuple(references(text))


@lru_cache(maxsize=4096)
def _find_ranges(text: str) -> tuple[tuple[int, int], ...]:
    """Return the start and end of a text, and of each expression and substitution in it."""
    parts = ((token.start, token.end) for token in tokenize(text) if token.kind is not TokenKind.TEXT)
    return tuple(dict.fromkeys([(0, len(text)), *parts]))
