"""Rules about Python launch files and the files that they name.

Launch files are parsed but never executed.
"""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import Diagnostic, Phrase, Severity, foreign, nearest, phrase, quoted
from linkwright.lint.generated_files import is_created_later
from linkwright.lint.rule import Rule, Scope
from linkwright.lint.rules.package_manifest import PackageRule
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import is_substitute

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.launch_files import LaunchFile, SharedFile

_FILE_NAME = lazy_pattern(r"[^/]*\.[A-Za-z0-9]{1,8}$")


_COMMENT = lazy_pattern(r"#.*")


class LaunchRule(PackageRule):
    """The base class of rules that check each launch file of a package."""

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield the findings in all launch files of a package."""
        for file in package.launch_files.values():
            yield from self.check_launch(file)

    @abstractmethod
    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """Yield the findings in a launch file."""


class LaunchSyntaxError(LaunchRule):
    """A launch file is not Python.

    ## Why

    `ros2 launch` cannot run a file with a syntax error.

    ## Example

    ```python
    return LaunchDescription([
        robot_state_publisher
        rviz,
    ])
    ```

    ## Use instead

    ```python
    return LaunchDescription([
        robot_state_publisher,
        rviz,
    ])
    ```
    """

    code = "LW840"
    name = "launch-syntax-error"
    severity = Severity.ERROR

    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """Yield a finding if a launch file has a syntax error."""
        if file.error is not None:
            message = phrase(
                "the launch file '{path}' is not valid Python: {message}",
                path=file.path,
                message=foreign(file.error.message),
            )
            yield self.report(message, span=file.error.span, source=file.source)


class LaunchFunctionMissing(LaunchRule):
    """A launch file does not define ``generate_launch_description``.

    ## Why

    `ros2 launch` calls this function and no other. Tests for launch_testing, launch_pytest and pytest are not reported,
    because they define other functions. Modules of a Python package (next to an `__init__.py`) are not reported either.
    For a file without statements, which is unfinished or disabled, the finding is only informational.

    ## Example

    ```python
    def generate_launch_desciption():
        return LaunchDescription([])
    ```

    ## Use instead

    ```python
    def generate_launch_description():
        return LaunchDescription([])
    ```
    """

    code = "LW841"
    name = "launch-function-missing"
    severity = Severity.ERROR

    def check_launch(self, file: LaunchFile) -> Iterator[Diagnostic]:
        """Yield a finding if a launch file does not define ``generate_launch_description``."""
        if file.python_file is None or file.has_function or file.is_test:
            return
        if Path(file.source.name).with_name("__init__.py").is_file():
            return
        from linkwright.packages.readers.launch_files import LAUNCH_FUNCTION

        functions = re.findall(r"^def\s+(\w+)", file.source.text, re.MULTILINE)
        similar_name = next(iter(nearest(LAUNCH_FUNCTION, functions, 1)), None)
        hint = (
            phrase("the name of the function '{similar_name}' looks misspelled", similar_name=similar_name)
            if similar_name
            else phrase("define {function}(), which returns a LaunchDescription", function=LAUNCH_FUNCTION)
        )
        span = file.source.span(0)
        if similar_name:
            offset = file.source.text.index(similar_name)
            span = file.source.span(offset, offset + len(similar_name))
        message = phrase(
            "the launch file '{path}' does not define {function}()", path=file.path, function=LAUNCH_FUNCTION
        )
        # Without a similarly named function, the file may be a module that other launch files import.
        severity = Severity.ERROR if similar_name else Severity.WARNING
        if not _COMMENT.sub("", file.source.text).strip():
            severity = Severity.INFO
        yield self.report(message, span=span, source=file.source, hint=hint, severity=severity)


class LaunchedFileMissing(Rule):
    """A launch file names a file that does not exist in its package.

    ## Why

    The launch fails, or the node starts without its file. Files that are probably created later are not reported: maps,
    files that git ignores, files that the launch file itself writes, and files that a script or a README of the package
    mentions.

    ## Example

    ```python
    model = get_package_share_path('my_robot_description') / 'urdf/mbot.urdf'
    ```

    in a package whose file is called `urdf/mbot_base.urdf`, or a path that does not begin with `/`:

    ```python
    model = get_package_share_directory('my_robot_description') + 'urdf/mbot_base.urdf'
    ```

    ## Use instead

    ```python
    model = get_package_share_path('my_robot_description') / 'urdf/mbot_base.urdf'
    ```
    """

    code = "LW842"
    name = "launched-file-missing"
    scope = Scope.PACKAGE

    def check(self, subject: Subject) -> Iterator[Diagnostic]:
        package = subject.package
        if package is None:
            return
        created_files = {created_file for file in package.launch_files.values() for created_file in file.written_files}
        for file in package.launch_files.values():
            for shared_file in file.paths:
                if (shared_file.package, shared_file.path) not in created_files:
                    yield from self._check_path(shared_file, file, package, subject)

    def _check_path(
        self, shared_file: SharedFile, file: LaunchFile, package: PackageContext, subject: Subject
    ) -> Iterator[Diagnostic]:
        if not _FILE_NAME.search(shared_file.path) or "*" in shared_file.path:
            return
        if not shared_file.has_separator:
            message = phrase(
                "there is no '/' between the share folder of '{package}' and '{path}'",
                package=shared_file.package,
                path=shared_file.path,
            )
            hint = phrase("begin the text with '/', or join both with os.path.join()")
            yield self.report(message, span=shared_file.span, source=file.source, hint=hint)
            return
        is_own_package = shared_file.package == package.name
        share = package.folder if is_own_package else subject.finder.find(shared_file.package)
        if (
            share is None
            or (share / shared_file.path).exists()
            or (is_own_package and _is_installed_as(package, shared_file))
        ):
            return
        name = shared_file.path.rpartition("/")[2]
        if not is_own_package and (share.parent.name != "share" or is_substitute(share)):
            return  # another package found as sources may install its files elsewhere, or only some of them
        sources = None if is_own_package else subject.finder.find_in_sources(shared_file.package)
        if sources is not None and (sources / shared_file.path).exists():
            return  # the installed copy may be older than this file
        if (
            is_own_package
            and any(package_file.rpartition("/")[2] == name for package_file in package.files)
            and _may_be_moved(package)
        ):
            return
        if is_own_package and is_created_later(package, shared_file.path):
            return
        message = phrase(
            "the package '{package}' has no file '{path}'", package=shared_file.package, path=shared_file.path
        )
        yield self.report(
            message,
            span=shared_file.span,
            source=file.source,
            hint=_make_suggestion(package, shared_file) if is_own_package else None,
        )


def _is_installed_as(package: PackageContext, shared_file: SharedFile) -> bool:
    """Return whether ``setup.py`` installs a file of the package at this path."""
    folder, _, name = shared_file.path.rpartition("/")
    setup = package.setup
    if setup is None:
        return False
    destination = f"share/{package.name}/{folder}".rstrip("/")
    return any(
        install_rule.destination is not None
        and install_rule.destination.rstrip("/") == destination
        and any(file.rpartition("/")[2] == name for file in install_rule.files(package.folder))
        for install_rule in setup.installed
    )


def _may_be_moved(package: PackageContext) -> bool:
    """Return whether files may be installed in folders other than their source folders."""
    setup = package.setup
    if setup is not None:
        return not setup.is_complete or any(install_rule.destination is None for install_rule in setup.installed)
    return True


def _make_suggestion(package: PackageContext, shared_file: SharedFile) -> Phrase | None:
    name = shared_file.path.rpartition("/")[2]
    same_names = [file for file in package.files if file.rpartition("/")[2] == name]
    if same_names:
        return phrase("did you mean '{name}'?", name=same_names[0])
    similar_paths = nearest(shared_file.path, package.files, 1)
    return phrase("did you mean {names}?", names=quoted(similar_paths[0])) if similar_paths else None
