"""The action that starts a ROS node."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.hosting.plans import HostedPlan, opens_page
from linkwright.launch.errors.locations import with_location
from linkwright.launch.errors.unavailable import is_unavailable
from linkwright.launch.model import events
from linkwright.launch.model.action import Action
from linkwright.launch.model.actions.execute import ExecuteProcess
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.expose import expose_action
from linkwright.launch.model.plans import ProcessPlan
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.ros.deprecated_arguments import with_deprecated_arguments
from linkwright.launch.ros.executables import Executable, find_executable, is_hosted
from linkwright.launch.ros.names import (
    check_name,
    check_namespace,
    evaluate_rules,
    make_namespace_absolute,
    normalize_remap_rules,
    prefix_namespace,
    record_node_start,
)
from linkwright.launch.ros.node_extensions import node_extensions
from linkwright.launch.ros.parameter_lists import normalize_parameters
from linkwright.launch.ros.parameters import (
    NodeParameters,
    evaluate_own_parameters,
    evaluate_scope_parameters,
    is_malformed_file,
)
from linkwright.launch.ros.parsing import parse_node
from linkwright.launch.ros.scoping import NAMESPACE, PARAMETERS, REMAPPINGS
from linkwright.launch.ros.skipped_nodes import record_skipped_node, without_skipped_nodes
from linkwright.launch.ros.substitutions import ExecutableInPackage
from linkwright.packages.programs.workspace_environment import make_workspace_environment

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser
    from linkwright.packages import PackageFinder
    from linkwright.rviz import RvizConfig

_CONTAINER_PACKAGE = "rclcpp_components"
"""The package of the component containers, whose parameter files may apply to the nodes in them."""

_PROCESS_VARIABLES = re.compile(r"(ROS|RCUTILS|RMW|CYCLONEDDS|ZENOH|LINKWRIGHT)_")
"""Matches environment variables of a process that change how its nodes behave.

