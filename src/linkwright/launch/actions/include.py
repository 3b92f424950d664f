"""Including other launch files."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from linkwright.diagnostics import did_you_mean
from linkwright.launch.actions.configurations import SetLaunchConfiguration
from linkwright.launch.actions.functions import OpaqueFunction
from linkwright.launch.context import LaunchContext
from linkwright.launch.declared import declared_arguments
from linkwright.launch.entity import Action, LaunchDescriptionEntity
from linkwright.launch.places import error_at
from linkwright.launch.sources import AnyLaunchDescriptionSource, LaunchDescriptionSource
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_FILE = "current_launch_file_path"
_FOLDER = "current_launch_file_directory"


class IncludeLaunchDescription(Action):
    """Visits the description of another launch file.

    As in ROS, launch configurations are shared with the including file, in both directions; a GroupAction
    around it keeps them apart.

    Args:
        launch_description_source: where the description comes from; a path will do.
        launch_arguments: pairs of name and value of the arguments given to it.
    """

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = AnyLaunchDescriptionSource(launch_description_source)
        self._source = launch_description_source
        self._arguments = [
            (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
            for name, value in launch_arguments or ()
        ]

    @property
    def launch_description_source(self) -> LaunchDescriptionSource:
        """Where the description comes from."""
        return self._source

    @property
    def launch_arguments(self) -> list[tuple[list[Substitution], list[Substitution]]]:
        """Names and values of the arguments, as substitutions."""
        return self._arguments

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """The description, if it can be had before the launch runs."""
        description = self._source.try_get_launch_description_without_context()
        return () if description is None else (description,)

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        """The description, to be visited next with its arguments set.

        Raises:
            LinkwrightError: LAUNCH114, an argument that it requires is not given; and what its source raises.
        """
        description = self._source.get_launch_description(context)
        given = [perform_substitutions(context, name) for name, _ in self._arguments]
        self._check_required(context, declared_arguments(description), given)
        outer = context.get_locals_as_dict()

        def enter(context: LaunchContext) -> None:
            path = self._source.location_path
            context.extend_locals({_FILE: str(path), _FOLDER: str(path.parent)} if path else {})

        def leave(context: LaunchContext) -> None:
            context.extend_locals({_FILE: outer.get(_FILE), _FOLDER: outer.get(_FOLDER)})

        return [
            *(SetLaunchConfiguration(name, value) for name, value in self._arguments),
            OpaqueFunction(function=enter),
            description,
            OpaqueFunction(function=leave),
        ]

    def _check_required(self, context: LaunchContext, declared: Sequence[Any], given: list[str]) -> None:
        names = [argument.name for argument in declared]
        for argument in declared:
            if argument.default_value is not None or argument.conditionally_included:
                continue
            if argument.name in given or argument.name in context.launch_configurations:
                continue
            unknown = [name for name in given if name not in names]
            near = did_you_mean(argument.name, unknown)
            hint = (
                f"it is given {near[len('did you mean ') : -1]}: is that the one?"
                if near
                else (f"add ('{argument.name}', VALUE) to launch_arguments")
            )
            message = f"the included launch file requires argument '{argument.name}', which is not given"
            raise error_at(self.place, "LAUNCH114", message, hint)
