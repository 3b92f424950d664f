"""Evaluate attribute values and expressions, as in the module ``xacro``."""

from __future__ import annotations

import enum
import keyword
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.standins.xacro_api.errors import XacroException, translate_error
from linkwright.standins.xacro_api.stacks import STATE, abs_filename_spec
from linkwright.xacro.expressions import yaml_data
from linkwright.xacro.expressions.builtin_names import tokenize
from linkwright.xacro.expressions.scope import Namespace, Scope, evaluate_truth
from linkwright.xacro.expressions.template import substitute
from linkwright.xacro.faults import Fault
from linkwright.xacro.session import Inputs, Session

_Result = TypeVar("_Result")


def eval_text(text: str, symbols: Mapping[str, Any] | None) -> Any:
    """Evaluate a string with ``${...}`` and ``$(...)``.

    If the string is a single expression, the result has the type of the expression's value.

    Args:
        text: the string to evaluate.
        symbols: the values of names in expressions, in addition to the names that xacro provides.

    Raises:
        XacroException: the string cannot be evaluated.
    """
    session = _create_session()
    return _call_with_xacro_errors(lambda: session.evaluate(text, _create_scope(session, symbols)))


def safe_eval(expr: str, globals: Mapping[str, Any] | None, locals: Mapping[str, Any] | None = None) -> Any:
    """Evaluate an expression with the names of descriptions. See `eval_text`.

    Raises:
        XacroException: the expression cannot be evaluated, or is not allowed.
    """
    from linkwright.xacro.expressions.expression import compile_expression

    session = _create_session()
    scope = _create_scope(session, globals)
    if locals is not None:
        scope = Scope(scope, session, _SymbolView(locals, session))
    return _call_with_xacro_errors(lambda: compile_expression(expr).evaluate(scope))


def eval_extension(s: str) -> str:
    """Evaluate a substitution such as ``$(find package)``.

    Raises:
        XacroException: the substitution cannot be evaluated.
    """
    session = _create_session()
    return _call_with_xacro_errors(lambda: substitute(s.removeprefix("$(").removesuffix(")"), session))


def load_yaml(filename: str) -> Any:
    """Load a YAML file.

    The keys of its mappings are also available as attributes.

    Raises:
        XacroException: there is no such file, or the file is not YAML.
    """
    session = _create_session()
    STATE.all_includes.append(abs_filename_spec(filename))
    return YamlListWrapper.wrap(_call_with_xacro_errors(lambda: session.load_yaml(filename)))


def dotify(mapping: Any = (), **items: Any) -> YamlDictWrapper:
    """Return a copy of a mapping that also provides its keys, at all levels, as attributes."""
    result: YamlDictWrapper = YamlListWrapper.wrap(dict(mapping, **items))
    return result


def get_boolean_value(value: Any, condition: object = None) -> bool:
    """Convert the value of a condition to a boolean.

    Args:
        value: the value of the condition.
        condition: the source text of the condition, for the error message.

    Raises:
        XacroException: the value is a string that is neither true, false nor an integer.
    """
    try:
        return evaluate_truth(value)
    except ValueError:
        subject = f"the condition '{condition}'" if condition is not None else "the condition"
        raise XacroException(f"{subject} gives '{value}', which is neither true nor false") from None


def is_valid_name(name: str) -> bool:
    """Return whether a string is a valid name for a property or macro.

    A valid name is a Python identifier that is not a keyword.
    """
    return name.isidentifier() and not keyword.iskeyword(name)


def create_global_symbols() -> dict[str, Any]:
    """Return the names that xacro provides to expressions, with their values."""
    return dict(_create_session().globals.values)


class ConstructUnits(enum.Enum):
    """The YAML tags for values with units, each with the size of the unit in meters or radians."""

    radians = ("!radians", yaml_data.UNIT_FACTORS["!radians"])
    degrees = ("!degrees", yaml_data.UNIT_FACTORS["!degrees"])
    meters = ("!meters", yaml_data.UNIT_FACTORS["!meters"])
    millimeters = ("!millimeters", yaml_data.UNIT_FACTORS["!millimeters"])
    foot = ("!foot", yaml_data.UNIT_FACTORS["!foot"])
    inches = ("!inches", yaml_data.UNIT_FACTORS["!inches"])


class YamlDictWrapper(dict[Any, Any]):
    """A mapping that also provides its keys as attributes."""

    def __getattr__(self, item: str) -> Any:
        try:
            return self[item]
        except KeyError:
            raise AttributeError(phrase("the YAML mapping has no key '{key}'", key=item)) from None


class YamlListWrapper(list[Any]):
    """A sequence from a YAML file. See `wrap`."""

    @staticmethod
    def wrap(item: Any) -> Any:
        """Return a value with all mappings as `YamlDictWrapper` and all lists as `YamlListWrapper`."""
        if isinstance(item, dict):
            return YamlDictWrapper({key: YamlListWrapper.wrap(value) for key, value in item.items()})
        if isinstance(item, list):
            return YamlListWrapper(map(YamlListWrapper.wrap, item))
        return item


class _SymbolView(dict[str, Any]):
    """A dictionary view of a symbol table.

    Values are evaluated on access if necessary.
    """

    __slots__ = ("_session", "_table")

    def __init__(self, table: Mapping[str, Any], session: Session) -> None:
        super().__init__()
        self._table = table
        self._session = session

    def __contains__(self, name: object) -> bool:
        return name in self._table

    def __getitem__(self, name: str) -> Any:
        value = self._table[name]
        if isinstance(value, (YamlDictWrapper, YamlListWrapper)):
            return yaml_data.copy_with_dot_access(value)
        if isinstance(value, dict) and hasattr(value, "unevaluated"):  # the value is the symbol table of a namespace
            return Namespace(None, self._session, _SymbolView(value, self._session))
        return value

    def __iter__(self) -> Any:
        return iter(self._table)

    def get(self, name: str, default: Any = None) -> Any:
        return self[name] if name in self._table else default


def _create_scope(session: Session, symbols: Mapping[str, Any] | None) -> Scope:
    return Scope(session.globals, session, _SymbolView({} if symbols is None else symbols, session))


def _create_session() -> Session:
    file = abs_filename_spec("text")
    return Inputs(file, STATE.arguments, root_dir=_find_root_folder()).create_session()


def _find_root_folder() -> str:
    return "" if str(STATE.root_dir) == "." else str(STATE.root_dir)


def _call_with_xacro_errors(evaluate: Callable[[], _Result]) -> _Result:
    try:
        return evaluate()
    except Fault as fault:
        raise XacroException(fault.message) from None
    except LinkwrightError as error:
        raise translate_error(error, None) from None
