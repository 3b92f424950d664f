"""Mark the lines about packages that a build or source needs now and that ``package.xml`` does not name."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from linkwright.diagnostics import Diagnostic, Phrase, joined, phrase
from linkwright.lint.dependencies import is_always_installed, is_covered, is_in_every_workspace
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.changes import Change, Effect, Subject, SubjectKind
from linkwright.review.launch_paths import find_launch_files
from linkwright.review.launches.programs.missing import uses_package
from linkwright.review.required_packages import is_declared
from linkwright.review.sources.names import CPP_SUFFIXES
from linkwright.review.sources.used_packages import is_python_source
from linkwright.review.users.package_lookups import drop_told_lookups
from linkwright.review.versions import Version, Versions
from linkwright.xacro.cache import read_document

_CODES = frozenset({"LW812", "LW813"})
"""The findings about such packages. They become the reason of the line about the package."""
_LAUNCH_CODE = "LW848"
"""The finding about packages that launch files use although ``package.xml`` does not name them."""
_LOADED_REASONS = frozenset(
    {
        "package.xml does not name '{name}', without which the launch file fails",
        "package.xml does not name '{name}', without which the node does not start",
        "package.xml does not name '{name}', without which the plugin is not loaded",
    }
)
"""The reasons of breaking lines about such packages."""
_ADDITIONS = (
    "packages imported for the first time: {names}",
    "packages included for the first time: {names}",
    "{kind} added: {names}",
)
_REMOVAL, _ADDITION = "{tags} removed: {packages}", "{tags} added: {packages}"
"""The sentences about dependencies that a manifest loses and gets."""
_INTERFACE_HEADER = r"^[ \t]*#[ \t]*include[ \t]*[\"<]{name}/(?:(?:msg|srv|action)/\w+\.hpp|[A-Z]\w*\.h)[\">]"
_INTERFACE_PACKAGE = re.compile(r"[a-z][a-z0-9_]*_(?:msgs|srvs|interfaces|actions)")
_OPTIONAL_INCLUDE = "__has_include"
_PYTHON_PROJECTS = {
    name: name
    for name in (
        *("flask", "mediapipe", "nmea", "networkx", "open3d", "openai", "osqp", "paho", "pandas", "pygame"),
        *("pymodbus", "pynput", "pyrealsense2", "requests", "scipy", "serial", "shapely", "smbus", "spidev"),
        *("tensorflow", "torch", "transforms3d", "ultralytics", "utm", "websocket", "websockets", "zmq"),
        *("casadi", "depthai", "dronekit", "evdev", "fastapi", "filterpy", "gpiozero", "gymnasium"),
        *("multipledispatch", "numba", "onnxruntime", "paramiko", "pigpio", "plotly"),
        *("pybullet", "pymavlink", "pynmea2", "pyproj", "pytesseract", "qpsolvers", "seaborn", "tqdm", "trimesh"),
    )
} | {"RPi": "rpi", "skimage": "scikit", "sklearn": "scikit", "smbus2": "smbus", "usb": "usb", "busio": "adafruit"}
"""Modules that no base package of ROS brings, each with a word in the names of the packages that have it."""
_ROS_MODULES = frozenset(
    {
        *("angles", "cv_bridge", "image_geometry", "laser_geometry", "moveit_commander", "ros_numpy", "tf"),
        *("sensor_msgs_py", "tf2_geometry_msgs", "tf2_sensor_msgs", "tf_conversions", "tf_transformations"),
    }
)
"""Modules of packages of ROS that its base packages do not bring."""
_LISTS = ("requirements", "dockerfile", "containerfile", "environment", "setup.", "pyproject", "pipfile", "install")
"""The beginnings of the names of other files that tell what to install."""
_SCRIPT_SUFFIX = ".sh"
_CALLER_SUFFIXES = (
    *(".py", ".cfg", ".toml", ".launch", ".xml", ".yaml", ".yml", ".sh", ".bash", ".service", ".txt", ".cmake"),
    *("Makefile", "Dockerfile"),
)
"""The endings of the names of files that can start, import or install a source."""
_TOOLS = ("ament_", "catkin", "python", "rosidl_", "launch")
"""The beginnings of the names of dependencies that bring no other packages of nodes."""


def mark_undeclared(
    versions: Versions, subjects: Sequence[Subject], findings: Sequence[Diagnostic]
) -> tuple[list[Subject], list[Diagnostic]]:
    """Return the subjects with breaking lines about undeclared packages, and the findings that no such line repeats.

    A package that only the new version has is left out: nothing depends on it yet. So is an added source in Python
    that no other file names.
    """
    told: list[Diagnostic] = []
    result = []
    for subject in subjects:
        path = subject.new_path
        if path is None or not _is_in_old_package(versions, path) or _is_new_script(versions, subject):
            result.append(subject)
            continue
        own = [finding for finding in findings if _is_about(finding, path)]
        marker = _Marker(versions.new, subject, own)
        changes = [marker.mark(change) for change in drop_told_lookups(subject.changes)]
        told += marker.told
        result.append(replace(subject, changes=changes))
    return result, [finding for finding in findings if not any(finding is other for other in told)]


def tell_missing_once(
    version: Version, subjects: Sequence[Subject], findings: Sequence[Diagnostic]
) -> tuple[list[Subject], list[Diagnostic]]:
    """Return the subjects with one breaking line about each package that is missing, and the findings that add others.

    Lines of launch files come before those of parameter files.
    """
    told: dict[tuple[str | None, str], str] = {}
    for subject in sorted(subjects, key=lambda subject: subject.kind is not SubjectKind.LAUNCH_FILE):
        for name in filter(None, map(_get_missing_package, subject.changes)):
            told.setdefault((version.package_of(subject.new_path or subject.path), name), subject.path)
    result = []
    for subject in subjects:
        folder, changes = version.package_of(subject.new_path or subject.path), list[Change]()
        for change in subject.changes:
            is_repeated = told.get((folder, _get_missing_package(change) or ""), subject.path) != subject.path
            changes.append(replace(change, effect=Effect.CHANGED, reason=None) if is_repeated else change)
        result.append(replace(subject, changes=changes))
    return result, [finding for finding in findings if not _is_told(version, finding, told)]


def _get_missing_package(change: Change) -> str | None:
    """Return the package without which a node or plugin is not loaded, if this is the reason of a line."""
    reason = change.reason
    is_missing = reason is not None and reason.template in _LOADED_REASONS
    return str(reason.arguments["name"]) if reason is not None and is_missing else None


def _is_told(version: Version, finding: Diagnostic, told: Collection[tuple[str | None, str]]) -> bool:
    """Return whether breaking lines name all packages of a finding about those that launch files use."""
    if finding.code != _LAUNCH_CODE or finding.span is None:
        return False
    names = re.findall(r"'([^']+)'", str(getattr(finding.message, "arguments", {}).get("names", "")))
    return bool(names) and all((version.package_of(finding.span.file), name) in told for name in names)


class _Marker:
    """Marks the changes of a file.

    Args:
        version: the new version.
        subject: the file.
        findings: the new findings about undeclared packages in it.
    """

    def __init__(self, version: Version, subject: Subject, findings: Sequence[Diagnostic]) -> None:
        self._version = version
        self._subject = subject
        self._findings = findings
        self.told: list[Diagnostic] = []

    def mark(self, change: Change) -> Change:
        """Return a change, with a reason if it adds an undeclared package, or removes a dependency that is used."""
        if change.sentence.template == _REMOVAL and change.effect is not Effect.BREAKING:
            reasons = list(self._find_uses(str(change.sentence.arguments["packages"])))
            return replace(change, effect=Effect.BREAKING, reason=joined(reasons, "; ")) if reasons else change
        if change.sentence.template not in _ADDITIONS or change.effect is Effect.BREAKING:
            return change
        text = str(change.sentence)
        told = [finding for finding in self._findings if f"'{_get_name(finding)}'" in text]
        names = {_get_name(finding): None for finding in told}
        if change.sentence.template != _ADDITIONS[-1]:
            names |= dict.fromkeys(self._find_undeclared(re.findall(r"'([^']+)'", text)))
        if not names:
            return change
        self.told += told
        return replace(change, effect=Effect.BREAKING, reason=self._make_reason(list(names)))

    def _find_uses(self, packages: str) -> Iterator[Phrase]:
        """Yield the removed dependencies that launch files of the package use, unless an added one may bring them."""
        if any(change.sentence.template == _ADDITION for change in self._subject.changes):
            return
        folder = self._version.package_of(self._path)
        paths = [path for path in find_launch_files(self._version) if self._version.package_of(path) == folder]
        for name in (text.partition(" (")[0] for text in packages.split(", ")):
            used = () if is_declared(self._version, name) else paths
            for path in (path for path in used if uses_package(self._version, path, name)):
                yield phrase("{path} still uses '{name}', and no package.xml names it", path=path, name=name)
                break

    def _make_reason(self, names: Sequence[str]) -> Phrase:
        text = joined([f"'{name}'" for name in names])
        if self._subject.kind is not SubjectKind.BUILD and not self._path.endswith(CPP_SUFFIXES):
            return phrase("package.xml does not name {names}, without which the import fails", names=text)
        return phrase("package.xml does not name {names}, without which the build fails", names=text)

    def _find_undeclared(self, names: Sequence[str]) -> Iterator[str]:
        """Yield the included packages of messages and the imported projects that nothing declares."""
        folder = self._version.file(self._version.package_of(self._path) or "")
        manifest = Manifest(read_document(str(folder / MANIFEST)))
        if any("$" in dependency.name for dependency in manifest.dependencies):
            return
        text = self._version.text(self._path)
        for name in names:
            if is_python_source(self._path):
                word = _PYTHON_PROJECTS.get(name)
                is_used = re.search(rf"^(?:import|from)[ \t]+{re.escape(name)}\b", text, re.MULTILINE) is not None
                if not is_used:
                    continue
                if self._is_undeclared_package(name, manifest) if word is None else not self._is_listed(word, manifest):
                    yield name
            elif _INTERFACE_PACKAGE.fullmatch(name) and _OPTIONAL_INCLUDE not in text:
                header = re.compile(_INTERFACE_HEADER.replace("{name}", name), re.MULTILINE)
                if header.search(text) and not is_covered(name, manifest, self._version.finder(folder)):
                    yield name

    def _is_listed(self, word: str, manifest: Manifest) -> bool:
        """Return whether a dependency, or a list of packages in the repository, names a project of Python."""
        names = [dependency.name.lower() for dependency in manifest.dependencies]
        return any(word in name for name in names) or word.lower() in _read_lists(self._version)

    def _is_undeclared_package(self, name: str, manifest: Manifest) -> bool:
        """Return whether a manifest certainly lacks a package that is known.

        Known are packages of ROS, of the repository, and those on which other manifests of the repository depend. A
        dependency that is not in the repository may bring the package.
        """
        own = self._version.shares
        others = [other for other in _read_manifests(self._version) if other.name != manifest.name]
        is_known = name in own or name in _ROS_MODULES
        is_known = is_known or any(dependency.name == name for other in others for dependency in other.dependencies)
        folder = self._version.file(self._version.package_of(self._path) or "")
        if not is_known or is_covered(name, manifest, self._version.finder(folder)):
            return False
        names = {dependency.name for dependency in manifest.dependencies} - own.keys()
        return all(
            _INTERFACE_PACKAGE.fullmatch(other)
            or other.startswith(_TOOLS)
            or is_always_installed(other)
            or is_in_every_workspace(other, is_ros1=manifest.is_ros1)
            for other in names
        )

    @property
    def _path(self) -> str:
        return self._subject.new_path or self._subject.path


def _read_manifests(version: Version) -> Iterator[Manifest]:
    """Yield the manifests of all packages of a repository."""
    for path in version.paths((MANIFEST,)):
        if PurePosixPath(path).name == MANIFEST:
            yield Manifest(read_document(str(version.file(path))))


def _read_lists(version: Version) -> str:
    """Return the texts of all files of a repository that tell what to install, in lower case."""
    paths = [
        path
        for path in version.paths(("",))
        if PurePosixPath(path).name.lower().startswith(_LISTS) or path.endswith(_SCRIPT_SUFFIX)
    ]
    return "\n".join(version.text(path) for path in paths).lower()


def _is_in_old_package(versions: Versions, path: str) -> bool:
    folder = versions.new.package_of(path)
    return folder is not None and versions.old.file((PurePosixPath(folder) / MANIFEST).as_posix()).is_file()


def _is_new_script(versions: Versions, subject: Subject) -> bool:
    """Return whether a source in Python is new, and no other file of the repository imports, installs or starts it."""
    path, new = subject.path, versions.new
    if subject.old_path is not None or versions.old.file(path).is_file() or not is_python_source(path):
        return False
    if all(change.sentence.template not in _ADDITIONS for change in subject.changes):
        return False  # there is nothing to mark
    name = PurePosixPath(path).stem
    word = re.compile(rf"(?<!\w){re.escape(name)}(?!\w)")
    texts = (new.text(other) for other in new.paths(_CALLER_SUFFIXES) if other != path)
    return not any(name in text and word.search(text) for text in texts)


def _is_about(finding: Diagnostic, path: str) -> bool:
    return finding.code in _CODES and finding.span is not None and finding.span.file == path


def _get_name(finding: Diagnostic) -> str:
    arguments = getattr(finding.message, "arguments", {})
    return str(arguments.get("name", ""))
