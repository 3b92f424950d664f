"""A base class that generates a substitution from its declaration and a function.

A class declares its tag ``$(tag ...)``, its text in listings, and its arguments::

    class EnvironmentVariable(DeclaredSubstitution, tag="env", shown="EnvVar({name})"):
        name: Texts = Texts()
        default_value: OptionalTexts = OptionalTexts(default=None, kw_only=True)

        def perform(self, context: LaunchContext) -> str: ...

From this declaration, the base class generates the constructor, the properties, the parser for XML and YAML, and the
check of the number of arguments.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from linkwright.launch.model.markup.expose import expose_substitution
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
)

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:
    C = TypeVar("C")

    def dataclass_transform(**_: Any) -> Callable[[C], C]:
        """Mark a class for type checkers: its constructor is generated from the fields.

        This decorator has no effect at run time.
        """
        return lambda decorated: decorated


_REQUIRED = object()


class Texts:
    """An argument that is a list of texts and substitutions to be joined.

    Args:
        default: the default value; if it is omitted, the argument is required.
        kw_only: whether Python code must pass the argument by keyword.
        read: converts a value to a list of substitutions.
    """

    def __init__(
        self,
        *,
        default: Any = _REQUIRED,
        kw_only: bool = False,
        read: Callable[[Any], Any] = normalize_to_list_of_substitutions,
    ) -> None:
        self.default = default
        self.kw_only = kw_only
        self.read = read
        self.name = ""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @property
    def is_required(self) -> bool:
        """Whether the argument is required."""
        return self.default is _REQUIRED

    def __get__(self, owner: Any, kind: type | None = None) -> list[Substitution]:
        """Return the argument's value as substitutions."""
        if owner is None:
            return self  # type: ignore[return-value]  # the declaration, read from the class
        texts: list[Substitution] = owner.__dict__[self.name]
        return texts

    def __set__(self, owner: Any, value: SomeSubstitutionsType | Path) -> None:
        """Normalize a value to substitutions, and store it."""
        owner.__dict__[self.name] = self.read(value)

    def describe(self, value: Any) -> str:
        """Return the text of a value in listings."""
        return describe(value)


class OptionalTexts(Texts):
    """A `Texts` argument that may be None."""

    if TYPE_CHECKING:
        # Declared only for mypy: the value of an optional argument may be None.
        def __get__(self, owner: Any, kind: type | None = None) -> list[Substitution] | None:  # type: ignore[override]  # see above
            ...

    def __set__(self, owner: Any, value: SomeSubstitutionsType | Path | None) -> None:
        """Normalize a value to substitutions, and store it.

        None is stored unchanged.
        """
        owner.__dict__[self.name] = None if value is None else self.read(value)

    def describe(self, value: Any) -> str:
        """Return the text of a value in listings.

        The text for None is empty.
        """
        return describe(value or [])


class AnyTexts(Texts):
    """A `Texts` argument that also accepts other values, and converts them with `read`."""

    def __set__(self, owner: Any, value: Any) -> None:
        """Convert a value to substitutions, and store it."""
        owner.__dict__[self.name] = self.read(value)


class AnyOptionalTexts(OptionalTexts):
    """An `AnyTexts` argument that may be None."""

    def __set__(self, owner: Any, value: Any) -> None:
        """Convert a value to substitutions, and store it.

        None is stored unchanged.
        """
        super().__set__(owner, value)


class TextLists(Texts):
    """An argument that is a list of `Texts`."""

    def __init__(self, *, default: Any = _REQUIRED, read: Callable[[Any], Any] = iter) -> None:
        super().__init__(default=default, read=lambda value: list(map(normalize_to_list_of_substitutions, read(value))))

    # Declared only for mypy: the value is a list of lists. No code accesses it through the type `Texts`.
    if TYPE_CHECKING:

        def __get__(self, owner: Any, kind: type | None = None) -> list[list[Substitution]]:  # type: ignore[override]  # see above
            ...

    def __set__(self, owner: Any, value: Iterable[SomeSubstitutionsType]) -> None:  # type: ignore[override]  # see above
        """Normalize each item of a value to substitutions, and store the list."""
        owner.__dict__[self.name] = self.read(value)

    def describe(self, value: Any) -> str:
        """Return the text of a value in listings, with commas between the items."""
        return ", ".join(map(describe, value))


