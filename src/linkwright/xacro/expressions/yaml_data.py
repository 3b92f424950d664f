"""YAML files as values of expressions.

PyYAML's safe loader reads the files, so the language is YAML 1.1: ``yes`` is True, ``012`` is ten, ``1e3`` is a
string. Six tags convert an expression with a unit to meters or radians. PyYAML is imported when the first file is
read.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from linkwright.diagnostics import phrase
from linkwright.loading.lean_typing import Any
from linkwright.xacro.cache import BoundedCache

UNIT_FACTORS = {
    "!radians": 1.0,
    "!degrees": math.pi / 180.0,
    "!meters": 1.0,
    "!millimeters": 0.001,
    "!foot": 0.3048,
    "!inches": 0.0254,
}
"""The size of each unit in meters or radians, by YAML tag."""


class YamlMapping(dict[Any, Any]):
    """A mapping inside YAML data without access by a dot, since ros/xacro uses a plain dict."""

    __slots__ = ()


class YamlDict(dict[Any, Any]):
    """A mapping whose items are also accessible with a dot.

    As in ros/xacro, reading a nested mapping or list returns a copy with this access, so a loop that empties
    ``data.joints`` leaves ``data`` unchanged. Methods such as ``get`` or ``values`` return the original items.
    """

    __slots__ = ()

    def __getitem__(self, key: Any) -> Any:
        try:
            value = dict.__getitem__(self, key)
        except KeyError:
            raise AttributeError(phrase("the YAML mapping has no key '{key}'", key=key)) from None
        return value if value.__class__ in _SCALAR_TYPES else wrap(value)


class YamlList(list[Any]):
    """A sequence read from YAML, whose items behave like the items of a `YamlDict`."""

    __slots__ = ()

    def __getitem__(self, index: Any) -> Any:
        return wrap(list.__getitem__(self, index))

    def __iter__(self) -> Iterator[Any]:
        return map(wrap, super().__iter__())


_SCALAR_TYPES: frozenset[type] = frozenset({str, int, float, bool})
"""The types of most values without items."""

COPIED_TYPES: frozenset[type] = frozenset({YamlDict, YamlList})
"""The types whose values are copied at every access."""


def wrap(value: Any) -> Any:
    """Return a value of YAML data in the form that expressions use."""
    if isinstance(value, dict):
        return YamlDict(value)
    return YamlList(value) if isinstance(value, list) else value


class YamlError(Exception):
    """Raised for a file that is not valid YAML.

    The line and the column start at 1, and are 0 if they are not known.
    """

    def __init__(self, message: str, line: int = 0, column: int = 0) -> None:
        super().__init__(message)
        self.message = message
        self.line = line
        self.column = column


def load(text: str, evaluate: Callable[[str], Any]) -> Any:
    """Return the value of a YAML text.

    Args:
        text: the YAML text.
        evaluate: the function that evaluates the expression after a unit tag.

    Raises:
        YamlError: if the text is not YAML, or has an unknown tag.
    """
    if "!" in text:
        return copy_with_dot_access(_load(text, evaluate))
    try:
        value = cache.values[text]
    except KeyError:
        value = _load(text, None)
        cache.store(text, value)
    return copy_with_dot_access(value)


cache: BoundedCache[str, Any] = BoundedCache(200, lambda *_: 1)
"""The values of YAML texts without tags, by text. A caller receives a copy."""


def _load(text: str, evaluate: Callable[[str], Any] | None) -> Any:
    import yaml

    from linkwright.xacro.expressions.yaml_conversion import NodeLoader, construct

    loader_class = NodeLoader if evaluate is None else _unit_loader(NodeLoader, evaluate)
    loader = loader_class(text)
    try:
        node = loader.get_single_node()
        return None if node is None else construct(loader, node)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        problem = error.problem or error.context or "not valid YAML"
        raise YamlError(problem, mark.line + 1 if mark else 0, mark.column + 1 if mark else 0) from None
    except (yaml.YAMLError, ValueError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
        raise YamlError(str(error).partition("\n")[0] or "not valid YAML") from None
    finally:
        loader.dispose()


def copy_with_dot_access(value: Any) -> Any:
    """Return a deep copy of a value whose mappings are accessible with a dot."""
    return wrap(_deep_copy(value, {}))


def _deep_copy(value: Any, copies: dict[int, Any]) -> Any:
    if not isinstance(value, (dict, list)):
        return value
    existing_copy = copies.get(id(value))
    if existing_copy is not None:
        return existing_copy
    if isinstance(value, dict):
        mapping = copies[id(value)] = YamlMapping(value)
        for key, item in value.items():
            if item.__class__ not in _SCALAR_TYPES and isinstance(item, (dict, list)):
                mapping[key] = _deep_copy(item, copies)
        return mapping
    sequence = copies[id(value)] = value.copy()
    for index, item in enumerate(value):
        if item.__class__ not in _SCALAR_TYPES and isinstance(item, (dict, list)):
            sequence[index] = _deep_copy(item, copies)
    return sequence


def _unit_loader(base: type, evaluate: Callable[[str], Any]) -> Any:
    """Return a new loader class that evaluates unit tags.

    Each file needs its own class, because the expressions are evaluated in the expansion of the file.
    """

    class UnitLoader(base):  # type: ignore[misc]
        """The safe loader with support for unit tags."""

    def with_unit(loader: Any, tag: str, node: Any) -> float:
        return float(evaluate(loader.construct_scalar(node))) * UNIT_FACTORS[f"!{tag}"]

    UnitLoader.add_multi_constructor("!", _reject_other_tags(with_unit))
    return UnitLoader


def _reject_other_tags(construct: Callable[[Any, str, Any], float]) -> Callable[[Any, str, Any], float]:
    def constructor(loader: Any, tag: str, node: Any) -> float:
        if f"!{tag}" not in UNIT_FACTORS:
            from yaml.constructor import ConstructorError

            supported_tags = ", ".join(UNIT_FACTORS)
            raise ConstructorError(
                None,
                None,
                phrase(
                    "the YAML tag '!{tag}' is not supported; the supported tags are {known}",
                    tag=tag,
                    known=supported_tags,
                ),
                node.start_mark,
            )
        return construct(loader, tag, node)

    return constructor
