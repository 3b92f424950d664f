"""Access of checks to the files and packages of the learner's workspace."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from functools import partial
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

import yaml

from linkwright.descriptions import examine
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Severity, did_you_mean, phrase
from linkwright.learning.checks.findings import add_hint, describe_error, describe_finding
from linkwright.learning.checks.installed_files import list_setup_files
from linkwright.learning.checks.launch_check import LaunchCheck
from linkwright.learning.checks.misplaced_elements import XML_SUFFIXES, describe_unread, explain_missing
from linkwright.learning.checks.missing_files import describe_missing_file
from linkwright.learning.checks.not_yet import NotYet
from linkwright.learning.checks.programs import find_program
from linkwright.learning.checks.robots import RobotCheck
from linkwright.packages import PackageFinder
from linkwright.xacro import expand
from linkwright.xmltree import Element, Overlay, parse_file
from linkwright.xmltree.positions import attribute_value_range

if TYPE_CHECKING:
    from linkwright.testing import SteppedSimulation


class FileFolder:
    """A folder of the learner's files.

    Attributes:
        folder: the path of the folder.
        finder: the finder of the workspace's packages.
        workspace: the learner's workspace.
    """

    def __init__(self, folder: Path, finder: PackageFinder, workspace: Path | None = None) -> None:
        self.folder = folder
        self.finder = finder
        self.workspace = folder if workspace is None else workspace
        self._robots: dict[tuple[str, tuple[tuple[str, str], ...]], RobotCheck] = {}

    def file(self, name: str) -> Path:
        """Return the path of a file in the folder.

        Args:
            name: the path in the folder, such as ``urdf/mbot_base.urdf``.

        Raises:
            NotYet: the file is missing or empty.
        """
        path = self.folder / name
        if path.is_file():
            if not path.read_bytes().strip():
                raise NotYet(phrase("the file '{name}' is empty", name=name))
            return path
        raise NotYet(describe_missing_file(self.folder, name, self.workspace))

    def robot(self, name: str, **arguments: str) -> RobotCheck:
        """Return the robot of a URDF or xacro file.

        Args:
            name: the path in the folder.
            arguments: the xacro arguments.

        Raises:
            NotYet: the file is missing, or is not a valid description.
        """
        key = name, tuple(sorted(arguments.items()))
        if key not in self._robots:
            self._robots[key] = self._read_robot(self.file(name), arguments)
        return self._robots[key]

    def robot_with_property(self, name: str, property_name: str, value: str) -> RobotCheck:
        """Return the robot of a xacro file with another value of a property.

        The files do not change.

        Args:
            name: the path in the folder.
            property_name: the name of the property, which the file or an included file sets.
            value: the other value.

        Raises:
            NotYet: the file is missing or not valid, or no file sets the property.
        """
        path = self.file(name)
        self.robot(name)
        for source in expand(path, packages=self.finder).dependencies:
            overlay = _overlay_property(source, property_name, value)
            if overlay is not None:
                circumstance = phrase("when the check sets {name} to {value}", name=property_name, value=value)
                return self._read_robot(path, {}, overlay, circumstance)
        names = [element.attributes.get("name", "") for element in self.source_elements(name, "xacro:property")]
        message = phrase("no file sets the property '{name}'", name=property_name)
        raise NotYet(add_hint(message, did_you_mean(property_name, names)))

    def source_elements(self, name: str, tag: str) -> list[Element]:
        """Return the elements with a tag in a file and its included files, before expansion.

        Raises:
            NotYet: the file is missing or not valid.
        """
        path = self.file(name)
        self.robot(name)
        sources = expand(path, packages=self.finder).dependencies
        return [
            element
            for source in sources
            if source.suffix in XML_SUFFIXES
            for element in parse_file(source).root.walk()
            if element.tag == tag
        ]

    def _read_robot(
        self,
        path: Path,
        arguments: Mapping[str, str],
        overlay: Overlay | None = None,
        circumstance: Phrase | None = None,
    ) -> RobotCheck:
        try:
            description = examine(path, arguments=arguments, packages=self.finder, overlay=overlay)
        except LinkwrightError as error:
            raise NotYet(describe_error(error)) from None
        errors = [finding for finding in description.diagnostics if _is_mistake(finding)]
        if errors or description.robot is None:
            raise NotYet(describe_finding(min(errors, key=lambda finding: finding.code not in _CAUSE_CODES)))
        if arguments:
            argument_text = " ".join(f"{key}:={value}" for key, value in arguments.items())
            circumstance = phrase("with {arguments}", arguments=argument_text)
        return RobotCheck(
            description.robot,
            path,
            circumstance=circumstance,
            explain_missing=partial(explain_missing, path, self.finder),
            explain_unread=partial(describe_unread, path),
        )

    def simulate(self, name: str) -> AbstractContextManager[SteppedSimulation]:
        """Return a simulation of a file's robot in an empty world.

        Missing elements are added, as ``linkwright drive`` does.

        Args:
            name: the path in the folder.

        Raises:
            NotYet: the file is missing or not valid; or, at the start of the simulation, the robot cannot be driven.
        """
        from linkwright.learning.checks.completed_robot import simulate_completed

        self.robot(name)
        return simulate_completed(self.file(name), self.finder)

    def yaml(self, name: str) -> Any:
        """Return the data of a YAML file.

        Args:
            name: the path in the folder.

        Raises:
            NotYet: the file is missing, or is not YAML.
        """
        from linkwright.files.yaml_documents import YamlDocument, read_source

        try:
            document = YamlDocument(read_source(self.file(name), phrase("file"), "LEARN117"), "LEARN117")
        except LinkwrightError as error:
            raise NotYet(describe_error(error)) from None
        return None if document.root is None else yaml.constructor.SafeConstructor().construct_document(document.root)

    def expect_no_findings(self, name: str = "") -> None:
        """Require that ``linkwright check`` finds no errors or warnings in a file or the folder.

        Raises:
            NotYet: there is an error or a warning, or ``package.xml`` does not list a package that a launch file uses.
        """
        from linkwright.lint.checking import Checker
        from linkwright.lint.targets import find_targets

        path = self.file(name) if name else self.folder
        try:
            findings, _ = Checker().check(find_targets([path]), [path])
        except LinkwrightError as error:
            findings = list(error.diagnostics)
        serious = [
            finding for finding in findings if finding.severity is not Severity.INFO or finding.code in _MISTAKE_CODES
        ]
        if serious:
            raise NotYet(describe_finding(serious[0]))


_MISTAKE_CODES = frozenset({"LW848"})
"""Findings of the level info that fail a step: the package does not run on a computer that has only what it lists.

