"""Starting ROS nodes."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.actions.execute import ExecuteProcess
from linkwright.launch.context import LaunchContext
from linkwright.launch.engine.hosted_plan import HostedPlan, is_hosted
from linkwright.launch.places import error_at, located
from linkwright.launch.ros.executables import find_executable
from linkwright.launch.ros.parameters import EvaluatedParameters, check_parameters, evaluate_parameters
from linkwright.launch.ros.scoping import NAMESPACE, PARAMETERS, REMAPPINGS, joined_namespace
from linkwright.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from linkwright.viewer import RvizConfig


class Node(ExecuteProcess):
    """Starts a node: one of ours in the launcher's process, any other as a process of its own.

    Args:
        executable: its executable in the package, or a program where no package is named.
        package: the package.
        name: the name it is given.
        namespace: where it lives, inside the namespaces of `PushRosNamespace` unless it starts with a slash.
        exec_name: its name in the log.
        parameters: dictionaries, paths of YAML files, `ParameterFile` and `Parameter` objects; later ones
        win. remappings: pairs of names. ros_arguments: further arguments after ``--ros-args``. arguments: its
        command line. kwargs: see `ExecuteProcess`.
    """

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
        super().__init__(cmd=[executable], name=exec_name, **kwargs)
        self._executable = normalize_to_list_of_substitutions(executable)
        self._package = None if package is None else normalize_to_list_of_substitutions(package)
        self._node_name = None if name is None else normalize_to_list_of_substitutions(name)
        self._namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self._parameters = [] if parameters is None else check_parameters(parameters, self.place)
        self._remappings = [
            (normalize_to_list_of_substitutions(source), normalize_to_list_of_substitutions(target))
            for source, target in remappings or ()
        ]
        self._ros_arguments = _listed(ros_arguments)
        self._arguments = _listed(arguments)
        self._full_name: str | None = None
        self.hosted = False

    @property
    def node_package(self) -> list[Substitution] | None:
        """The package, as substitutions."""
        return self._package

    @property
    def node_executable(self) -> list[Substitution]:
        """The executable, as substitutions."""
        return self._executable

    @property
    def node_name(self) -> str:
        """The full name of the node once it is started."""
        if self._full_name is None:
            raise RuntimeError("the name of a node is not known before it is started")
        return self._full_name

    def execute(self, context: LaunchContext) -> None:
        """Start it.

        Raises:
            DescriptionError: a parameter is a model that is wrong.
            LinkwrightError: what else is wrong with it.
        """
        if context.is_shutdown:
            return
        package = None if self._package is None else perform_substitutions(context, self._package)
        executable = perform_substitutions(context, self._executable)
        self.hosted = is_hosted(package, executable)
        name = None if self._node_name is None else perform_substitutions(context, self._node_name)
        namespace = self._evaluated_namespace(context)
        self._full_name = f"{namespace.rstrip('/')}/{name or executable}"
        parameters = evaluate_parameters(
            context,
            [*context.launch_configurations.get(PARAMETERS, ()), *self._parameters],
            self._full_name,
            self.place,
        )
        remappings = [
            *context.launch_configurations.get(REMAPPINGS, ()),
            *(
                (perform_substitutions(context, source), perform_substitutions(context, target))
                for source, target in self._remappings
            ),
        ]
        arguments = [perform_substitutions(context, each) for each in self._arguments]
        ros_arguments = [perform_substitutions(context, each) for each in self._ros_arguments]
        session = context.session
        if self.hosted:
            assert package is not None
            if ros_arguments:
                arguments = [*arguments, "--ros-args", *ros_arguments]
            base_name = executable if self._name is None else perform_substitutions(context, self._name)
            session.host.plan(
                HostedPlan(
                    self,
                    session.number_process(base_name),
                    package,
                    executable,
                    name,
                    namespace,
                    parameters.values,
                    remappings,
                    arguments,
                    self.viewer_config(context),
                )
            )
            return
        command = [self._program(context, package, executable), *arguments]
        command += _ros_arguments(name, namespace, parameters, remappings, ros_arguments, session.scratch_folder)
        self._start(context, command)

    def viewer_config(self, context: LaunchContext) -> Callable[[], RvizConfig] | None:  # noqa: ARG002
        """What makes the configuration of a viewer; None has its command line say which."""
        return None

    def _program(self, context: LaunchContext, package: str | None, executable: str) -> str:
        if package is None:
            return executable
        try:
            return str(find_executable(context.session.finder, package, executable))
        except LinkwrightError as error:
            raise located(error, self.place) from error

    def _evaluated_namespace(self, context: LaunchContext) -> str:
        outer = str(context.launch_configurations.get(NAMESPACE, ""))
        own = "" if self._namespace is None else perform_substitutions(context, self._namespace)
        namespace = joined_namespace(outer, own)
        if " " in namespace:
            raise error_at(self.place, "LAUNCH134", f"namespace '{namespace}' has a blank in it")
        return namespace


def _listed(values: Iterable[SomeSubstitutionsType] | None) -> list[list[Substitution]]:
    if values is None:
        return []
    if isinstance(values, (str, Substitution)):
        values = [values]
    return [normalize_to_list_of_substitutions(value) for value in values]


def _ros_arguments(
    name: str | None,
    namespace: str,
    parameters: EvaluatedParameters,
    remappings: list[tuple[str, str]],
    further: list[str],
    scratch_folder: Path,
) -> list[str]:
    """The command line that tells a node of another process what it is to be."""
    words: list[str] = []
    if name is not None:
        words += ["-r", f"__node:={name}"]
    if namespace != "/":
        words += ["-r", f"__ns:={namespace}"]
    for source in parameters.sources:
        path = source if isinstance(source, Path) else _written(source, scratch_folder)
        words += ["--params-file", str(path)]
    for pair in remappings:
        words += ["-r", ":=".join(pair)]
    words += further
    return ["--ros-args", *words] if words else []


def _written(parameters: dict[str, Any], folder: Path) -> Path:
    """A parameter file with these values for any node."""
    import tempfile

    import yaml

    descriptor, path = tempfile.mkstemp(prefix="launch_params_", suffix=".yaml", dir=folder)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        yaml.safe_dump({"/**": {"ros__parameters": parameters}}, file, default_flow_style=False)
    return Path(path)
