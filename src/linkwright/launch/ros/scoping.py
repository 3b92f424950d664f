"""Actions that set the namespaces, parameters and remappings of all later nodes in a scope.

As in launch_ros, the settings are stored in launch configurations, so that they end with a group.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.hosting.launch_log import find_log_base
from linkwright.launch.errors.locations import error_at
from linkwright.launch.model.action import Action
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.ros.names import check_namespace, make_namespace_absolute, prefix_namespace
from linkwright.launch.ros.parameter_lists import evaluate_parameter_dict, normalize_parameter_dict

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser

NAMESPACE = "ros_namespace"
PARAMETERS = "global_params"
REMAPPINGS = "ros_remaps"

ParseResult = tuple[type[Action], dict[str, Any]]


@expose_action("push_ros_namespace")
@expose_action("push-ros-namespace")
class PushRosNamespace(Action):
    """An action that adds a prefix to the namespaces of later nodes in the same scope."""

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._namespace = normalize_to_list_of_substitutions(namespace)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> ParseResult:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser)
        kwargs["namespace"] = parser.parse_substitution(entity.get_attr("namespace"))
        return cls, kwargs

    @property
    def namespace(self) -> list[Substitution]:
        """The namespace, as substitutions."""
        return self._namespace

    def execute(self, context: LaunchContext) -> None:
        """Append the namespace to the current one for later nodes.

        Raises:
            LinkwrightError: LAUNCH134, the namespace is not valid.
        """
        inner_namespace = perform_substitutions(context, self._namespace)
        outer_namespace = context.launch_configurations.get(NAMESPACE)
        namespace = make_namespace_absolute(prefix_namespace(outer_namespace, inner_namespace))
        assert namespace is not None
        context.launch_configurations[NAMESPACE] = check_namespace(namespace)


@expose_action("set_parameter")
class SetParameter(Action):
    """An action that sets a parameter for all later nodes.

    A node's own value takes precedence.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        name = normalize_to_list_of_substitutions(name)
        self._parameters = normalize_parameter_dict({tuple(name): value})

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> ParseResult:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser)
        kwargs["name"] = parser.parse_substitution(entity.get_attr("name"))
        value = entity.get_attr("value", data_type=None)
        # A string is read as YAML, even if it is quoted in a YAML file.
        kwargs["value"] = parser.parse_substitution(entity.get_attr("value")) if isinstance(value, str) else value
        return cls, kwargs

    @property
    def name(self) -> tuple[Substitution, ...]:
        """The name, as substitutions."""
        return next(iter(self._parameters))

    @property
    def value(self) -> Any:
        """The normalized value."""
        return next(iter(self._parameters.values()))

    def execute(self, context: LaunchContext) -> None:
        """Evaluate the parameter, and store it for later nodes.

        Raises:
            LinkwrightError: LAUNCH132, the value has errors.
        """
        for rule in evaluate_parameter_dict(context, self._parameters).items():
            _append(context, PARAMETERS, rule)


@expose_action("set_parameters_from_file")
class SetParametersFromFile(Action):
    """An action that sets a file's parameters for all later nodes that the file matches."""

    def __init__(self, filename: Path | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._filename = normalize_to_list_of_substitutions(filename)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> ParseResult:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser)
        kwargs["filename"] = parser.parse_substitution(entity.get_attr("filename"))
        return cls, kwargs

    @property
    def filename(self) -> list[Substitution]:
        """The path, as substitutions."""
        return self._filename

    def execute(self, context: LaunchContext) -> None:
        """Store the parameter file for later nodes."""
        _append(context, PARAMETERS, perform_substitutions(context, self._filename))


@expose_action("set_remap")
class SetRemap(Action):
    """An action that adds a remapping to all later nodes."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._source = normalize_to_list_of_substitutions(src)
        self._destination = normalize_to_list_of_substitutions(dst)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> ParseResult:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser)
        kwargs["src"] = parser.parse_substitution(entity.get_attr("from"))
        kwargs["dst"] = parser.parse_substitution(entity.get_attr("to"))
        return cls, kwargs

    @property
    def src(self) -> list[Substitution]:
        """The original name, as substitutions."""
        return self._source

    @property
    def dst(self) -> list[Substitution]:
        """The new name, as substitutions."""
        return self._destination

    def execute(self, context: LaunchContext) -> None:
        """Store the remapping for later nodes."""
        rule = perform_substitutions(context, self._source), perform_substitutions(context, self._destination)
        _append(context, REMAPPINGS, rule)


@expose_action("set_use_sim_time")
class SetUseSimTime(SetParameter):
    """An action that sets ``use_sim_time`` for all later nodes."""

    def __init__(self, value: bool | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> ParseResult:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = Action.parse.__func__(cls, entity, parser)  # type: ignore[attr-defined]  # skips SetParameter's
        kwargs["value"] = parser.parse_if_substitutions(entity.get_attr("value", data_type=bool, can_be_str=True))
        return cls, kwargs

    def execute(self, context: LaunchContext) -> None:
        """Set ``use_sim_time`` for later nodes and for the launcher's own timers.

        Raises:
            LinkwrightError: LAUNCH132, the value is neither true nor false.
        """
        super().execute(context)
        value = context.launch_configurations[PARAMETERS][-1][1]
        if not isinstance(value, bool):
            message = phrase("'use_sim_time' must be true or false, not {value}", value=repr(value))
            raise error_at(self.source_location, "LAUNCH132", message, ros_error=ValueError(message))
        if context.is_running:
            context.session.host.use_simulated_time(value)


@expose_action("set_ros_log_dir")
class SetROSLogDir(Action):
    """An action that changes the log folder of later processes.

    Args:
        new_log_dir: the path of the folder; a relative path is relative to the previous log folder.
    """

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._log_dir = normalize_to_list_of_substitutions(new_log_dir)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> ParseResult:
        """Return the class and keyword arguments for the tag."""
        _, kwargs = super().parse(entity, parser)
        kwargs["new_log_dir"] = parser.parse_substitution(entity.get_attr("new_log_dir"))
        return cls, kwargs

    @property
    def log_dir(self) -> list[Substitution]:
        """The path of the folder, as substitutions."""
        return self._log_dir

    def execute(self, context: LaunchContext) -> None:
        """Change the log folder.

        Raises:
            LinkwrightError: LAUNCH136, both the new and the previous folder are relative.
        """
        folder = Path(find_log_base(context.environment), perform_substitutions(context, self._log_dir))
        if not folder.is_absolute():
            message = phrase("the log folder '{folder}' is not an absolute path", folder=folder)
            raise error_at(
                self.source_location,
                "LAUNCH136",
                message,
                phrase("set ROS_LOG_DIR to an absolute path"),
                ros_error=AssertionError(message),
            )
        context.environment["ROS_LOG_DIR"] = os.fspath(folder)


def _append(context: LaunchContext, name: str, item: Any) -> None:
    # A new list is created, because an outer scope may have saved the old one.
    context.launch_configurations[name] = [*context.launch_configurations.get(name, ()), item]
