"""Rules about the nodes of launch files: packages, executables, and declared dependencies."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import Diagnostic, Note, Severity, counted, joined, nearest, phrase, quoted, quoted_names
from linkwright.lint.dependencies import (
    depends_indirectly_on,
    is_always_installed,
    is_in_every_workspace,
    would_form_cycle,
)
from linkwright.lint.launched_scripts import find_missing_scripts
from linkwright.lint.package_fixes import make_dependency_fix
from linkwright.lint.rule import Rule, Scope
from linkwright.lint.rules.package_manifest import PackageRule
from linkwright.lint.rules.package_python import is_ament_python
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.share_layout import find_substituted_executables

if TYPE_CHECKING:
    from linkwright.diagnostics import SourceText
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.launch_files import LaunchFile

_RQT_PACKAGES = (
    *("rqt_console", "rqt_graph", "rqt_gui", "rqt_image_view", "rqt_plot", "rqt_reconfigure", "rqt_robot_steering"),
    *("rqt_tf_tree", "rqt_topic", "rqt_bag", "rqt_controller_manager", "rqt_joint_trajectory_controller"),
    *("rqt_publisher", "rqt_service_caller"),
)
"""The packages of rqt that each have one executable, which has the name of the package."""

EXTERNAL_EXECUTABLES = {
    **{name: frozenset({name}) for name in _RQT_PACKAGES},
    "rviz2": frozenset({"rviz2"}),
    "xacro": frozenset({"xacro"}),
    "controller_manager": frozenset({"ros2_control_node", "spawner", "unspawner", "hardware_spawner"}),
}
"""The executables of well-known packages, without packages whose executables change between releases."""

PROVIDED_PACKAGES = frozenset(
    {"joint_state_publisher", "joint_state_publisher_gui", "robot_state_publisher", "tf2_ros"}
)
"""Packages of which Linkwright provides every executable, unlike the demo packages."""

WELL_KNOWN_PACKAGES = frozenset(
    {
        *EXTERNAL_EXECUTABLES,
        *PROVIDED_PACKAGES,
        *(
            "slam_toolbox",
            "twist_mux",
            "gazebo_ros",
            "ros_gz_sim",
            "ros_gz_bridge",
            "ros_ign_gazebo",
            "ros_ign_bridge",
            "nav2_bringup",
        ),
        *(
            "robot_localization",
            "teleop_twist_joy",
            "teleop_twist_keyboard",
            "joy",
            "moveit_ros_move_group",
            "moveit_servo",
        ),
        *("diff_drive_controller", "joint_state_broadcaster", "launch_ros", "image_transport"),
    }
)
_XML_SUFFIXES = (".launch", ".launch.xml", "_launch.xml")
_LAUNCH_FOLDER = "launch"
"""The folder of launch files. Those that others include are often called ``NAME.xml``."""
_LAUNCH_ROOT = lazy_pattern(r"<launch[\s>]")
_SETUP_ASSISTANT = ".setup_assistant"
"""The file of a package whose launch files MoveIt generates; they start packages for every possible use.

