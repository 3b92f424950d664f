"""A faster replacement for `dataclasses`, which compiles methods on first use.

The standard library generates the methods of a class as source code, and compiles them when the class is defined. For
this purpose, it also imports `inspect`. A check of a small robot defines sixty classes and creates objects of half of
them. The compilation took a quarter of its time. Here, ``__init__`` is compiled when the first object is created, and
all classes share the remaining methods.

For type checkers, the functions are `dataclasses.dataclass`, `field` and `replace`, with the arguments that are
used here. The functions of `dataclasses` for a class or an object, such as ``fields`` and ``asdict``, also accept
these classes. `NamedTuple` replaces the one in `typing`, and does not compile each annotation.
"""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable, Iterable, Iterator
from operator import attrgetter

from linkwright.loading.lean_typing import TYPE_CHECKING, Any

__all__ = ["NamedTuple", "dataclass", "field", "replace"]

_MISSING: Any = type("Missing", (), {"__repr__": lambda _: "MISSING"})()
_FIELDS, _OPTIONS = "__lean_fields__", "__lean_options__"
_DEFAULT_MEMBERS = ("__dict__", "__weakref__")
_set: Callable[[object, str, object], None] = object.__setattr__
_set_class: Callable[[object, type], None] = vars(object)["__class__"].__set__


class _Field:
    __slots__ = ("compare", "default", "factory", "init", "name", "repr", "type")

    def __init__(self, default: Any, factory: Any, *, init: bool, repr: bool, compare: bool) -> None:  # noqa: A002
        self.name = self.type = ""
        self.default = default
        self.factory = factory
        self.init = init
        self.repr = repr
        self.compare = compare

    @property
    def is_set(self) -> bool:
        """Whether ``__init__`` sets the field."""
        return self.init or self.default is not _MISSING or self.factory is not _MISSING

    @property
    def parameter(self) -> str:
        """The parameter of ``__init__`` for the field, as source code."""
        is_required = self.default is _MISSING and self.factory is _MISSING
        return self.name if is_required else f"{self.name}=default_{self.name}"

    @property
    def value(self) -> str:
        """The expression in ``__init__`` for the value of the field, as source code."""
        if self.factory is _MISSING:
            return self.name if self.init else f"default_{self.name}"
        factory_call = f"factory_{self.name}()"
        return f"({factory_call} if {self.name} is MISSING else {self.name})" if self.init else factory_call


def _field(
    *,
    default: Any = _MISSING,
    default_factory: Any = _MISSING,
    init: bool = True,
    repr: bool = True,  # noqa: A002 - as in `dataclasses`
    compare: bool = True,
) -> Any:
    return _Field(default, default_factory, init=init, repr=repr, compare=compare)


def _dataclass(cls: Any = None, /, *, frozen: bool = False, slots: bool = False, eq: bool = True) -> Any:
    if cls is None:
        return lambda cls: _dataclass(cls, frozen=frozen, slots=slots, eq=eq)
    own_fields = dict(_find_own_fields(cls))
    fields: dict[str, _Field] = {}
    for base in reversed(cls.__mro__[1:]):
        fields |= vars(base).get(_FIELDS, {})
    new_names = [name for name in own_fields if name not in fields]
    fields |= own_fields
    class_members = {
        name: value for name, value in vars(cls).items() if name not in own_fields and name not in _DEFAULT_MEMBERS
    }
    if class_members.get("__hash__", "") is None:
        del class_members["__hash__"]  # Python sets this to None if the class defines `__eq__`
    shared_members = (
        _SHARED | (_create_comparison_methods(fields, frozen=frozen) if eq else {}) | (_FROZEN if frozen else {})
    )
    shared_members |= _PICKLE_METHODS if frozen and slots else {}
    members = {
        **shared_members,
        **class_members,
        "__init__": _init_first,
        "__match_args__": tuple(name for name, entry in fields.items() if entry.init),
        _FIELDS: fields,
        _OPTIONS: (frozen, slots),
    }
    if slots:
        members |= {"__slots__": tuple(new_names), "__qualname__": cls.__qualname__}
        return type(cls)(cls.__name__, cls.__bases__, members)
    for name, entry in own_fields.items():
        if entry.default is not _MISSING:
            members[name] = entry.default
        elif name in vars(cls):
            delattr(cls, name)
    for name, value in members.items():
        if vars(cls).get(name, _MISSING) is not value:
            setattr(cls, name, value)
    return cls


