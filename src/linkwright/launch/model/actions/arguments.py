"""The actions that declare arguments of a launch file."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Phrase, did_you_mean, phrase, quoted_names
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.entity import Entity, parse_attributes
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Parser

_BOOLEAN_TEXTS = ("true", "false", "True", "False", "TRUE", "FALSE")


def _read_choice_list(entity: Entity) -> list[str] | None:
    """Return the list ``choices`` of a YAML tag, or None if the tag has no choices.

    Raises:
        TypeError: LAUNCH118, the value is not a list of strings.
    """
    try:
        choices: list[str] | None = entity.get_attr("choices", data_type=list[str], optional=True)
    except TypeError as error:
        ros_error = TypeError("Attribute 'choices' of Entity 'arg' expected to be a list of strings")
        message = phrase("key 'choices' of '{type_name}' must be a list of strings", type_name=entity.type_name)
        raise error_at(entity.source_location, "LAUNCH118", message, ros_error=ros_error) from error
    return choices


@expose_action("arg")
class DeclareLaunchArgument(Action):
    """An action that declares an argument of a launch file.

    The launch configuration with the argument's name receives the given value or the default value.

    Args:
        name: the argument's name.
        default_value: the default; None makes the argument required.
        description: the description for ``--show-args``.
        choices: the allowed values; None allows any value.
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
            ros_error = RuntimeError("Provided choices arg is empty. Use None to ignore the choice list.")
            message = phrase("argument '{name}' is declared with an empty list of choices", name=name)
            raise error_at(self.source_location, "LAUNCH112", message, ros_error=ros_error)
        if isinstance(default_value, str) and default_value not in self._choices:
            text = f'Provided default_value "{default_value}" is not in provided choices "{self._choices}".'
            message = phrase(
                "the default '{default_value}' of argument '{name}' is not one of its choices",
                default_value=default_value,
                name=name,
            )
            hint = self._choice_hint(default_value)
            raise error_at(self.source_location, "LAUNCH112", message, hint, ros_error=RuntimeError(text))

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, with its choices.

        The choices are ``choice`` tags inside, or the list ``choices`` in YAML.
        """
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.escape_characters(entity.get_attr("name"))
        kwargs.update(parse_attributes(entity, parser, default_value="default"))
        description = entity.get_attr("description", optional=True)
        if description is not None:
            kwargs["description"] = parser.escape_characters(description)
        choices = entity.get_attr("choice", data_type=list[Entity], optional=True)
        if choices is not None:
            kwargs["choices"] = [parser.escape_characters(choice.get_attr("value")) for choice in choices]
            for choice in choices:
                choice.assert_entity_completely_parsed()
        else:
            choice_list = _read_choice_list(entity)
            if choice_list is not None:
                kwargs["choices"] = [parser.escape_characters(choice) for choice in choice_list]
        return cls, kwargs

    @property
    def name(self) -> str:
        """The argument's name."""
        return self._name

    @property
    def default_value(self) -> list[Substitution] | None:
        """The default value as substitutions, or None for a required argument."""
        return self._default

    @property
    def description(self) -> str:
        """The description for ``--show-args``, with the choices."""
        if self._description is None:
            return "no description given" if self._choices is None else f"One of: {self._choices}"
        if self._choices is None:
            return self._description
        period = "" if self._description.endswith(".") else "."
        return f"{self._description}{period} Valid choices are: {self._choices}"

    @property
    def choices(self) -> list[str] | None:
        """The allowed values, or None if any value is allowed."""
        return self._choices

    @property
    def _conditionally_included(self) -> bool:
        """The value of `conditionally_included`, under the private name that it has in ROS."""
        return self.conditionally_included

    def describe(self) -> str:
        """Return a text with the argument's name, default and description."""
        default = "" if self._default is None else f", default_value={describe(self._default)}"
        return f"{type(self).__name__}('{self._name}'{default}, description='{self.description}')"

    def execute(self, context: LaunchContext) -> None:
        """Set the launch configuration to the default if it has no value, and check the value.

        Raises:
            RuntimeError: LAUNCH112, the value is not one of the choices; LAUNCH114, a required argument is missing.
        """
        configurations = context.launch_configurations
        if self._name not in configurations:
            if self._default is None:
                message = (
                    phrase(
                        "argument '{name}' ({description}) is required, but was not given",
                        name=self._name,
                        description=self._description,
                    )
                    if self._description
                    else phrase("argument '{name}' is required, but was not given", name=self._name)
                )
                ros_error = RuntimeError(f'Required launch argument "{self._name}" was not provided.')
                raise error_at(
                    self.source_location,
                    "LAUNCH114",
                    message,
                    phrase("add {name}:=VALUE", name=self._name),
                    ros_error=ros_error,
                )
            configurations[self._name] = perform_substitutions(context, self._default)
        value = configurations[self._name]
        if self._choices is not None and value not in self._choices:
            text = f'Argument "{self._name}" provided value "{value}" is not valid. Valid options are: {self._choices}'
            message = phrase(
                "argument '{name}' has the value '{value}', which is not one of its choices",
                name=self._name,
                value=value,
            )
            hint = self._choice_hint(str(value))
            raise error_at(self.source_location, "LAUNCH112", message, hint, ros_error=RuntimeError(text))

    def _choice_hint(self, value: str) -> Phrase:
        choices = self._choices or []
        choices_hint = phrase("choose from {names}", names=quoted_names(choices))
        suggestion = did_you_mean(value, choices) if len(choices) > 2 else None
        return phrase("{hint} ({choose})", hint=suggestion, choose=choices_hint) if suggestion else choices_hint


@expose_action("bool_arg")
class DeclareBooleanLaunchArgument(DeclareLaunchArgument):
    """An action that declares a boolean argument.

    Args:
        name: the argument's name.
        default_value: the default value.
    """

    def __init__(self, name: str, *, default_value: SomeSubstitutionsType | bool | None = None, **kwargs: Any) -> None:
        default = str(default_value) if isinstance(default_value, bool) else default_value
        super().__init__(name, default_value=default, choices=_BOOLEAN_TEXTS, **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag.

        The tag accepts no choices.
        """
        _, kwargs = super().parse(entity, parser)
        if "choices" in kwargs:
            raise ValueError("Cannot specify choices for bool_arg")
        return cls, kwargs
