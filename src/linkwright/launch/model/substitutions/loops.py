"""Substitutions for the values of loops. See `linkwright.launch.model.actions.loops`."""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import did_you_mean, phrase, quoted_names
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    DeclaredSubstitution,
    OptionalTexts,
    Texts,
)
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    perform_substitutions,
)

_LOCAL_PREFIX = "ForEachVar__"


def local_name(name: str) -> str:
    """Return the name of the launch context's local for a value of a loop."""
    return _LOCAL_PREFIX + name


class ForEachVar(DeclaredSubstitution, tag="for-var", shown="{kind}(name={name}, default_value={default_value})"):
    """A substitution that evaluates to a value of the current iteration of a `ForEach`.

    Args:
        name: the name of the value.
        default_value: the text if the iteration has no such value. If it is None, a missing value is an error.
    """

    name: Texts = Texts()
    default_value: OptionalTexts = OptionalTexts(default=None, kw_only=True)

    @classmethod
    def wrong_count_error(cls, expected: str, argument_count: int) -> Exception:  # noqa: ARG003 - the interface requires it
        """Return a ValueError for a wrong number of arguments, as ROS does."""
        return ValueError(f"{cls.__name__} substitution expects {expected}")

    @staticmethod
    def get_local_arg_name(name: str) -> str:
        """Return the name of the launch context's local for the value."""
        return local_name(name)

    def perform(self, context: LaunchContext) -> str:
        """Return the value.

        Raises:
            RuntimeError: LAUNCH123, there is no such value and no default.
        """
        name = perform_substitutions(context, self.name)
        values = context.get_locals_as_dict()
        if local_name(name) in values:
            return str(values[local_name(name)])
        if self.default_value is not None:
            return perform_substitutions(context, self.default_value)
        loop_names = [value.removeprefix(_LOCAL_PREFIX) for value in values if value.startswith(_LOCAL_PREFIX)]
        hint = did_you_mean(name, loop_names)
        if hint is None:
            hint = (
                phrase("the loop has {names}", names=quoted_names(loop_names))
                if loop_names
                else phrase("use the substitution inside a loop")
            )
        ros_error = RuntimeError(f"No value available for {type(self).__name__} '{name}' and no default value provided")
        raise error_at(
            self.source_location,
            "LAUNCH123",
            phrase("the loop has no value named '{name}'", name=name),
            hint,
            ros_error=ros_error,
        )


class ForLoopIndex(ForEachVar, tag="index"):
    """A substitution that evaluates to the current index of the `ForLoop` with the given name."""

    def __init__(self, name: SomeSubstitutionsType, **_: Any) -> None:
        super().__init__(name)