def _find_own_fields(cls: type) -> Iterator[tuple[str, _Field]]:
    for name, annotation in cls.__annotations__.items():
        if annotation.startswith(("ClassVar", "typing.ClassVar")):
            continue
        default = vars(cls).get(name, _MISSING)
        class_field = default if isinstance(default, _Field) else _field(default=default)
        class_field.name, class_field.type = name, annotation
        yield name, class_field


# --- making objects --------------------------------------------------------------------------------------------------


def _init_first(self: Any, *args: Any, **kwargs: Any) -> None:
    """Initialize the first object of a class, and compile the ``__init__`` for later objects."""
    cls: Any = next(base for base in type(self).__mro__ if vars(base).get("__init__") is _init_first)
    cls.__init__ = _compile_init(cls)
    cls.__init__(self, *args, **kwargs)


def _compile_init(cls: Any) -> Callable[..., None]:
    frozen, slots = vars(cls)[_OPTIONS]
    fields: Iterable[_Field] = getattr(cls, _FIELDS).values()
    set_fields = [entry for entry in fields if entry.is_set]
    scope: dict[str, Any] = {"MISSING": _MISSING, "cls": cls, "set_value": _set, "set_class": _set_class}
    for entry in set_fields:
        scope[f"factory_{entry.name}"] = entry.factory
        scope[f"default_{entry.name}"] = entry.default
    slow_statements = [f"set_value(self, {entry.name!r}, {entry.value})" for entry in set_fields]
    fast_statements = [f"self.{entry.name} = {entry.value}" for entry in set_fields]
    if frozen and slots:
        # Setting an attribute of a frozen class requires a function call. Instead, the object temporarily has a class
        # with the same slots that permits assignment, which takes half the time.
        scope["draft"] = type("Draft", cls.__bases__, {"__slots__": cls.__slots__, "__setattr__": _set})
        fast_statements = ["set_class(self, draft)", *fast_statements, "self.__class__ = cls"]
        body = ["if self.__class__ is cls:", *(f"    {line}" for line in fast_statements)]
        body += ["else:", *(f"    {line}" for line in slow_statements)] if slow_statements else []
    else:
        body = slow_statements if frozen else fast_statements
    if hasattr(cls, "__post_init__"):
        body.append("self.__post_init__()")
    parameters = ", ".join(("self", *(entry.parameter for entry in fields if entry.init)))
    source = f"def __init__({parameters}):\n" + "".join(f"    {line}\n" for line in body or ["pass"])
    exec(compile(source, f"<__init__ of {cls.__qualname__}>", "exec"), scope)  # noqa: S102 - names of our own classes
    initializer: Callable[..., None] = scope["__init__"]
    initializer.__qualname__ = f"{cls.__qualname__}.__init__"
    return initializer


def _replace(instance: Any, /, **changes: Any) -> Any:
    for name, entry in getattr(instance, _FIELDS).items():
        if entry.init:
            changes.setdefault(name, getattr(instance, name))
        elif name in changes:
            raise TypeError(f"field {name} is declared with init=False, it cannot be specified with replace()")
    return type(instance)(**changes)


# --- shared by all classes --------------------------------------------------------------------------------------------


def _repr(self: Any) -> str:
    texts = (f"{name}={getattr(self, name)!r}" for name, entry in getattr(self, _FIELDS).items() if entry.repr)
    return f"{type(self).__qualname__}({', '.join(texts)})"


