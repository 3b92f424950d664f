"""The action that includes another launch file."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import (
    LinkwrightError,
    Note,
    Phrase,
    display_path,
    nearest,
    phrase,
    quoted_names,
)
from linkwright.launch.errors.alternatives import name_alternative
from linkwright.launch.errors.locations import MarkupLocation, error_at
from linkwright.launch.errors.unavailable import is_missing_third_party, mark_unavailable
from linkwright.launch.frontend.sources import AnyLaunchDescriptionSource, LaunchDescriptionSource
from linkwright.launch.model.action import Action
from linkwright.launch.model.actions.configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    SetLaunchConfiguration,
)
from linkwright.launch.model.actions.environment import PopEnvironment, PushEnvironment
from linkwright.launch.model.actions.functions import OpaqueFunction
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.entity import LaunchDescriptionEntity
from linkwright.launch.model.markup.entity import Entity
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    TextSubstitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.packages import is_substitute

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Parser

_FILE_PATH_LOCAL = "current_launch_file_path"
_FOLDER_LOCAL = "current_launch_file_directory"


@expose_action("include")
class IncludeLaunchDescription(Action):
    """An action that visits the description of another launch file.

    As in ROS, the including and the included file share their launch configurations. To keep the changes to the
    included file out of the including file, put this action into a `GroupAction`.

    Args:
        launch_description_source: the source of the description, or the path of its file.
        launch_arguments: pairs of the name and value of an argument.
    """

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType | Path,
        *,
        launch_arguments: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        if not isinstance(launch_description_source, LaunchDescriptionSource):
            launch_description_source = AnyLaunchDescriptionSource(launch_description_source)
        self._source = launch_description_source
        # As in ROS, a value that is not a string, such as None, is an error only if the file is actually included.
        self._arguments = [
            (normalize_to_list_of_substitutions(name), _normalize_if_possible(value))
            for name, value in launch_arguments or ()
        ]

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag, including ``arg`` and ``let`` tags."""
        _, kwargs = super().parse(entity, parser)
        kwargs["launch_description_source"] = parser.parse_substitution(entity.get_attr("file"))
        arguments = []
        for tag in ("arg", "let"):
            for child in entity.get_attr(tag, data_type=list[Entity], optional=True) or ():
                name, value = child.get_attr("name"), child.get_attr("value")
                arguments.append((parser.parse_substitution(name), parser.parse_substitution(value)))
                child.assert_entity_completely_parsed()
        if arguments:
            kwargs["launch_arguments"] = arguments
        return cls, kwargs

    @property
    def launch_description_source(self) -> LaunchDescriptionSource:
        """The source of the description."""
        return self._source

    @property
    def launch_arguments(self) -> list[tuple[list[Substitution], Any]]:
        """The names and values of the arguments as substitutions.

        A value that cannot be converted to substitutions remains unchanged.
        """
        return self._arguments

    def describe(self) -> str:
        """Return a text that names the source of the description."""
        return f"{type(self).__name__}({self._source.location})"

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """Return a list with the included description.

        The list is empty if the description cannot be read before the launch runs.
        """
        description = self._source.try_get_launch_description_without_context()
        return [] if description is None else [description]

    def hides_entities(self) -> bool:
        """Return whether the included description cannot be read before the launch runs."""
        return self._source.try_get_launch_description_without_context() is None

    def arguments_given_inside(self) -> tuple[str, ...]:
        """Return the names of the arguments that are set, except names that contain substitutions."""
        names = (name[0] for name, _ in self._arguments if len(name) == 1)
        return tuple(name.text for name in names if isinstance(name, TextSubstitution))

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the entities to visit next.

        These are actions that set the arguments, the description, and a closing action that restores the locals of the
        including file.

        Raises:
            RuntimeError: LAUNCH114, a required argument is missing.
            TypeError: LAUNCH114, the value of an argument is not a string.
            LinkwrightError: the description cannot be loaded from its source.
        """
        try:
            description = self._source.get_launch_description(context)
        except LinkwrightError as error:
            if is_missing_third_party(error) or self._is_missing_in_substitute():
                name_alternative(error)
                mark_unavailable(error)
            raise
        given_names = [perform_substitutions(context, name) for name, _ in self._arguments]
        self._check_required(description.get_launch_arguments(), given_names)
        self._check_values(given_names)
        outer_locals = context.get_locals_as_dict()
        replaced_locals = {
            name: outer_locals[name] for name in (_FILE_PATH_LOCAL, _FOLDER_LOCAL) if name in outer_locals
        }
        context.extend_locals(self._compute_file_locals())

        def restore_locals(context: LaunchContext) -> None:
            context.remove_locals((_FILE_PATH_LOCAL, _FOLDER_LOCAL))
            context.extend_locals(replaced_locals)

        return [
            *(SetLaunchConfiguration(name, value) for name, value in self._arguments),
            description,
            OpaqueFunction(function=restore_locals),
        ]

    def explain_inside(self, error: LinkwrightError) -> LinkwrightError:
        """Add a note with the location of the include to an error in the included description.

        Returns:
            The same error.
        """
        if self.source_location is not None and self._source.location_path is not None:
            note = Note(phrase("included from here"), self.source_location.span(self.source_location.source()))
            error.diagnostics = tuple(
                diagnostic if note in diagnostic.notes else diagnostic.with_changes(notes=(*diagnostic.notes, note))
                for diagnostic in error.diagnostics
            )
        return error

    def _is_missing_in_substitute(self) -> bool:
        """Return whether the included file is missing in Linkwright's substitute for a ROS package."""
        path = self._source.location_path
        return path is not None and not path.exists() and any(is_substitute(folder) for folder in path.parents)

    def _compute_file_locals(self) -> dict[str, str]:
        """Return the locals for the path and folder of the included file.

        A description without a file has none.
        """
        path = self._source.location_path
        if path is None:
            return {}
        folder = str(path.parent) if path.exists() else self._source.location
        return {_FILE_PATH_LOCAL: str(path), _FOLDER_LOCAL: folder}

    def _check_required(self, declared_arguments: Sequence[Any], given_names: list[str]) -> None:
        names = [argument.name for argument in declared_arguments]
        for argument in declared_arguments:
            if argument.default_value is not None or argument.conditionally_included or argument.name in given_names:
                continue
            unknown_names = [name for name in given_names if name not in names]
            similar_names = nearest(argument.name, unknown_names)
            hint = (
                phrase(
                    "did you mean '{name}' instead of {names}?",
                    name=argument.name,
                    names=quoted_names(similar_names, " or "),
                )
                if similar_names
                else self._argument_hint(argument.name)
            )
            path = self._source.location_path
            if path is None:
                message = phrase(
                    "the included launch description requires argument '{name}', which is not given", name=argument.name
                )
            else:
                file = display_path(path)
                message = phrase(
                    "the included launch file '{file}' requires argument '{name}', which is not given",
                    file=file,
                    name=argument.name,
                )
            text = (
                f"Included launch description missing required argument '{argument.name}' "
                f"(description: '{argument.description}'), given: [{', '.join(given_names)}]"
            )
            raise error_at(self.source_location, "LAUNCH114", message, hint, ros_error=RuntimeError(text))

    def _check_values(self, names: list[str]) -> None:
        for name, (_, value) in zip(names, self._arguments, strict=True):
            if not isinstance(value, list):
                message = phrase(
                    "the value of argument '{name}' is {value}, which is not a string", name=name, value=repr(value)
                )
                hint = phrase("pass a string or a substitution, or omit the argument")
                ros_error = TypeError(f"Failed to normalize given item of type '{type(value)}'")
                raise error_at(self.source_location, "LAUNCH114", message, hint, ros_error=ros_error)

    def _argument_hint(self, name: str) -> Phrase:
        """Return a hint that shows the argument in the language of the including file."""
        if not isinstance(self.source_location, MarkupLocation):
            return phrase("add ('{name}', VALUE) to launch_arguments", name=name)
        if self.source_location.text.text.lstrip().startswith("<"):
            return phrase('write <arg name="{name}" value="VALUE"/> inside <include>', name=name)
        return phrase("write 'arg: [{{name: {name}, value: VALUE}}]' below 'include'", name=name)


def _normalize_if_possible(value: Any) -> Any:
    try:
        return normalize_to_list_of_substitutions(value)
    except TypeError:
        return value


class IncludeScopedLaunchDescription(IncludeLaunchDescription):
    """An action that includes another launch file in a separate scope.

    The changes to launch configurations and environment variables end with the included file.
    """

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the entities to visit next, enclosed by actions that open and close the scope."""
        open_actions: list[LaunchDescriptionEntity] = [PushLaunchConfigurations(), PushEnvironment()]
        return [*open_actions, *super().execute(context), PopEnvironment(), PopLaunchConfigurations()]