A node with its own values of these variables cannot run in the launcher's process.
"""


@expose_action("node")
@with_deprecated_arguments(node_executable="executable", node_name="name", node_namespace="namespace")
class Node(ExecuteProcess):
    """An action that starts a node.

    Linkwright's own nodes run in the launcher's process, and other nodes in separate processes.

    Args:
        executable: the name of the executable in the package, or a program if `package` is None.
        package: the name of the package of the executable; None for a program.
        name: the name of the node; None for the name that the program sets.
        namespace: the namespace of the node. Without a leading slash, it is relative to the namespaces of
            `PushRosNamespace`.
        exec_name: the name of the process in the log.
        parameters: dictionaries, paths of YAML files, and `ParameterFile` and `Parameter` objects. Later items take
            precedence.
        remappings: pairs of an original name and a new name.
        ros_arguments: further arguments after ``--ros-args``.
        arguments: the command-line arguments.
        kwargs: see `ExecuteProcess`.
    """

    UNSPECIFIED_NODE_NAME = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE = "<node_namespace_unspecified>"

    # These attributes are set when the node is started. They have the names of launch_ros's private attributes,
    # because some programs use those.
    __substitutions_performed: bool
    __expanded_node_name: str
    __expanded_node_namespace: str
    __expanded_remappings: list[tuple[str, str]] | None
    __final_node_name: str | None
    __node_parameters: NodeParameters
    __scope_count: int
    __scratch_folder: Path | None
    __all_parameter_arguments: list[tuple[str, bool]] | None

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
        remappings: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        program = executable if package is None else ExecutableInPackage(package=package, executable=executable)
        command: list[Any] = [program, *_as_list(arguments)]
        if ros_arguments is not None:
            command += ["--ros-args", *_as_list(ros_arguments)]
        command.append("--ros-args")
        if name is not None:
            command += ["-r", _DeferredArgument("name", lambda: f"__node:={self.__expanded_node_name}")]
        super().__init__(cmd=command, name=exec_name, **kwargs)
        self.__package = package
        self.__node_executable = executable
        self.__node_name = name
        self.__node_namespace = namespace
        self.__parameters = () if parameters is None else normalize_parameters(parameters)
        self.__remappings = [] if remappings is None else list(normalize_remap_rules(remappings))
        self.__arguments = arguments
        self.__ros_arguments = ros_arguments
        self.__fixed_word_count = len(self.cmd)
        self.__own_environment = kwargs.get("env"), kwargs.get("additional_env")
        self.__reset_results()
        self.hosted = False

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: Sequence[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        """Return the class and keyword arguments for the tag.

        The tag has the attributes and children of a process, and also ``pkg``, ``param``, ``remap`` and others.
        """
        _, kwargs = super().parse(entity, parser, ignore=["cmd", *(ignore or ())])
        return cls, parse_node(entity, parser, kwargs, cls)

    @staticmethod
    def parse_nested_parameters(params: list[Entity], parser: Parser) -> list[Any]:
        """Return the parameters in ``param`` tags as values for a node's ``parameters``."""
        from linkwright.launch.ros.parsing import parse_parameters

        return parse_parameters(params, parser)

    # --- properties -----------------------------------------------------------------------------------------

    @property
    def node_package(self) -> Any:
        """The package as passed to the constructor: a string, substitutions or None."""
        return self.__package

    @property
    def node_executable(self) -> Any:
        """The executable as passed to the constructor: a string or substitutions."""
        return self.__node_executable

    @property
    def node_name(self) -> str:
        """The full name of the node, available after the action was executed.

        Raises:
            RuntimeError: the action has not been executed yet.
        """
        if self.__final_node_name is None:
            raise RuntimeError("cannot access 'node_name' before executing action")
        return self.__final_node_name

    @property
    def expanded_node_namespace(self) -> str:
        """The evaluated namespace, or `UNSPECIFIED_NODE_NAMESPACE` if none is given."""
        return self.__expanded_node_namespace

    @property
    def expanded_remapping_rules(self) -> list[tuple[str, str]] | None:
        """The evaluated remapping rules of the scope, followed by the node's own rules, or None."""
        return self.__expanded_remappings

    def is_node_name_fully_specified(self) -> bool:
        """Return whether both the name and the namespace are given."""
        unspecified = (self.UNSPECIFIED_NODE_NAME, self.UNSPECIFIED_NODE_NAMESPACE)
        return all(placeholder not in self.node_name for placeholder in unspecified)

    # --- execution ------------------------------------------------------------------------------------------

    def execute(self, context: LaunchContext) -> list[Any] | None:
        """Start the node.

        Raises:
            DescriptionError: a parameter is a robot description with errors.
            LinkwrightError: the arguments of the node or its executable are not valid.
        """
        if context.is_shutdown:
            return None
        package = None if self.__package is None else _evaluate_text(context, self.__package)
        executable = _evaluate_text(context, self.__node_executable)
        self.hosted = is_hosted(package, executable) and self._may_be_hosted(context, package, executable)
        self.__reset_results()
        try:
            self._perform_substitutions(context)
        except LinkwrightError as error:
            if not is_malformed_file(error):
                raise
            self.__report_failed_start(context, executable, error)
            return None
        extension_arguments = self.__run_extensions(context)
        if self.hosted:
            assert package is not None
            process_name = self._start_hosted(context, package, executable, extension_arguments)
        else:
            self.cmd.extend(normalize_to_list_of_substitutions(argument) for argument in extension_arguments)
            process_name = self._start_process(context, package, executable)
        if self.is_node_name_fully_specified():
            warning = record_node_start(context, self.node_name)
            if warning is not None:
                context.session.log.write_warning(process_name, warning)
        return None

    def __report_failed_start(self, context: LaunchContext, executable: str, error: LinkwrightError) -> None:
        """Report why the node does not start, and that it has ended; the launch continues without it.

        In ROS the node reads its parameter files itself, and ends when it cannot.
        """
        name = context.session.assign_process_name(self.process_description.base_name(context, [executable]))
        context.session.report_start_failure(self, error)
        context.session.log.write_error(name, "node has not started")
        context.emit_event_sync(
            events.ProcessExited(action=self, returncode=1, name=name, cmd=[executable], cwd=None, env=None, pid=0)
        )

    def __run_extensions(self, context: LaunchContext) -> list[Any]:
        """Run the extensions, which may change the name and namespace of the node.

        Returns:
            The arguments that the extensions add to the command line.
        """
        added_arguments: list[Any] = []
        ros_arguments: dict[str, Any] = {}
        if self.__node_name is not None:
            ros_arguments["name"] = f"__node:={self.__expanded_node_name}"
        if self.__expanded_node_namespace != self.UNSPECIFIED_NODE_NAMESPACE:
            ros_arguments["ns"] = f"__ns:={self.__expanded_node_namespace}"
        for extension in node_extensions():
            new_arguments, ros_arguments = extension.prepare_for_execute(context, ros_arguments, self)
            added_arguments += new_arguments
        self.__expanded_node_name = ros_arguments.get("name", self.__expanded_node_name).removeprefix("__node:=")
        self.__expanded_node_namespace = ros_arguments.get("ns", self.__expanded_node_namespace).removeprefix("__ns:=")
        return added_arguments

    def viewer_config(self, context: LaunchContext) -> Callable[[], RvizConfig] | None:
        """Return a factory of the viewer's configuration.

        The result is None if the command line determines the configuration.
        """
        return None

    def _perform_substitutions(self, context: LaunchContext) -> None:
        """Evaluate the name, namespace, parameters and remappings, and complete the command line."""
        if self.__substitutions_performed:
            return
        try:
            self._expand_names(context)
        except LinkwrightError as error:
            raise with_location(error, self.source_location) from error
        scoped_parameters = evaluate_scope_parameters(context.launch_configurations.get(PARAMETERS) or (), context)
        node_parameters = evaluate_own_parameters(self.__parameters, context).without_missing_files(
            context, self.source_location
        )
        self.__node_parameters = NodeParameters([*scoped_parameters.sources, *node_parameters.sources])
        try:
            self.__node_parameters.check(context, self.__find_name_in_files(context), self.source_location)
        except LinkwrightError as error:
            raise with_location(error, self.source_location) from error
        self.__scope_count = len(scoped_parameters.sources)
        self.__scratch_folder = _find_scratch_folder(context)
        rules = [
            *(context.launch_configurations.get(REMAPPINGS) or ()),
            *evaluate_rules(context, self.__remappings),
        ]
        self.__expanded_remappings = rules or None
        if not self.hosted:
            self.__extend_command()
        self.__substitutions_performed = True

    def __reset_results(self) -> None:
        """Reset the results of an earlier execution of the action.

        The action is executed again when the user has fixed a robot description that it needs.
        """
        del self.cmd[self.__fixed_word_count :]
        self.__substitutions_performed = False
        self.__expanded_node_name = self.UNSPECIFIED_NODE_NAME
        self.__expanded_node_namespace = self.UNSPECIFIED_NODE_NAMESPACE
        self.__final_node_name = None
        self.__node_parameters = NodeParameters()
        self.__scope_count = 0
        self.__scratch_folder = None
        self.__all_parameter_arguments = None
        self.__expanded_remappings = None

    def _expand_names(self, context: LaunchContext) -> None:
        """Evaluate the name and namespace."""
        if self.__node_name is not None:
            self.__expanded_node_name = check_name(_evaluate_text(context, self.__node_name))
        own_namespace = None if self.__node_namespace is None else _evaluate_text(context, self.__node_namespace)
        namespace = make_namespace_absolute(
            prefix_namespace(context.launch_configurations.get(NAMESPACE), own_namespace)
        )
        if namespace is not None:
            self.__expanded_node_namespace = check_namespace(namespace)
        self.__final_node_name = f"{self.__expanded_node_namespace.rstrip('/')}/{self.__expanded_node_name}"

    def __find_name_in_files(self, context: LaunchContext) -> str | None:
        """Return the full name with which parameter files refer to the node, or None.

        The result is None if the program sets the name, because the name is then unknown. It is also None for a
        container, because the files may apply to other nodes in the container.
        """
        package = None if self.__package is None else _evaluate_text(context, self.__package)
        if self.__node_name is None or package == _CONTAINER_PACKAGE:
            return None
        namespace = self.__expanded_node_namespace
        parent_namespace = "" if namespace == self.UNSPECIFIED_NODE_NAMESPACE else namespace.rstrip("/")
        return f"{parent_namespace}/{self.__expanded_node_name}"

    @property
    def __expanded_parameter_arguments(self) -> list[tuple[str, bool]]:
        """Pairs of a parameter argument of the command line and whether it is the path of a file.

        Files with the values of dictionaries are written on first access. As in launch_ros, parameters of the scope
        are included only if they are files.
        """
        if self.__all_parameter_arguments is None:
            folder = self.__scratch_folder if self.__scratch_folder and self.__scratch_folder.is_dir() else None
            node = self.node_name if self.is_node_name_fully_specified() else None
            self.__all_parameter_arguments = self.__node_parameters.create_arguments(node, folder)
        scope_arguments = self.__all_parameter_arguments[: self.__scope_count]
        return [
            *(argument for argument in scope_arguments if argument[1]),
            *self.__all_parameter_arguments[self.__scope_count :],
        ]

    def __extend_command(self) -> None:
        arguments: list[Any] = []
        if self.__expanded_node_namespace != self.UNSPECIFIED_NODE_NAMESPACE:
            arguments += ["-r", _DeferredArgument("ns", lambda: f"__ns:={self.__expanded_node_namespace}")]
        _ = self.__expanded_parameter_arguments
        for argument, is_file in self.__all_parameter_arguments or ():
            arguments += ["--params-file" if is_file else "-p", argument]
        for source, target in self.__expanded_remappings or ():
            arguments += ["-r", f"{source}:={target}"]
        self.cmd.extend(normalize_to_list_of_substitutions(command_argument) for command_argument in arguments)

    # --- in the launcher's process ----------------------------------------------------------------------------

    def _may_be_hosted(self, context: LaunchContext, package: str | None, executable: str) -> bool:
        """Return whether the node can run in the launcher's process."""
        if opens_page(package, executable):
            return True
        if context.session.isolates_nodes or self.__own_environment[0] is not None:
            return False
        names = (_evaluate_text(context, name) for name in self.__own_environment[1] or ())
        if any(_PROCESS_VARIABLES.match(name) for name in names):
            return False
        return not self.process_description.prefix_arguments(context, [executable])

    def _start_hosted(
        self, context: LaunchContext, package: str, executable: str, extension_arguments: Sequence[Any]
    ) -> str:
        from linkwright.nodes.options import find_default_name

        session = context.session
        namespace = self.__expanded_node_namespace
        namespace = "/" if namespace == self.UNSPECIFIED_NODE_NAMESPACE else namespace
        name = None if self.__node_name is None else self.__expanded_node_name
        arguments = [_evaluate_text(context, argument) for argument in _as_list(self.__arguments)]
        if self.__ros_arguments is not None:
            arguments += ["--ros-args", *(_evaluate_text(context, word) for word in _as_list(self.__ros_arguments))]
        arguments += [_evaluate_text(context, word) for word in extension_arguments]
        base_name = self.process_description.base_name(context, [executable])
        own_name = name or find_default_name(package, executable)
        full_name = f"{namespace.rstrip('/')}/{own_name or executable}"
        if (
            name is None and own_name is not None and package != _CONTAINER_PACKAGE
        ):  # other nodes were checked before, or cannot be checked
            self.__node_parameters.check(context, full_name, self.source_location)
        plan = HostedPlan(
            self,
            session.assign_process_name(base_name),
            package,
            executable,
            name,
            namespace,
            without_skipped_nodes(context, package, self.__node_parameters.values(context, full_name)),
            self.__expanded_remappings or [],
            arguments,
            self.viewer_config(context),
            destinations=self._evaluate_destinations(context),
            respawns=self._respawn_max_retries if self._evaluate_boolean(context, "respawn", self._respawn) else 0,
            respawn_delay=self._respawn_delay or 0.0,
            parameters_of_others=self.__node_parameters.read_rules(context),
        )
        self.process_description.final_name = plan.process_name
        self.process_description.final_cmd = plan.details["cmd"]
        session.host.schedule_node(plan)
        return plan.process_name

    # --- in a separate process --------------------------------------------------------------------------------

    def _start_process(self, context: LaunchContext, package: str | None, executable: str) -> str:
        arguments = [perform_substitutions(context, argument) for argument in self.cmd[1:]]
        return self._start(context, [*self._find_program_command(context, package, executable), *arguments])

    def _find_program_command(self, context: LaunchContext, package: str | None, executable: str) -> list[str]:
        if package is None:
            return [executable]
        try:
            return self._find_executable(context.session.finder, package, executable).command
        except LinkwrightError as error:
            if is_unavailable(error):
                record_skipped_node(context, executable if self.__node_name is None else self.__expanded_node_name)
            raise with_location(error, self.source_location) from error

    def _find_executable(self, finder: PackageFinder, package: str, executable: str) -> Executable:
        return find_executable(finder, package, executable)

    def _create_plan(self, context: LaunchContext, command: list[str]) -> ProcessPlan:
        plan = super()._create_plan(context, command)
        if self.process_description.name is not None:
            return plan
        # The executable's name is the process's name, even if an interpreter runs it or the node is one of
        # Linkwright's.
        return replace(plan, name=Path(_evaluate_text(context, self.__node_executable)).name)

    def _evaluate_environment(self, context: LaunchContext) -> dict[str, str]:
        return make_workspace_environment(context.session.finder, super()._evaluate_environment(context))


class _DeferredArgument(Substitution):
    """A command-line argument that is evaluated only when the action starts the node.

    Args:
        name: the name of the argument in listings.
        get_argument: returns the argument.
    """

    def __init__(self, name: str, get_argument: Callable[[], str]) -> None:
        self._name = name
        self._get_argument = get_argument

    def describe(self) -> str:
        """Return a text with the name of the argument."""
        return f"LocalVar('ros_specific_arguments['{self._name}']')"

    def perform(self, context: LaunchContext) -> str:
        """Return the argument."""
        return self._get_argument()


def _as_list(values: Any) -> list[Any]:
    """Return an argument or several arguments as a list.

    None becomes an empty list.
    """
    if values is None:
        return []
    return [values] if isinstance(values, (str, Substitution)) or not isinstance(values, Iterable) else list(values)


def _evaluate_text(context: LaunchContext, value: Any) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))


def _find_scratch_folder(context: LaunchContext) -> Path | None:
    try:
        return context.session.scratch_folder
    except (AttributeError, RuntimeError):  # no launch is running in this context
        return None