def _create_comparison_methods(fields: dict[str, _Field], *, frozen: bool) -> dict[str, Any]:
    names = [name for name, entry in fields.items() if entry.compare]
    values: Callable[[Any], Any] = attrgetter(*names) if names else lambda _: ()

    def equal(self: Any, other: Any) -> Any:
        return values(self) == values(other) if other.__class__ is self.__class__ else NotImplemented

    return {"__eq__": equal, "__hash__": (lambda self: hash(values(self))) if frozen else None}


def _refuse_to_set(self: Any, name: str, value: Any) -> None:
    _refuse(self, name, "assign to")
    _set(self, name, value)


def _refuse_to_delete(self: Any, name: str) -> None:
    _refuse(self, name, "delete")
    object.__delattr__(self, name)


def _refuse(self: Any, name: str, action: str) -> None:
    if _FIELDS in vars(type(self)) or name in getattr(self, _FIELDS):
        from dataclasses import FrozenInstanceError

        raise FrozenInstanceError(f"cannot {action} field {name!r}")


def _get_state(self: Any) -> list[Any]:
    return [getattr(self, name) for name in getattr(self, _FIELDS)]


def _set_state(self: Any, state: list[Any]) -> None:
    for name, value in zip(getattr(self, _FIELDS), state, strict=True):
        _set(self, name, value)


class _StandardAttribute:
    """An attribute that `dataclasses` sets on a class, computed on first access."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, instance: object, owner: type) -> Any:
        import dataclasses

        def standard_field(entry: _Field) -> Any:
            default = {"default_factory": entry.factory, "default": entry.default}
            defaults = {name: value for name, value in default.items() if value is not _MISSING}
            return dataclasses.field(init=entry.init, repr=entry.repr, compare=entry.compare, **defaults)

        cls = next(item for item in owner.__mro__ if vars(item).get(self._name) is self)
        fields = [
            (name, class_field.type, standard_field(class_field)) for name, class_field in vars(cls)[_FIELDS].items()
        ]
        standard_class = dataclasses.make_dataclass(cls.__name__, fields, frozen=vars(cls)[_OPTIONS][0])
        value = vars(standard_class)[self._name]
        setattr(cls, self._name, value)
        return value


_SHARED: dict[str, Any] = {
    "__repr__": _repr,
    **{name: _StandardAttribute(name) for name in ("__dataclass_fields__", "__dataclass_params__")},
}
_FROZEN: dict[str, Any] = {"__setattr__": _refuse_to_set, "__delattr__": _refuse_to_delete}
_PICKLE_METHODS: dict[str, Any] = {"__getstate__": _get_state, "__setstate__": _set_state}
"""The methods without which frozen objects with slots cannot be unpickled."""

# --- named tuples ----------------------------------------------------------------------------------------------------


class _NamedTupleMeta(type):
    def __new__(cls, name: str, _bases: tuple[type, ...], members: dict[str, Any]) -> Any:
        fields = members.get("__annotations__", {})
        defaults = [members[attribute] for attribute in fields if attribute in members]
        named_tuple = namedtuple(name, fields, defaults=defaults, module=members["__module__"])  # type: ignore[misc]  # noqa: PYI024
        for attribute, value in members.items():
            if attribute not in fields and attribute not in ("__module__", "__slots__", "__classcell__"):
                setattr(named_tuple, attribute, value)
        return named_tuple


def _create_named_tuple_base() -> Any:
    """Return a base class whose direct subclasses are named tuples, as for `typing.NamedTuple`.

    Subclasses of these named tuples are ordinary classes.
    """
    base = type.__new__(_NamedTupleMeta, "NamedTuple", (), {})
    return type("Base", (), {"__mro_entries__": lambda _self, _bases: (base,)})()


if TYPE_CHECKING:
    from dataclasses import dataclass, field, replace
    from typing import NamedTuple
else:
    dataclass, field, replace, NamedTuple = _dataclass, _field, _replace, _create_named_tuple_base()
