"""Declaring the arguments of a launch file."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from linkwright.diagnostics import did_you_mean
from linkwright.launch.context import LaunchContext
from linkwright.launch.entity import Action
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class DeclareLaunchArgument(Action):
    """Declares an argument and sets the launch configuration of its name, to the value given or the default.

    Args:
        name: the argument's name.
        default_value: the value where none is given; without one the argument is required.
        description: what ``--show-args`` says of it.
        choices: the values it may have.
    """

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Iterable[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._name = name
        self._default = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        self._choices = None if choices is None else list(choices)
        self._description = description
        self.conditionally_included = False
        if self._choices is None:
            return
        if not self._choices:
            raise error_at(self.place, "LAUNCH112", f"argument '{name}' is declared with an empty list of choices")
        if isinstance(default_value, str) and default_value not in self._choices:
            message = f"the default '{default_value}' of argument '{name}' is none of its choices"
            raise error_at(self.place, "LAUNCH112", message, self._hint(default_value))

    @property
    def name(self) -> str:
        """The argument's name."""
        return self._name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The default as substitutions, None for a required argument."""
        return self._default

    @property
    def description(self) -> str:
        """What ``--show-args`` says of it, the choices included."""
        if self._description is None:
            return "no description given" if self._choices is None else f"One of: {self._choices}"
        if self._choices is None:
            return self._description
        stop = "" if self._description.endswith(".") else "."
        return f"{self._description}{stop} Valid choices are: {self._choices}"

    @property
    def choices(self) -> list[str] | None:
        """The values it may have, None for any."""
        return self._choices

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration if it is not set, and check its value.

        Raises:
            LinkwrightError: LAUNCH112, a value that is no choice; LAUNCH114, a required argument not given.
        """
        configurations = context.launch_configurations
        if self._name not in configurations:
            if self._default is None:
                described = f" ({self._description})" if self._description else ""
                message = f"argument '{self._name}'{described} is required and was not given"
                raise error_at(self.place, "LAUNCH114", message, f"add {self._name}:=VALUE")
            configurations[self._name] = perform_substitutions(context, self._default)
        value = configurations[self._name]
        if self._choices is not None and value not in self._choices:
            message = f"argument '{self._name}' has the value '{value}', which is none of its choices"
            raise error_at(self.place, "LAUNCH112", message, self._hint(str(value)))

    def _hint(self, value: str) -> str:
        choices = self._choices or []
        listed = "choose from " + ", ".join(f"'{choice}'" for choice in choices)
        near = did_you_mean(value, choices) if len(choices) > 2 else None
        return f"{near} ({listed})" if near else listed
