"""The parameters of a node.

They come, in increasing order of precedence, from the scope of the node and from its own list of files and values.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Severity,
    did_you_mean,
    display_path,
    joined,
    missing_file_hint,
    phrase,
)
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.launch.errors.locations import SourceLocation
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.ros.parameter_files import ParameterFile
from linkwright.launch.ros.parameter_lists import evaluate_parameters
from linkwright.launch.ros.parameter_values import Parameter

ANY_NODE = "/**"


@dataclass(frozen=True)
class FileSource:
    """A parameter file of a node.

    Attributes:
        file: the file that this process reads.
        path: the path of the file that is passed to other processes.
    """

    file: ParameterFile
    path: Path


@dataclass
class NodeParameters:
    """The parameters of a node, from several sources.

    Attributes:
        sources: files, dictionaries of values, and pairs ``(name, value)``. Later sources take precedence.
    """

    sources: list[FileSource | dict[str, Any] | tuple[str, Any]] = field(default_factory=list)

    def without_missing_files(self, context: LaunchContext, location: SourceLocation | None) -> NodeParameters:
        """Return the parameters without missing files, and warn about each missing file.

        launch_ros also ignores files that do not exist.

        Args:
            context: the launch context, which receives the warnings (LAUNCH133).
            location: the location of the node, for the warnings; None if it is unknown.
        """
        node_parameters = NodeParameters()
        for source in self.sources:
            if isinstance(source, FileSource) and not source.path.is_file():
                message = phrase("parameter file '{path}' does not exist", path=display_path(source.path))
                _warn(context, "LAUNCH133", message, missing_file_hint(source.path), location)
            else:
                node_parameters.sources.append(source)
        return node_parameters

    def check(self, context: LaunchContext, node: str | None, location: SourceLocation | None) -> None:
        """Report errors and warnings about the files before the node reads them.

        Args:
            context: the context of the launch, for warnings about files without parameters for the node (LAUNCH149) and
                about skipped parameters (GRAPH212).
            node: the node's full name; None if it is not known.
            location: the location of the node, for the warnings; None if it is unknown.

        Raises:
            LinkwrightError: LAUNCH133 or GRAPH212, a file has errors.
        """
        for source in self.sources:
            if not isinstance(source, FileSource):
                continue
            rules = source.file.read_rules(context)
            all_findings = [finding for _, finding in rules.skipped_findings]
            for finding in rules.skipped_findings_for(node) if node else all_findings:
                context.warn(finding)
            if node is None or not rules or rules.matches_node(node):
                continue
            names = rules.patterns
            message = phrase(
                "parameter file '{path}' has no section for node '{node}'", path=display_path(source.path), node=node
            )
            hint = did_you_mean(node, names) or phrase("the file has sections for {names}", names=joined(names))
            _warn(context, "LAUNCH149", message, hint, location)

    def values(self, context: LaunchContext, node: str) -> dict[str, Any]:
        """Return the values of the parameters by name, for a node in this process.

        Args:
            context: the launch context, for files that are not evaluated yet.
            node: the full name of the node, which selects the values in files.

        Raises:
            LinkwrightError: LAUNCH133 or GRAPH212, a file has errors.
        """
        values_by_name: dict[str, Any] = {}
        for source in self.sources:
            if isinstance(source, FileSource):
                values_by_name.update(source.file.read_rules(context).for_node(node))
            elif isinstance(source, tuple):
                values_by_name[source[0]] = source[1]
            else:
                values_by_name.update(source)
        return {name: list(value) if isinstance(value, tuple) else value for name, value in values_by_name.items()}

    def read_rules(self, context: LaunchContext) -> ParameterRules:
        """Return the rules in the files, including the rules for other nodes of the process.

        Args:
            context: the launch context, for files that are not evaluated yet.

        Raises:
            LinkwrightError: LAUNCH133 or GRAPH212, a file has errors.
        """
        rules = ParameterRules()
        for source in self.sources:
            if isinstance(source, FileSource):
                rules.add(source.file.read_rules(context))
        return rules

    def create_arguments(self, node: str | None, folder: Path | None) -> list[tuple[str, bool]]:
        """Return the command-line arguments that pass the parameters to another process.

        Args:
            node: the full name of the node; None if it is unknown.
            folder: the folder for files with the values of dictionaries; None for the system's temporary folder.

        Returns:
            Pairs of an argument and whether it is the path of a file. Otherwise, it is a rule ``name:=value``.
        """
        arguments: list[tuple[str, bool]] = []
        for source in self.sources:
            if isinstance(source, FileSource):
                arguments.append((str(source.path), True))
            elif isinstance(source, tuple):
                arguments.append((format_rule(*source), False))
            else:
                arguments.append((write_parameter_file(source, node, folder), True))
        return arguments


def _warn(
    context: LaunchContext, code: str, message: Phrase, hint: Phrase | None, location: SourceLocation | None
) -> None:
    source = location.source() if location else None
    span = location.span(source) if location else None
    context.warn(Diagnostic(code, message, span, severity=Severity.WARNING, hint=hint, source=source))


def is_malformed_file(error: LinkwrightError) -> bool:
    """Return whether an error reports that the content of a parameter file is not in the form of such files."""
    return any(diagnostic.code == "GRAPH212" for diagnostic in error.diagnostics)


def evaluate_scope_parameters(items: Iterable[Any], context: LaunchContext) -> NodeParameters:
    """Return the parameters that `SetParameter` and `SetParametersFromFile` set in a scope."""
    node_parameters = NodeParameters()
    for item in items:
        if isinstance(item, tuple):
            node_parameters.sources.append(item)
        else:
            file = item if isinstance(item, ParameterFile) else ParameterFile(item)
            node_parameters.sources.append(FileSource(file, Path(os.path.abspath(file.evaluate(context)))))  # noqa: PTH100
    return node_parameters


def evaluate_own_parameters(normalized: Sequence[Any], context: LaunchContext) -> NodeParameters:
    """Evaluate the normalized parameters of a node, and return them.

    See `normalize_parameters`.

    Raises:
        LinkwrightError: LAUNCH132 or LAUNCH133, a value or a file has errors.
    """
    node_parameters = NodeParameters()
    for item, evaluated in zip(normalized, evaluate_parameters(context, normalized), strict=True):
        if isinstance(evaluated, Parameter):
            node_parameters.sources.append(evaluated.evaluate(context))
        elif isinstance(evaluated, Path):
            file = item if isinstance(item, ParameterFile) else ParameterFile(evaluated)
            node_parameters.sources.append(FileSource(file, evaluated))
        else:
            node_parameters.sources.append(evaluated)
    return node_parameters


def format_rule(name: str, value: Any) -> str:
    """Return a parameter for the command line in the form ``name:=value``.

    The value is written as YAML.
    """
    import yaml

    value = list(value) if isinstance(value, tuple) else value
    text = yaml.safe_dump(value, default_flow_style=True, width=float("inf"), allow_unicode=True)
    return f"{name}:={text.removesuffix(chr(10)).removesuffix(chr(10) + '...')}"


def write_parameter_file(parameters: dict[str, Any], node: str | None, folder: Path | None) -> str:
    """Write the parameter values of a node to a new file, and return the path of the file.

    If the name of the node is unknown, the values apply to all nodes that read the file.
    """
    import tempfile

    import yaml

    plain_values = {str(name): str(value) if isinstance(value, str) else value for name, value in parameters.items()}
    descriptor, path = tempfile.mkstemp(prefix="launch_params_", suffix=".yaml", dir=folder)
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        # Tuples are tagged as tuples, as in launch_ros. Readers of parameter files ignore the tags.
        yaml.dump({node or ANY_NODE: {"ros__parameters": plain_values}}, file, default_flow_style=False)
    return path