@dataclass_transform(field_specifiers=(Texts, OptionalTexts, AnyTexts, AnyOptionalTexts, TextLists))
class DeclaredSubstitution(Substitution):
    """The base class of declared substitutions.

    Class arguments:
        tag: the name in ``$(name ...)``, or several names separated by slashes; empty for a substitution that only
            Python code can use.
        shown: the text in listings, with the arguments in braces and the class as ``{kind}``; by default the class and
            all arguments.
    """

    _tag: ClassVar[str] = ""
    _description_format: ClassVar[str | None] = None
    _arguments: ClassVar[tuple[Texts, ...]] = ()

    def __init_subclass__(cls, *, tag: str = "", shown: str | None = None, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        arguments = tuple(texts for texts in vars(cls).values() if isinstance(texts, Texts))
        if arguments:
            cls._arguments = arguments
            if "__init__" not in vars(cls):
                type.__setattr__(cls, "__init__", _create_constructor(cls))
        if shown is not None:
            cls._description_format = shown
        if tag:
            cls._tag = tag
            for name in tag.split("/"):
                expose_substitution(name)(cls)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
        """Return the class and its keyword arguments for the arguments in ``$(name ...)``.

        Args:
            data: the arguments, each a list of substitutions.

        Raises:
            Exception: the number of arguments is wrong; `wrong_count_error` returns the exception.
        """
        arguments = cls._arguments
        min_count, max_count = sum(argument.is_required for argument in arguments), len(arguments)
        if not min_count <= len(data) <= max_count:
            expected = str(max_count) if min_count == max_count else f"{min_count} or {max_count}"
            raise cls.wrong_count_error(f"{expected} argument{'' if max_count == 1 else 's'}", len(data))
        return cls, dict(zip((argument.name for argument in arguments), data, strict=False))

    @classmethod
    def wrong_count_error(cls, expected: str, argument_count: int) -> Exception:  # noqa: ARG003 - for classes that use it
        """Return the exception for a wrong number of arguments.

        As in ROS, the class of the exception depends on the substitution.
        """
        return TypeError(f"{cls._tag} substitution expects {expected}")

    def describe(self) -> str:
        """Return the text of the substitution in listings."""
        argument_texts = {argument.name: argument.describe(vars(self)[argument.name]) for argument in self._arguments}
        if self._description_format is None:
            return f"{type(self).__name__}({', '.join(argument_texts.values())})"
        return self._description_format.format(kind=type(self).__name__, **argument_texts)


def _create_constructor(cls: type[DeclaredSubstitution]) -> Callable[..., None]:
    """Return a generated constructor whose parameters are the declared arguments.

    Because the signature is explicit, Python checks calls, and editors show the parameters.
    """
    namespace: dict[str, Any] = {}
    parameters = ["self"]
    for argument in sorted(cls._arguments, key=lambda declared: declared.kw_only):
        if argument.kw_only and "*" not in parameters:
            parameters.append("*")
        parameters.append(argument.name if argument.is_required else f"{argument.name}=_default_{argument.name}")
        namespace[f"_default_{argument.name}"] = argument.default
    lines = [f"    self.{argument.name} = {argument.name}" for argument in cls._arguments]
    code = f"def __init__({', '.join(parameters)}):\n" + "\n".join(lines)
    exec(compile(code, __file__, "exec"), namespace)  # noqa: S102 - the text contains only the class's attribute names
    constructor: Callable[..., None] = namespace["__init__"]
    constructor.__qualname__ = f"{cls.__qualname__}.__init__"
    constructor.__module__ = cls.__module__
    return constructor
