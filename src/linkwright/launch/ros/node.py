"""The action that starts a ROS node."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.hosting.plans import HostedPlan, is_viewer
from linkwright.launch.errors.places import located
from linkwright.launch.errors.unavailable import is_unavailable
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
from linkwright.launch.ros.left_out import record_skipped_node, without_skipped_nodes
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
from linkwright.launch.ros.parameters import NodeParameters, own_parameters, scope_parameters
from linkwright.launch.ros.parsing import parse_node
from linkwright.launch.ros.scoping import NAMESPACE, PARAMETERS, REMAPPINGS
from linkwright.launch.ros.substitutions import ExecutableInPackage
from linkwright.packages.programs.workspace_environment import workspace_environment

if TYPE_CHECKING:
    from linkwright.launch.model.markup.entity import Entity, Parser
    from linkwright.packages import PackageFinder
    from linkwright.rviz import RvizConfig

_CONTAINERS = "rclcpp_components"
"""The package whose executables run other nodes too, to which parameter files may apply."""

_OF_A_PROCESS = re.compile(r"(ROS|RCUTILS|RMW|CYCLONEDDS|ZENOH|LINKWRIGHT)_")
"""Environment variables that change a node's behaviour; a node with its own values cannot run in the launcher."""


@expose_action("node")
@with_deprecated_arguments(node_executable="executable", node_name="name", node_namespace="namespace")
class Node(ExecuteProcess):
    """Starts a node.

    A Linkwright node runs in the launcher's process, and any other node in a separate process.

    Args:
        executable: the node's executable in the package, or a program if no package is given.
        package: the package of the executable.
        name: the name to give to the node.
        namespace: the namespace of the node, inside the namespaces of `PushRosNamespace` unless it starts with a slash.
        exec_name: the name of the process in the log.
        parameters: dictionaries, paths of YAML files, `ParameterFile` and `Parameter` objects; later items take
            precedence.
        remappings: pairs of names.
        ros_arguments: further arguments after ``--ros-args``.
        arguments: the command-line arguments.
        kwargs: see `ExecuteProcess`.
    """

    UNSPECIFIED_NODE_NAME = "<node_name_unspecified>"
    UNSPECIFIED_NODE_NAMESPACE = "<node_namespace_unspecified>"

    # These attributes are set when the node is started. They have the names of launch_ros's private attributes, which
    # some
    # programs use.
    __substitutions_performed: bool
    __expanded_node_name: str
    __expanded_node_namespace: str
    __expanded_remappings: list[tuple[str, str]] | None
    __final_node_name: str | None
    __node_parameters: NodeParameters
    __scope_count: int
    __scratch_folder: Path | None
    __parameter_words: list[tuple[str, bool]] | None

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
        command: list[Any] = [program, *_listed(arguments)]
        if ros_arguments is not None:
            command += ["--ros-args", *_listed(ros_arguments)]
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
        self.__fixed_words = len(self.cmd)
        self.__own_environment = kwargs.get("env"), kwargs.get("additional_env")
        self.__forget()
        self.hosted = False

    @classmethod
    def parse(
        cls, entity: Entity, parser: Parser, ignore: Sequence[str] | None = None
    ) -> tuple[type[Action], dict[str, Any]]:
        """Read the attributes that a node's tag shares with a process's tag, and its own ones.

        Examples of its own attributes and tags are ``pkg``, ``exec``, ``param`` and ``remap``.
        """
        _, kwargs = super().parse(entity, parser, ignore=["cmd", *(ignore or ())])
        return cls, parse_node(entity, parser, kwargs, cls)

    @staticmethod
    def parse_nested_parameters(params: list[Entity], parser: Parser) -> list[Any]:
        """Return the parameters in ``param`` tags in the form of a node's ``parameters``."""
        from linkwright.launch.ros.parsing import parse_parameters

        return parse_parameters(params, parser)

    # --- properties -----------------------------------------------------------------------------------------

    @property
    def node_package(self) -> Any:
        """The package as given: a string, substitutions or None."""
        return self.__package

    @property
    def node_executable(self) -> Any:
        """The executable as given: a string or substitutions."""
        return self.__node_executable

    @property
    def node_name(self) -> str:
        """The full name of the node, which is known after the action was executed.

        Raises:
            RuntimeError: the action was not executed yet.
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
        """The evaluated remapping rules, with those of the scope first; None if there are none."""
        return self.__expanded_remappings

    def is_node_name_fully_specified(self) -> bool:
        """Return whether both the name and the namespace are given."""
        unspecified = (self.UNSPECIFIED_NODE_NAME, self.UNSPECIFIED_NODE_NAMESPACE)
        return all(part not in self.node_name for part in unspecified)

    # --- execution ------------------------------------------------------------------------------------------

    def execute(self, context: LaunchContext) -> list[Any] | None:
        """Start the node.

        Raises:
            DescriptionError: a parameter is a model with errors.
            LinkwrightError: any other error of the node's description or executable.
        """
        if context.is_shutdown:
            return None
        package = None if self.__package is None else _text(context, self.__package)
        executable = _text(context, self.__node_executable)
        self.hosted = is_hosted(package, executable) and self._may_be_hosted(context, package, executable)
        self.__forget()
        self._perform_substitutions(context)
        added = self.__extended(context)
        if self.hosted:
            assert package is not None
            process_name = self._host(context, package, executable, added)
        else:
            self.cmd.extend(normalize_to_list_of_substitutions(word) for word in added)
            process_name = self._run(context, package, executable)
        if self.is_node_name_fully_specified():
            remark = record_node_start(context, self.node_name)
            if remark is not None:
                context.session.log.warning_line(process_name, remark)
        return None

    def __extended(self, context: LaunchContext) -> list[Any]:
        """Run the extensions, which may change the name and namespace.

        Returns:
            The arguments that the extensions add to the command line.
        """
        added: list[Any] = []
        given: dict[str, Any] = {}
        if self.__node_name is not None:
            given["name"] = f"__node:={self.__expanded_node_name}"
        if self.__expanded_node_namespace != self.UNSPECIFIED_NODE_NAMESPACE:
            given["ns"] = f"__ns:={self.__expanded_node_namespace}"
        for extension in node_extensions():
            words, given = extension.prepare_for_execute(context, given, self)
            added += words
        self.__expanded_node_name = given.get("name", self.__expanded_node_name).removeprefix("__node:=")
        self.__expanded_node_namespace = given.get("ns", self.__expanded_node_namespace).removeprefix("__ns:=")
        return added

    def viewer_config(self, context: LaunchContext) -> Callable[[], RvizConfig] | None:
        """Return a factory of the viewer's configuration; None if the command line determines it."""
        return None

    def _perform_substitutions(self, context: LaunchContext) -> None:
        """Evaluate the name, namespace, parameters and remappings, and complete the command line."""
        if self.__substitutions_performed:
            return
        try:
            self._expand_names(context)
        except LinkwrightError as error:
            raise located(error, self.place) from error
        scope = scope_parameters(context.launch_configurations.get(PARAMETERS) or (), context)
        own = own_parameters(self.__parameters, context).without_missing_files(context, self.place)
        self.__node_parameters = NodeParameters([*scope.sources, *own.sources])
        try:
            self.__node_parameters.check(context, self.__name_in_files(context), self.place)
        except LinkwrightError as error:
            raise located(error, self.place) from error
        self.__scope_count = len(scope.sources)
        self.__scratch_folder = _scratch_folder(context)
        rules = [
            *(context.launch_configurations.get(REMAPPINGS) or ()),
            *evaluate_rules(context, self.__remappings),
        ]
        self.__expanded_remappings = rules or None
        if not self.hosted:
            self.__extend_command()
        self.__substitutions_performed = True

    def __forget(self) -> None:
        """Reset the results of an earlier execution.

        The action is executed again after a robot description that it needs was fixed.
        """
        del self.cmd[self.__fixed_words :]
        self.__substitutions_performed = False
        self.__expanded_node_name = self.UNSPECIFIED_NODE_NAME
        self.__expanded_node_namespace = self.UNSPECIFIED_NODE_NAMESPACE
        self.__final_node_name = None
        self.__node_parameters = NodeParameters()
        self.__scope_count = 0
        self.__scratch_folder = None
        self.__parameter_words = None
        self.__expanded_remappings = None

    def _expand_names(self, context: LaunchContext) -> None:
        """Evaluate the name and namespace."""
        if self.__node_name is not None:
            self.__expanded_node_name = check_name(_text(context, self.__node_name))
        own = None if self.__node_namespace is None else _text(context, self.__node_namespace)
        namespace = make_namespace_absolute(prefix_namespace(context.launch_configurations.get(NAMESPACE), own))
        if namespace is not None:
            self.__expanded_node_namespace = check_namespace(namespace)
        self.__final_node_name = f"{self.__expanded_node_namespace.rstrip('/')}/{self.__expanded_node_name}"

    def __name_in_files(self, context: LaunchContext) -> str | None:
        """Return the full name by which parameter files refer to the node.

        The result is None if the name is not given and only the program knows it. It is also None for a container,
        because the files may apply to other nodes that the container runs.
        """
        package = None if self.__package is None else _text(context, self.__package)
        if self.__node_name is None or package == _CONTAINERS:
            return None
        namespace = self.__expanded_node_namespace
        above = "" if namespace == self.UNSPECIFIED_NODE_NAMESPACE else namespace.rstrip("/")
        return f"{above}/{self.__expanded_node_name}"

    @property
    def __expanded_parameter_arguments(self) -> list[tuple[str, bool]]:
        """The parameter arguments of the command line, each with whether it is the path of a file.

        Files for dictionaries are written on first access. As in launch_ros, the parameters of the scope are included
        only if they are files.
        """
        if self.__parameter_words is None:
            folder = self.__scratch_folder if self.__scratch_folder and self.__scratch_folder.is_dir() else None
            node = self.node_name if self.is_node_name_fully_specified() else None
            self.__parameter_words = self.__node_parameters.arguments(node, folder)
        scope = self.__parameter_words[: self.__scope_count]
        return [*(argument for argument in scope if argument[1]), *self.__parameter_words[self.__scope_count :]]

    def __extend_command(self) -> None:
        words: list[Any] = []
        if self.__expanded_node_namespace != self.UNSPECIFIED_NODE_NAMESPACE:
            words += ["-r", _DeferredArgument("ns", lambda: f"__ns:={self.__expanded_node_namespace}")]
        _ = self.__expanded_parameter_arguments
        for argument, is_file in self.__parameter_words or ():
            words += ["--params-file" if is_file else "-p", argument]
        for source, target in self.__expanded_remappings or ():
            words += ["-r", f"{source}:={target}"]
        self.cmd.extend(normalize_to_list_of_substitutions(word) for word in words)

    # --- in the launcher's process ----------------------------------------------------------------------------

    def _may_be_hosted(self, context: LaunchContext, package: str | None, executable: str) -> bool:
        """Return whether the node can run in the launcher's process."""
        if is_viewer(package, executable):
            return True
        if context.session.isolates_nodes or self.__own_environment[0] is not None:
            return False
        names = (_text(context, name) for name in self.__own_environment[1] or ())
        if any(_OF_A_PROCESS.match(name) for name in names):
            return False
        return not self.process_description.prefix_words(context, [executable])

    def _host(self, context: LaunchContext, package: str, executable: str, added: Sequence[Any]) -> str:
        from linkwright.nodes.options import default_name

        session = context.session
        namespace = self.__expanded_node_namespace
        namespace = "/" if namespace == self.UNSPECIFIED_NODE_NAMESPACE else namespace
        name = None if self.__node_name is None else self.__expanded_node_name
        arguments = [_text(context, word) for word in _listed(self.__arguments)]
        if self.__ros_arguments is not None:
            arguments += ["--ros-args", *(_text(context, word) for word in _listed(self.__ros_arguments))]
        arguments += [_text(context, word) for word in added]
        base_name = self.process_description.base_name(context, [executable])
        own_name = name or default_name(package, executable)
        full_name = f"{namespace.rstrip('/')}/{own_name or executable}"
        if (
            name is None and own_name is not None and package != _CONTAINERS
        ):  # other nodes were checked before, or cannot be checked
            self.__node_parameters.check(context, full_name, self.place)
        plan = HostedPlan(
            self,
            session.number_process(base_name),
            package,
            executable,
            name,
            namespace,
            without_skipped_nodes(context, package, self.__node_parameters.values(context, full_name)),
            self.__expanded_remappings or [],
            arguments,
            self.viewer_config(context),
            destinations=self._destinations(context),
            respawns=self._respawn_max_retries if self._typed(context, "respawn", self._respawn) else 0,
            respawn_delay=self._respawn_delay or 0.0,
            for_others=self.__node_parameters.rules(context),
        )
        self.process_description.final_name = plan.process_name
        self.process_description.final_cmd = plan.details["cmd"]
        session.host.plan(plan)
        return plan.process_name

    # --- in a separate process --------------------------------------------------------------------------------

    def _run(self, context: LaunchContext, package: str | None, executable: str) -> str:
        arguments = [perform_substitutions(context, word) for word in self.cmd[1:]]
        return self._start(context, [*self._program(context, package, executable), *arguments])

    def _program(self, context: LaunchContext, package: str | None, executable: str) -> list[str]:
        if package is None:
            return [executable]
        try:
            return self._executable(context.session.finder, package, executable).command
        except LinkwrightError as error:
            if is_unavailable(error):
                record_skipped_node(context, executable if self.__node_name is None else self.__expanded_node_name)
            raise located(error, self.place) from error

    def _executable(self, finder: PackageFinder, package: str, executable: str) -> Executable:
        return find_executable(finder, package, executable)

    def _plan(self, context: LaunchContext, command: list[str]) -> ProcessPlan:
        plan = super()._plan(context, command)
        if self.process_description.name is not None:
            return plan
        # The executable's name is the process's name, even if an interpreter runs it or the node is one of
        # Linkwright's.
        return replace(plan, name=Path(_text(context, self.__node_executable)).name)

    def _environment(self, context: LaunchContext) -> dict[str, str]:
        return workspace_environment(context.session.finder, super()._environment(context))


class _DeferredArgument(Substitution):
    """A command-line argument that is known only when the action starts the node.

    Args:
        what: the name of the argument in listings.
        word: the function that returns the argument.
    """

    def __init__(self, what: str, word: Callable[[], str]) -> None:
        self._what = what
        self._word = word

    def describe(self) -> str:
        """Return a text with the name of the argument."""
        return f"LocalVar('ros_specific_arguments['{self._what}']')"

    def perform(self, context: LaunchContext) -> str:
        """Return the argument."""
        return self._word()


def _listed(values: Any) -> list[Any]:
    """Return one or several arguments as a list, which is empty for None."""
    if values is None:
        return []
    return [values] if isinstance(values, (str, Substitution)) or not isinstance(values, Iterable) else list(values)


def _text(context: LaunchContext, value: Any) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))


def _scratch_folder(context: LaunchContext) -> Path | None:
    try:
        return context.session.scratch_folder
    except (AttributeError, RuntimeError):  # no launch is running in this context
        return None