Other findings of this level are advice, which a right solution may ignore.
"""

_RUN_TIME_TAGS = {"depend", "exec_depend"}
_UNDEFINED_MATERIAL_CODE = "URDF160"
_CAUSE_CODES = {"URDF110", "URDF151"}
"""Findings to report first: a name or a child that is written twice is also missing where it belongs."""


def _is_mistake(finding: Diagnostic) -> bool:
    """Return whether any reader of XML or URDF rejects a file because of a finding.

    urdfdom may still accept the file.
    """
    if finding.severity is Severity.ERROR:
        return True
    return finding.code.startswith("XML") or finding.code == _UNDEFINED_MATERIAL_CODE


def _overlay_property(source: Path, name: str, value: str) -> Overlay | None:
    """Return a file's text with another value of a property, or None if the file has none."""
    if source.suffix not in XML_SUFFIXES:
        return None
    document = parse_file(source)
    text = source.read_text(encoding="utf-8")
    for element in document.root.walk():
        if element.tag == "xacro:property" and element.attributes.get("name") == name:
            span = attribute_value_range(text, element.offset, "value")
            if span is not None:
                return Overlay({source: text[: span[0]] + value + text[span[1] :]})
    return None


class PackageCheck(FileFolder):
    """A package of the learner's workspace.

    Attributes:
        name: the name of the package.
        folder: the folder with its sources.
        finder: the finder of the workspace's packages.
        workspace: the learner's workspace.
    """

    def __init__(self, name: str, folder: Path, finder: PackageFinder, workspace: Path | None = None) -> None:
        super().__init__(folder, finder, workspace)
        self.name = name

    def expect_manifest(self) -> None:
        """Require ``package.xml`` to be well-formed XML with a package name.

        Raises:
            NotYet: the file is not well-formed, or has no package name.
        """
        try:
            parse_file(self.file("package.xml"))
        except LinkwrightError as error:
            raise NotYet(describe_error(error)) from None

    def expect_dependencies(self, *names: str) -> None:
        """Require ``package.xml`` to list packages as dependencies at run time.

        Raises:
            NotYet: the file is not well-formed, or does not list one of the packages in a fitting element.
        """
        self.expect_manifest()
        root = parse_file(self.folder / "package.xml").root
        at_run_time = {child.text().strip() for child in root.elements() if child.tag in _RUN_TIME_TAGS}
        for name in sorted(set(names) - at_run_time):
            other = next((element for element in root.walk() if element.text().strip() == name), None)
            if other is None:
                raise NotYet(
                    phrase(
                        "package.xml does not list '{name}' as a dependency at run time; "
                        "add <exec_depend>{name}</exec_depend>",
                        name=name,
                    )
                )
            line = other.source.position(other.offset)[0] if other.source else 1
            if other.tag in _RUN_TIME_TAGS:
                raise NotYet(
                    phrase(
                        "package.xml, line {line}: the dependency '{name}' must be directly inside <package>",
                        line=line,
                        name=name,
                    )
                )
            raise NotYet(
                phrase(
                    "package.xml does not list '{name}' as a dependency at run time; line {line} has <{tag}>, "
                    "but <exec_depend> is needed",
                    name=name,
                    line=line,
                    tag=other.tag,
                )
            )

    def expect_installed(self, *names: str) -> None:
        """Require that ``setup.py`` installs files into the package's share folder.

        Each file must keep its path in the package.

        Args:
            names: the paths in the package, such as ``launch/display.launch.py``.

        Raises:
            NotYet: ``setup.py`` fails, or does not install one of the files at its path.
        """
        installed = list_setup_files(self.folder)
        marker = PurePosixPath("share/ament_index/resource_index/packages", self.name)
        if marker not in installed:
            raise NotYet(
                phrase(
                    "setup.py does not install 'resource/{name}' in '{folder}', so ROS does not find the package",
                    name=self.name,
                    folder=marker.parent,
                )
            )
        for name in ("package.xml", *names):
            share_path = PurePosixPath("share", self.name, name)
            source = installed.get(share_path)
            if source is not None and source.is_file():
                continue
            message = phrase("setup.py does not install '{name}' in '{folder}'", name=name, folder=share_path.parent)
            other = next((path for path, file in installed.items() if file == self.folder / name), None)
            if other is None:
                raise NotYet(message)
            raise NotYet(phrase("{message}, but in '{other}'", message=message, other=other.parent))

    def program(self, name: str) -> Callable[[], object]:
        """Return an executable of the package, to be started with `SteppedGraph.start_program`.

        Args:
            name: the name of the executable in ``setup.py``.

        Raises:
            NotYet: the package declares no such executable, or has no such module.
        """
        return find_program(self.folder, self.name, name)

    def launch(self, name: str, **arguments: str) -> LaunchCheck:
        """Return a launch of the package, to be used as a context manager.

        Args:
            name: the launch file, such as ``display.launch.py``.
            arguments: the launch arguments.

        Raises:
            NotYet: there is no such launch file.
        """
        self.file(f"launch/{name}")
        return LaunchCheck(self.name, name, arguments, self.finder)
