"""Substitutions that give the values of loops, see `linkwright.launch.actions.loops`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.diagnostics import did_you_mean
from linkwright.launch.context import LaunchContext
from linkwright.launch.frontend.expose import expose_substitution
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_PREFIX = "ForEachVar__"


def local_name(name: str) -> str:
    """The name of the local of the launch context that holds a value of a loop."""
    return _PREFIX + name


@expose_substitution("for-var")
class ForEachVar(Substitution):
    """A value of this round of a `ForEach`.

    Args:
        name: the value's name.
        default_value: the text where the round has no such value; None makes that an error.
    """

    def __init__(self, name: SomeSubstitutionsType, *, default_value: SomeSubstitutionsType | None = None) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._default = None if default_value is None else normalize_to_list_of_substitutions(default_value)

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """The class and its arguments, for a name and perhaps a default.

        Raises:
            ValueError: there are none, or more.
        """
        if len(data) not in (1, 2):
            raise ValueError(f"{cls.__name__} substitution expects 1 or 2 arguments")
        return cls, {"name": data[0]} if len(data) == 1 else {"name": data[0], "default_value": data[1]}

    @staticmethod
    def get_local_arg_name(name: str) -> str:
        """The name of the local of the launch context that holds the value."""
        return local_name(name)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The default, as substitutions."""
        return self._default

    def describe(self) -> str:
        """Name and default."""
        default = describe(self._default or [])
        return f"{type(self).__name__}(name={describe(self._name)}, default_value={default})"

    def perform(self, context: LaunchContext) -> str:
        """The value.

        Raises:
            RuntimeError: LAUNCH123, if there is no such value and no default.
        """
        name = perform_substitutions(context, self._name)
        values = context.get_locals_as_dict()
        if local_name(name) in values:
            return str(values[local_name(name)])
        if self._default is not None:
            return perform_substitutions(context, self._default)
        known = [each.removeprefix(_PREFIX) for each in values if each.startswith(_PREFIX)]
        hint = did_you_mean(name, known)
        if hint is None:
            hint = "it has " + ", ".join(f"'{each}'" for each in known) if known else "use it inside of a loop"
        promised = RuntimeError(f"No value available for {type(self).__name__} '{name}' and no default value provided")
        raise error_at(self.place, "LAUNCH123", f"the loop has no value '{name}'", hint, promises=promised)


@expose_substitution("index")
class ForLoopIndex(ForEachVar):
    """The number of this round of a `ForLoop`, by the loop's name."""

    def __init__(self, name: SomeSubstitutionsType, **_: Any) -> None:
        super().__init__(name)
