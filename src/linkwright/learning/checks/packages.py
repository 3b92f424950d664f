"""Files and packages of the learner's workspace, as checks see them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path, PurePosixPath

from linkwright.descriptions import examine
from linkwright.diagnostics import LinkwrightError, Severity, did_you_mean, phrase, quoted_names
from linkwright.learning.checks.findings import describe_finding
from linkwright.learning.checks.installed import files_of_setup
from linkwright.learning.checks.launched import LaunchCheck
from linkwright.learning.checks.not_yet import NotYet
from linkwright.learning.checks.programs import find_program
from linkwright.learning.checks.robots import RobotCheck
from linkwright.packages import PackageFinder
from linkwright.xacro import expand
from linkwright.xmltree import Element, Overlay, parse_file
from linkwright.xmltree.positions import attribute_value_range


class FileFolder:
    """A folder of the learner's files.

    Attributes:
        folder: the folder.
        finder: the finder of the workspace's packages.
    """

    def __init__(self, folder: Path, finder: PackageFinder) -> None:
        self.folder = folder
        self.finder = finder
        self._robots: dict[tuple[str, tuple[tuple[str, str], ...]], RobotCheck] = {}

    def file(self, name: str) -> Path:
        """Return a file of the folder.

        Args:
            name: the path in the folder, such as ``urdf/mbot_base.urdf``.

        Raises:
            NotYet: there is no such file.
        """
        path = self.folder / name
        if path.is_file():
            if path.stat().st_size == 0:
                raise NotYet(phrase("the file '{name}' is empty", name=name))
            return path
        others = [
            other.relative_to(self.folder).as_posix()
            for other in self.folder.rglob(f"*{path.suffix}")
            if other.is_file()
        ]
        suggestion = did_you_mean(name, others)
        if others and suggestion is not None:
            raise NotYet(
                phrase(
                    "'{folder}' has no file '{name}'; it has {others}",
                    folder=self.folder.name,
                    name=name,
                    others=quoted_names(others[:3]),
                )
            )
        raise NotYet(phrase("'{folder}' has no file '{name}'", folder=self.folder.name, name=name))

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
        """Return the robot of a xacro file as it would be with another value of a property.

        The files stay as they are.

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
            overlay = _with_property(source, property_name, value)
            if overlay is not None:
                return self._read_robot(path, {}, overlay)
        raise NotYet(phrase("no file sets the property '{name}'", name=property_name))

    def source_elements(self, name: str, tag: str) -> list[Element]:
        """Return the elements with a tag in a file and in the files that it includes, before expansion.

        Raises:
            NotYet: the file is missing or not valid.
        """
        path = self.file(name)
        self.robot(name)
        sources = expand(path, packages=self.finder).dependencies
        return [
            element
            for source in sources
            if source.suffix in _XML_SUFFIXES
            for element in parse_file(source).root.walk()
            if element.tag == tag
        ]

    def _read_robot(self, path: Path, arguments: Mapping[str, str], overlay: Overlay | None = None) -> RobotCheck:
        try:
            description = examine(path, arguments=arguments, packages=self.finder, overlay=overlay)
        except LinkwrightError as error:
            raise NotYet(describe_finding(error.diagnostics[0])) from None
        errors = [finding for finding in description.diagnostics if finding.severity is Severity.ERROR]
        if errors or description.robot is None:
            raise NotYet(describe_finding(errors[0]))
        return RobotCheck(description.robot, path)

    def expect_no_findings(self, name: str = "") -> None:
        """Require that ``linkwright check`` finds no mistakes in a file, or in the whole folder.

        Raises:
            NotYet: there is a warning, an error, or a launch file uses a package that ``package.xml`` does not list.
        """
        from linkwright.lint.checking import Checker
        from linkwright.lint.targets import find_targets

        path = self.file(name) if name else self.folder
        try:
            findings, _ = Checker().check(find_targets([path]), [path])
        except LinkwrightError as error:
            findings = list(error.diagnostics)
        serious = [
            finding for finding in findings if finding.severity is not Severity.INFO or finding.code in _MISTAKES
        ]
        if serious:
            raise NotYet(describe_finding(serious[0]))


_MISTAKES = frozenset({"LW848"})
"""Findings of the level info that fail a step: the package does not run on a computer that has only what it lists.

Other findings of this level are advice, which a right solution may ignore.
"""

_XML_SUFFIXES = {".xacro", ".urdf", ".xml"}


def _with_property(source: Path, name: str, value: str) -> Overlay | None:
    """Return a file's text with another value of a property, or None if the file does not set it."""
    if source.suffix not in _XML_SUFFIXES:
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
        name: the name.
        folder: the folder with its sources.
        finder: the finder of the workspace's packages.
    """

    def __init__(self, name: str, folder: Path, finder: PackageFinder) -> None:
        super().__init__(folder, finder)
        self.name = name

    def expect_installed(self, *names: str) -> None:
        """Require that ``setup.py`` installs files, each in the package's share folder at its path in the package.

        Args:
            names: the paths in the package, such as ``launch/display.launch.py``.

        Raises:
            NotYet: ``setup.py`` fails, or does not install one of the files there.
        """
        installed = files_of_setup(self.folder)
        for name in names:
            place = PurePosixPath("share", self.name, name)
            source = installed.get(place)
            if source is None or not source.is_file():
                raise NotYet(phrase("setup.py does not install '{name}' in '{folder}'", name=name, folder=place.parent))

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