They name no package next to their own, except the one with the robot, which MoveIt declares.
"""
_TEST_FOLDERS = frozenset({"test", "tests"})
_COMMENT = lazy_pattern(r"<!--.*?-->", re.DOTALL)
_STARTED_PACKAGE = lazy_pattern(r"""<(?:node|composable_node)\b[^>]*?\bpkg\s*=\s*["']([\w-]+)["']""")
_WORD = lazy_pattern(r"[\w-]+")
_DIGIT = lazy_pattern(r"\d")
_FOUND_PACKAGE = lazy_pattern(r"\$\(find(?:-pkg-share|-pkg-prefix)?\s+([\w-]+)\s*\)")
_PYTHON_PACKAGES = frozenset({"launch", "launch_ros", "ament_index_python", "launch_xml", "launch_yaml", "xacro"})


class LaunchedPackageUnknown(Rule):
    """A launch file names a package, but the name looks misspelled.

    ## Why

    The launch fails because the package is not found.

    ## Example

    ```python
    Node(package='robot_state_publsher', executable='robot_state_publisher')
    ```

    ## Use instead

    ```python
    Node(package='robot_state_publisher', executable='robot_state_publisher')
    ```
    """

    code = "LW843"
    name = "launched-package-unknown"
    scope = Scope.PACKAGE

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        package = subject.package
        if package is None:
            return
        for file in package.launch_files.values():
            for package_reference in [*(node.package for node in file.nodes), *file.shares]:
                similar_name = (
                    None
                    if package_reference is None
                    else _find_intended_package(package_reference.text, package, subject)
                )
                if package_reference is not None and similar_name is not None:
                    message = phrase("there is no package '{package}'", package=package_reference.text)
                    yield self.report(
                        message,
                        span=package_reference.span,
                        source=file.source,
                        hint=phrase("did you mean {names}?", names=quoted(similar_name)),
                    )


class LaunchedExecutableUnknown(PackageRule):
    """A launch file starts an executable that does not exist in the named package.

    ## Why

    The launch fails because the executable is not found in the folder of the package. Of a package that CMake builds,
    only scripts with the suffix `.py` are reported, in launch files in Python and XML, if no file of the package has
    the name and the build makes no files.

    ## Example

    ```python
    Node(package='rviz2', executable='rviz')
    ```

    ## Use instead

    ```python
    Node(package='rviz2', executable='rviz2')
    ```
    """

    code = "LW844"
    name = "launched-executable-unknown"

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each unknown executable in the launch files of a package."""
        for file in package.launch_files.values():
            yield from self._check_file(file, package)
        if package.cmake is None:
            return
        for script in find_missing_scripts(package):
            scripts = {PurePosixPath(file).name for file in package.files if file.endswith(".py")}
            similar_name = next(iter(nearest(script.name, scripts, 1)), None)
            hint = phrase("no file of the package has the name '{name}'", name=script.name)
            if similar_name:
                hint = phrase("did you mean {names}?", names=quoted(similar_name))
            message = phrase(
                "the package '{name}' has no executable '{executable}'", name=package.name, executable=script.name
            )
            yield self.report(message, span=script.span, source=script.source, hint=hint)

    def _check_file(self, file: LaunchFile, package: PackageContext) -> Iterator[Diagnostic]:
        for node in file.nodes:
            if node.package is None or node.executable is None:
                continue
            name, executable = node.package.text, node.executable.text.removesuffix(".py")
            executables = _list_executables(name) if name != package.name else _list_own_executables(package)
            if executables is None or executable in executables or node.executable.text in executables:
                continue
            similar_name = next(iter(nearest(executable, executables, 1)), None)
            if similar_name:
                hint = phrase("did you mean {names}?", names=quoted(similar_name))
            else:
                hint = (
                    phrase("use one of {names}", names=joined(sorted(executables)))
                    if executables
                    else phrase("the package has no executables")
                )
            message = phrase(
                "the package '{name}' has no executable '{executable}'", name=name, executable=node.executable.text
            )
            yield self.report(message, span=node.executable.span, source=file.source, hint=hint)


class UndeclaredLaunchDependency(Rule):
    """Launch files and descriptions use packages that ``package.xml`` does not depend on.

    ## Why

    rosdep only installs the packages that `package.xml` names. On a machine without the other packages, the launch
    fails, and so does the expansion of a description that includes their files. Some packages are not reported: those
    of every ROS installation, such as `launch_ros`, dependencies of declared packages, and packages that depend on this
    package, since declaring them would form a cycle. Neither are packages that a comment in `package.xml` names.

    ## Example

    ```python
    Node(package='joint_state_publisher_gui', executable='joint_state_publisher_gui')
    ```

    while `package.xml` does not mention the package.

    ## Use instead

    ```xml
    <exec_depend>joint_state_publisher_gui</exec_depend>
    ```
    """

    code = "LW848"
    name = "undeclared-launch-dependency"
    severity = Severity.INFO
    scope = Scope.PACKAGE

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        package = subject.package
        manifest = None if package is None else package.manifest
        if package is None or manifest is None or manifest.root.tag != "package":
            return
        if any("$" in dependency.name for dependency in manifest.dependencies):
            return
        launched = _find_used_packages(package)
        text = "" if manifest.document.source is None else manifest.document.source.text
        mentioned = frozenset(_WORD.findall(" ".join(_COMMENT.findall(text))))  # left out on purpose
        missing_packages = {
            name: note
            for name, note in {**_find_packages_in_descriptions(package), **launched}.items()
            if name not in mentioned
            and not (
                is_always_installed(name)
                or (manifest.is_ros1 and is_in_every_workspace(name, is_ros1=True))
                or manifest.declares(name)
                or depends_indirectly_on(manifest, name, subject.finder)
            )
            and _find_intended_package(name, package, subject) is None
            and not would_form_cycle(manifest, name, subject.finder)
        }
        if not missing_packages:
            return
        names = sorted(missing_packages)
        message = counted(
            "launch files use a package on which package.xml does not depend: {names}",
            "launch files use packages on which package.xml does not depend: {names}",
            len(names),
            names=quoted_names(names),
        )
        if not launched.keys() >= missing_packages.keys():
            message = counted(
                "launch files and descriptions use a package on which package.xml does not depend: {names}",
                "launch files and descriptions use packages on which package.xml does not depend: {names}",
                len(names),
                names=quoted_names(names),
            )
        hint = counted(
            "add <exec_depend>{name}</exec_depend>", "add an <exec_depend> for each", len(names), name=names[0]
        )
        fix = make_dependency_fix(manifest, names)
        yield self.report(message, manifest.root, notes=[missing_packages[name] for name in names], hint=hint, fix=fix)


def _may_be_launch_file(path: str) -> bool:
    """Return whether a path may be that of a launch file in XML: by its suffix or its folder."""
    folders = path.split("/")[:-1]
    is_named = path.endswith(_XML_SUFFIXES) or (path.endswith(".xml") and _LAUNCH_FOLDER in folders)
    return is_named and _TEST_FOLDERS.isdisjoint(folders)


def _find_packages_in_xml(source: SourceText) -> Iterator[tuple[str, Note]]:
    """Yield the packages that a launch file in XML uses, each with a note."""
    text = _COMMENT.sub(lambda match: " " * len(match[0]), source.text)
    for match in _STARTED_PACKAGE.finditer(text):
        yield match[1], Note(phrase("'{text}' is started here", text=match[1]), source.span(*match.span(1)))
    for match in _FOUND_PACKAGE.finditer(text):
        yield match[1], Note(phrase("'{text}' is searched for here", text=match[1]), source.span(*match.span(1)))


def _find_packages_in_descriptions(package: PackageContext) -> dict[str, Note]:
    """Return the packages whose files descriptions include, by name, each with a note on the first include."""
    first_uses: dict[str, Note] = {}
    for document in package.descriptions.values():
        for element in document.root.walk():
            match = _FOUND_PACKAGE.match(element.attributes.get("filename", "").strip())
            if element.tag != "xacro:include" or match is None or match[1] == package.name:
                continue
            span = element.span()
            if span is not None and match[1] not in first_uses:
                first_uses[match[1]] = Note(phrase("'{text}' is searched for here", text=match[1]), span)
    return first_uses


def _find_used_packages(package: PackageContext) -> dict[str, Note]:
    """Return the packages that launch files use, by name, each with a note on its first use."""
    first_uses: dict[str, Note] = {}
    for file in package.launch_files.values():
        for name, span in file.imports:
            if name in _PYTHON_PACKAGES:
                first_uses.setdefault(name, Note(phrase("'{name}' is imported here", name=name), span))
        for node in file.nodes:
            if node.package is not None:
                first_uses.setdefault(
                    node.package.text,
                    Note(phrase("'{text}' is started here", text=node.package.text), node.package.span),
                )
        for share in file.shares:
            first_uses.setdefault(
                share.text, Note(phrase("'{text}' is searched for here", text=share.text), share.span)
            )
        for match in re.finditer(r"""Command\(\s*\[?\s*["']xacro\b""", file.source.text):
            span = file.source.span(match.end() - len("xacro"), match.end())
            first_uses.setdefault("xacro", Note(phrase("'xacro' is run here"), span))
    is_generated = package.has(_SETUP_ASSISTANT)
    for file_path in package.files:
        if _may_be_launch_file(file_path):
            source = package.text(file_path)
            if source is not None and not file_path.endswith(_XML_SUFFIXES) and not _LAUNCH_ROOT.search(source.text):
                continue
            for name, note in () if source is None else _find_packages_in_xml(source):
                if not is_generated or (package.folder.parent / name / MANIFEST).is_file():
                    first_uses.setdefault(name, note)
    first_uses.pop(package.name, None)
    return {name: note for name, note in first_uses.items() if re.fullmatch(r"[a-zA-Z]\w*", name)}


def _list_executables(name: str) -> frozenset[str] | None:
    """Return the executables of a well-known package, or None if not all are known."""
    if name not in PROVIDED_PACKAGES:
        return EXTERNAL_EXECUTABLES.get(name)
    return find_substituted_executables()[name]


def _list_own_executables(package: PackageContext) -> frozenset[str] | None:
    """Return the executables of a package, or None if not all are known."""
    setup, cmake = package.setup, package.cmake
    if cmake is not None:
        return None  # CMake targets are defined in too many ways to know all of them
    if (
        setup is None
        or setup.error is not None
        or not setup.entry_points_complete
        or not is_ament_python(package)
        or "scripts=" in setup.source.text
    ):
        return None
    folder = f"lib/{package.name}/"
    installed_files = [
        file.destination for file in setup.installed_files(package.folder) if file.destination.startswith(folder)
    ]
    return frozenset(
        (
            *(entry.executable for entry in setup.entry_points),
            *(Path(name).name.removesuffix(".py") for name in installed_files),
        )
    )


def _is_known(name: str, package: PackageContext, subject: Subject) -> bool:
    manifest = package.manifest
    return name == package.name or (manifest is not None and manifest.declares(name)) or bool(subject.finder.find(name))


def _find_intended_package(name: str, package: PackageContext, subject: Subject) -> str | None:
    """Return the known package whose name was probably misspelled, or None.

    The result is None if a package with the given name exists. Packages whose names differ from that of the package
    itself only in digits are those of other robots of a family.
    """
    if not name or name in WELL_KNOWN_PACKAGES or _is_known(name, package, subject):
        return None
    own_names = [] if _DIGIT.sub("", name) == _DIGIT.sub("", package.name) else [package.name]
    similar_name = next(iter(nearest(name, [*WELL_KNOWN_PACKAGES, *own_names], 1)), None)
    return similar_name if similar_name is not None and _is_typo(name, similar_name) else None


def _is_typo(name: str, similar_name: str) -> bool:
    """Return whether one of two similar names is probably misspelled.

    Names with fewer than five letters are never considered similar.
    """
    if abs(len(name) - len(similar_name)) > 2 or min(len(name), len(similar_name)) < 5:
        return False
    from difflib import SequenceMatcher

    return SequenceMatcher(None, name, similar_name).ratio() > 0.9
