"""The sandbox of expressions: the operations that expressions may apply to values.

Expressions come from untrusted files. Therefore, the sandbox lists the allowed operations and refuses all others. An
attribute is accessible only if it is listed for the type of the value. A type can be called only if it is listed. No
value may exceed the limits below.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping, Sequence

from linkwright.diagnostics import phrase
from linkwright.loading.lean_typing import Any
from linkwright.xacro.expressions import bounded
from linkwright.xacro.expressions.bounded import RefusalError
from linkwright.xacro.expressions.scope import Namespace
from linkwright.xacro.expressions.yaml_data import YamlDict, YamlList, YamlMapping

MAX_LENGTH = 1_000_000
"""The maximum number of characters in a string or of items in a list."""
MAX_BITS = 20_000
"""The maximum number of bits in an integer."""
MAX_DIGITS = 1_000
"""The maximum width or precision of a formatted number."""
_MAX_FIELDS = 1_000
"""The maximum number of fields of a string that is formatted."""


class Module:
    """A named group of functions and constants, such as ``math``, with access by a dot."""

    __slots__ = ("name", "values")

    def __init__(self, name: str, values: dict[str, Any]) -> None:
        self.name = name
        self.values = values

    def __repr__(self) -> str:
        return f"<module {self.name}>"


_SEQUENCE_METHODS = {"count", "index"}
_SET_METHODS = {
    *("copy", "difference", "intersection", "isdisjoint", "issubset", "issuperset", "symmetric_difference", "union"),
}
_STRING_METHODS = {
    *("capitalize", "casefold", "count", "endswith", "find", "index", "isalnum", "isalpha", "isascii"),
    *("isdecimal", "isdigit", "isidentifier", "islower", "isnumeric", "isprintable", "isspace", "istitle", "isupper"),
    *("lower", "partition", "removeprefix", "removesuffix", "split", "splitlines", "startswith", "swapcase", "title"),
    "upper",
}
_LIST_METHODS = {*_SEQUENCE_METHODS, "append", "clear", "copy", "insert", "pop", "remove", "reverse", "sort"}
_DICT_METHODS = {"clear", "copy", "get", "items", "keys", "pop", "popitem", "setdefault", "update", "values"}

_ALLOWED_ATTRIBUTES: dict[type, set[str]] = {
    str: _STRING_METHODS,
    bytes: {"hex", *_SEQUENCE_METHODS},
    int: {"as_integer_ratio", "bit_length", "conjugate", "denominator", "imag", "numerator", "real"},
    bool: {"imag", "numerator", "denominator", "real"},
    float: {"as_integer_ratio", "conjugate", "hex", "imag", "is_integer", "real"},
    complex: {"conjugate", "imag", "real"},
    list: _LIST_METHODS,
    YamlList: _LIST_METHODS,
    tuple: _SEQUENCE_METHODS,
    dict: _DICT_METHODS,
    YamlDict: _DICT_METHODS,
    YamlMapping: _DICT_METHODS,
    set: {*_SET_METHODS, "add", "clear", "discard", "pop", "remove", "update"},
    frozenset: _SET_METHODS,
    range: {*_SEQUENCE_METHODS, "start", "step", "stop"},
    slice: {"start", "step", "stop"},
}

_DATE_ATTRIBUTES = {"day", "hour", "isoformat", "microsecond", "minute", "month", "second", "weekday", "year"}
"""The accessible attributes of dates, which YAML files may contain."""

CALLABLE_TYPES = frozenset(
    {bool, complex, dict, enumerate, filter, float, frozenset, int, list, map, reversed, set, slice, str, tuple, zip}
)
"""The types that expressions may call."""


def attribute(value: Any, name: str) -> Any:
    """Return ``value.name`` if expressions may access it.

    Raises:
        AttributeError: if the value has no such attribute.
        RefusalError: if the attribute exists, but expressions must not access it.
    """
    kind = value.__class__
    if kind is Module:
        if name in value.values:
            return value.values[name]
        raise AttributeError(phrase("'{name}' has no '{key}'", name=value.name, key=name))
    if isinstance(value, Namespace):
        try:
            return value.lookup(name)
        except KeyError:
            raise AttributeError(phrase("the namespace has no property '{name}'", name=name)) from None
    if name in _ALLOWED_ATTRIBUTES.get(kind, ()):
        return getattr(value, name)
    guarded_method = _GROWING_METHODS.get((kind, name))
    if guarded_method is not None:
        return _BoundMethod(guarded_method, value)
    if kind is YamlDict:
        return value[name]
    if kind.__module__ == "datetime" and name in _DATE_ATTRIBUTES:
        return getattr(value, name)
    if kind is type and value in _ALLOWED_ATTRIBUTES:
        if name in _ALLOWED_ATTRIBUTES[value]:
            return getattr(value, name)
        if (value, name) in bounded.METHODS:
            return bounded.METHODS[value, name]
    if name.startswith("_") or hasattr(value, name):
        raise RefusalError(phrase("'.{name}' is not available in expressions", name=name))
    raise AttributeError(phrase("'{kind}' has no attribute '{name}'", kind=kind.__name__, name=name))


def subscript(value: Any, key: Any) -> Any:
    """Return ``value[key]``."""
    if isinstance(value, Namespace):
        return value.lookup(key)
    if value.__class__ is Module:
        if key in value.values:
            return value.values[key]
        raise AttributeError(phrase("'{name}' has no '{key}'", name=value.name, key=key))
    if isinstance(value, type):
        raise TypeError(phrase("'{name}' is a type and has no items", name=value.__name__))
    return value[key]


def contains(container: Any, item: Any) -> bool:
    """Return ``item in container``."""
    return item in (container.values if container.__class__ is Module else container)


def check_call(function: Any) -> None:
    """Raise if a function is a type that expressions must not call.

    Raises:
        RefusalError: if expressions must not create values of this type.
    """
    if isinstance(function, type) and function not in CALLABLE_TYPES:
        raise RefusalError(phrase("'{name}' cannot be called in expressions", name=function.__name__))


def check_size(value: Any) -> Any:
    """Return a value unchanged if it is not too large.

    Raises:
        RefusalError: if a string, list or number exceeds the limits. The size of a list includes the contents of nested
        lists.
    """
    weight(value)
    return value


def weight(value: Any) -> int:
    """Return the number of items or characters in a value, including nested items.

    The weight of an integer is the number of full 64-bit words. Other numbers have the weight 0.

    Raises:
        RefusalError: if a string, list or number exceeds the limits.
    """
    kind = value.__class__
    if kind is float or kind is bool:
        return 0
    if kind is int:
        bits: int = value.bit_length()
        if bits > MAX_BITS:
            raise RefusalError(phrase("the number has more than {max_bits:,} bits", max_bits=MAX_BITS))
        return bits // 64
    if kind is str or kind is bytes:
        _check_length(len(value))
        return len(value)
    if isinstance(value, (list, tuple, dict, set, frozenset)):
        return _collection_weight(value)
    return 0


def join_strings(parts: list[str]) -> str:
    """Return the concatenation of some strings.

    Raises:
        RefusalError: if the result would be too long.
    """
    length = sum(map(len, parts))
    if length > MAX_LENGTH:
        _check_length(length)
    return "".join(parts)


def as_text(value: Any) -> str:
    """Return the text that the expansion writes for a value: ``str(value)``.

    Raises:
        RefusalError: if the text would be too long.
    """
    if value.__class__ is str:
        return value
    return str(check_size(value))


def _check_length(length: int) -> None:
    if length > MAX_LENGTH:
        raise RefusalError(phrase("the value has more than {max_length:,} characters or items", max_length=MAX_LENGTH))


_WEIGHTLESS_TYPES: frozenset[type] = frozenset({int, float, bool})
"""The types of most items that are not texts."""


def _collection_weight(value: Any) -> int:
    total = 0
    pending: list[Any] = [value]
    while pending:
        item = pending.pop()
        if item.__class__ in _WEIGHTLESS_TYPES:
            continue
        if isinstance(item, (str, bytes)):
            total += len(item)
        elif isinstance(item, dict):
            total += len(item)
            pending += item.values()
            pending += item
        elif isinstance(item, (list, tuple, set, frozenset)):
            total += len(item)
            pending += item
        else:
            continue
        if total > MAX_LENGTH:
            _check_length(total)
    return total


# operators whose results can be much larger than their operands


def add(left: Any, right: Any) -> Any:
    """Return ``left + right``, unless the result would be too long."""
    if isinstance(left, (str, list, tuple, bytes)) and isinstance(right, (str, list, tuple, bytes)):
        _check_length(len(left) + len(right))
    return left + right


def multiply(left: Any, right: Any) -> Any:
    """Return ``left * right``, unless the result would be too large."""
    if left.__class__ is float or right.__class__ is float:
        return left * right
    for sequence, count in ((left, right), (right, left)):
        if isinstance(sequence, (str, list, tuple, bytes)) and isinstance(count, int):
            _check_length(len(sequence) * count)
    return check_size(left * right)


def power(base: Any, exponent: Any) -> Any:
    """Return ``base ** exponent``, unless the result would be too large."""
    if (
        isinstance(base, int)
        and isinstance(exponent, int)
        and abs(base) > 1
        and base.bit_length() * exponent > MAX_BITS
    ):
        raise RefusalError(phrase("the number has more than {max_bits:,} bits", max_bits=MAX_BITS))
    return base**exponent


def shift_left(value: Any, bits: Any) -> Any:
    """Return ``value << bits``, unless the result would be too large."""
    if isinstance(value, int) and isinstance(bits, int) and value.bit_length() + bits > MAX_BITS:
        raise RefusalError(phrase("the number has more than {max_bits:,} bits", max_bits=MAX_BITS))
    return value << bits


_FORMAT_FIELD = r"%(?:\([^)]*\))?[-+ #0]*(\*|\d+)?(?:\.(\*|\d+))?"  # compiled on first use, because few files need it


def modulo(left: Any, right: Any) -> Any:
    """Return ``left % right``: a remainder, or a formatted text if `left` is a string."""
    if isinstance(left, (str, bytes)):
        pattern = left if isinstance(left, str) else left.decode("latin-1")
        for digits in (group for groups in re.findall(_FORMAT_FIELD, pattern) for group in groups):
            if digits == "*" or len(digits) > len(str(MAX_DIGITS)) or int(digits or 0) > MAX_DIGITS:
                raise RefusalError(
                    phrase(
                        "the width or precision '{digits}' can exceed the limit of {max_digits:,}",
                        digits=digits,
                        max_digits=MAX_DIGITS,
                    )
                )
        check_size(right)
    return left % right


_CONVERSIONS: dict[int, Callable[[Any], str]] = {ord("s"): str, ord("r"): repr, ord("a"): ascii}
_FORMATTABLE_TYPES: frozenset[type] = frozenset({bool, complex, float, int, str})


def format_field_value(value: Any, conversion: int, specification: str) -> str:
    """Return the text of a field of an f-string, such as ``{value!r:>8}``.

    Args:
        value: the value of the field.
        conversion: the character code of the letter after the exclamation mark, or -1 if there is none.
        specification: the format specification after the colon.

    Raises:
        RefusalError: if the text would be too long.
        TypeError: if values of this type do not support a format specification.
    """
    check_size(value)
    if conversion in _CONVERSIONS:
        value = _CONVERSIONS[conversion](value)
    if not specification:
        return as_text(value)
    for digits in (specification, *re.findall(r"\d+", specification)):
        if len(digits) > MAX_DIGITS or (digits.isdecimal() and int(digits) > MAX_DIGITS):
            raise RefusalError(phrase("the width or precision is larger than {max_digits:,}", max_digits=MAX_DIGITS))
    if value.__class__ not in _FORMATTABLE_TYPES and value.__class__.__module__ != "datetime":
        raise TypeError(phrase("a value of type '{kind}' cannot be formatted with ':'", kind=value.__class__.__name__))
    return format(value, specification)


_FIELD_STEP = r"\.([^.\[]+)|\[([^\]]+)\]"
_FIELD_NAME = rf"(?P<first>[^.\[]*)(?P<steps>(?:{_FIELD_STEP})*)"
"""A field of `str.format`, such as ``0.real`` or ``robot[name]``."""


def _format(text: str, *values: Any, **named_values: Any) -> str:
    """Return ``text.format(...)``, whose fields reach no more than expressions do.

    Raises:
        RefusalError: if a field reaches what expressions must not access, or if the text would be too long.
        LookupError: if a field has no value.
    """
    from string import Formatter

    if text.count("{") > _MAX_FIELDS:
        raise RefusalError(phrase("the format string has more than {count:,} replacement fields", count=_MAX_FIELDS))
    length = len(text)

    class Fields(Formatter):
        def get_field(self, field_name: str, args: Sequence[Any], kwargs: Mapping[str, Any]) -> tuple[Any, str]:
            match = re.fullmatch(_FIELD_NAME, field_name)
            if match is None:
                raise ValueError(phrase("'{name}' does not name a field", name=field_name))
            first = match["first"]
            if first.isdecimal() and int(first) < len(args):
                value = args[int(first)]
            elif first in kwargs:
                value = kwargs[first]
            else:
                raise LookupError(phrase("the call of 'format' has no value for the field '{name}'", name=first))
            for name, key in re.findall(_FIELD_STEP, match["steps"]):
                value = attribute(value, name) if name else subscript(value, int(key) if key.isdecimal() else key)
            return value, first

        def convert_field(self, value: Any, conversion: str | None) -> Any:
            return super().convert_field(check_size(value), conversion)

        def format_field(self, value: Any, format_spec: str) -> str:
            nonlocal length
            field = format_field_value(value, -1, format_spec)
            length += len(field)
            _check_length(length)
            return field

    return Fields().vformat(text, values, named_values)


OPERATORS: dict[str, Callable[[Any, Any], Any]] = {
    "Add": add,
    "Sub": operator.sub,
    "Mult": multiply,
    "Div": operator.truediv,
    "FloorDiv": operator.floordiv,
    "Mod": modulo,
    "Pow": power,
    "LShift": shift_left,
    "RShift": operator.rshift,
    "BitOr": operator.or_,
    "BitXor": operator.xor,
    "BitAnd": operator.and_,
    "MatMult": operator.matmul,
}


# methods whose results can be much larger than their arguments


class _BoundMethod:
    """A bound method whose calls go to a guarded function."""

    __slots__ = ("__self__", "_method")

    def __init__(self, method: Callable[..., Any], value: Any) -> None:
        self._method = method
        self.__self__ = value

    def __call__(self, *arguments: Any, **keywords: Any) -> Any:
        return self._method(self.__self__, *arguments, **keywords)


def _bounded_pad(name: str) -> Callable[..., Any]:
    def pad(text: str, width: int, *fill: str) -> Any:
        _check_length(width)
        return getattr(text, name)(width, *fill)

    return pad


def _expandtabs(text: str, size: int = 8) -> str:
    _check_length(text.count("\t") * size)
    return text.expandtabs(size)


def _join(text: str, items: Any) -> str:
    parts = list(items)
    _check_length(sum(len(part) for part in parts if isinstance(part, str)) + len(text) * len(parts))
    return text.join(parts)


def _replace(text: str, old: str, new: str, count: int = -1) -> str:
    if isinstance(old, str) and isinstance(new, str):
        count_in_text = text.count(old)
        _check_length(
            len(text) + (count_in_text if count < 0 else min(count, count_in_text)) * max(0, len(new) - len(old))
        )
    return text.replace(old, new, count)


def _extend(items: list[Any], new_items: Any) -> None:
    additions = list(new_items)
    _check_length(len(items) + len(additions))
    items.extend(additions)


_GROWING_METHODS: dict[tuple[type, str], Callable[..., Any]] = {
    **{(str, name): _bounded_pad(name) for name in ("center", "ljust", "rjust", "zfill")},
    (str, "expandtabs"): _expandtabs,
    (str, "format"): _format,
    (str, "join"): _join,
    (str, "replace"): _replace,
    (list, "extend"): _extend,
    (YamlList, "extend"): _extend,
    **bounded.METHODS,
}
