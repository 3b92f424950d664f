"""Rules about setuptools packages: the resource marker, the executables, ``setup.cfg``."""

from __future__ import annotations

import re
from collections.abc import Iterator

from linkwright.diagnostics import Diagnostic, Severity, foreign, phrase
from linkwright.lint.package_fixes import make_setup_file_fix
from linkwright.lint.rules.package_install import make_checkout_hint, make_similar_file_hint
from linkwright.lint.rules.package_manifest import PackageRule
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext

_INDEX_FOLDER = "share/ament_index/resource_index/packages"
_WEBOTS_DRIVER = lazy_pattern(r"^[ \t]+def init\(self, *\w+, *\w+\)", re.MULTILINE)
"""A class that webots_ros2_driver loads by its name. The executable of such a package is never run."""
_SCRIPT_FOLDERS = lazy_pattern(r"^(script_dir|install_scripts)[ \t]*=[ \t]*(\S+)[ \t]*\r?$", re.MULTILINE)


class SetupSyntaxError(PackageRule):
    """``setup.py`` is not Python.

    ## Why

    The package cannot be built.

    ## Example

    ```python
    setup(
        name='my_robot_description'
        version='0.1.0',
    ```

    ## Use instead

    ```python
    setup(
        name='my_robot_description',
        version='0.1.0',
    ```
    """

    code = "LW820"
    name = "setup-syntax-error"
    severity = Severity.ERROR

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding if the ``setup.py`` of a package has a syntax error."""
        setup = package.setup
        if setup is not None and setup.error is not None:
            message = phrase("setup.py is not valid Python: {message}", message=foreign(setup.error.message))
            yield self.report(message, span=setup.error.span, source=setup.source)


class MarkerMissing(PackageRule):
    """The empty file ``resource/NAME`` that marks a Python package for ROS is missing.

    ## Why

    `setup.py` installs the file into the package index. Without the file, the build stops. Without the index entry,
    `ros2 run` and `ros2 launch` do not find the package.

    ## Example

    A package `my_robot_description` built by `ament_python`, with a file `resource/robot_description`.

    ## Use instead

    Create an empty file `resource/my_robot_description`.
    """

    code = "LW825"
    name = "marker-missing"
    severity = Severity.ERROR

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding if the marker file of a package is missing."""
        setup = package.setup
        if setup is None or not is_ament_python(package):
            return
        marker = f"resource/{package.name}"
        marker_entry = next((item for item in setup.installed if item.text == marker), None)
        if marker_entry is None or package.has(marker):
            return
        resource_files = [file for file in package.files if file.startswith("resource/")]
        hint = (
            phrase("rename '{others}'", others=resource_files[0])
            if len(resource_files) == 1
            else phrase("create an empty file '{marker}'", marker=marker)
        )
        message = phrase("setup.py installs the marker file '{marker}', which does not exist", marker=marker)
        yield self.report(message, span=marker_entry.span, source=setup.source, hint=hint)


class MarkerNotInstalled(PackageRule):
    """``setup.py`` does not install the marker or the ``package.xml`` of the package.

    ## Why

    ROS 2 finds an installed package by a marker file with the name of the package in the index, and tools read the
    `package.xml` in the share folder. Currently, colcon adds both files, with a warning that this will change.

    ## Example

    ```python
    data_files=[
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
    ],
    ```

    ## Use instead

    ```python
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
    ],
    ```
    """

    code = "LW826"
    name = "marker-not-installed"

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for the marker and for the ``package.xml`` if they are not installed."""
        setup = package.setup
        if setup is None or not setup.has_call or not setup.is_complete or not is_ament_python(package):
            return
        has_marker = any(
            item.destination == _INDEX_FOLDER or item.text.startswith("resource/") for item in setup.installed
        )
        if not has_marker:
            message = phrase("setup.py does not install the marker file of the package '{name}'", name=package.name)
            has_marker = (package.folder / "resource" / package.name).is_file()
            hint = (
                phrase("add ('{folder}', ['resource/{name}']) to data_files", folder=_INDEX_FOLDER, name=package.name)
                if has_marker
                else phrase(
                    "create an empty file 'resource/{name}', and add ('{folder}', ['resource/{name}']) to data_files",
                    folder=_INDEX_FOLDER,
                    name=package.name,
                )
            )
            fix = make_setup_file_fix(package, setup, _INDEX_FOLDER, f"resource/{package.name}") if has_marker else None
            yield self.report(message, span=setup.data_files_span, source=setup.source, hint=hint, fix=fix)
        if not any(item.text == "package.xml" for item in setup.installed):
            message = phrase("setup.py does not install package.xml")
            hint = phrase("add ('share/{name}', ['package.xml']) to data_files", name=package.name)
            fix = make_setup_file_fix(package, setup, "", "package.xml")
            yield self.report(message, span=setup.data_files_span, source=setup.source, hint=hint, fix=fix)


class EntryPointMissing(PackageRule):
    """An executable in ``setup.py`` names a module or function that does not exist.

    ## Why

    The build does not report the mistake, and `ros2 run` fails with an import error.

    ## Example

    ```python
    entry_points={'console_scripts': ['driver = my_robot.drivr:main']},
    ```

    ## Use instead

    ```python
    entry_points={'console_scripts': ['driver = my_robot.driver:main']},
    ```
    """

    code = "LW827"
    name = "entry-point-missing"
    severity = Severity.ERROR

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each executable whose module or function does not exist."""
        setup = package.setup
        if setup is None:
            return
        for entry in setup.entry_points:
            top_package = entry.module.partition(".")[0]
            if not package.has(top_package):
                continue  # a module of another package, or in another folder
            path = entry.module.replace(".", "/")
            file = next((name for name in (f"{path}.py", f"{path}/__init__.py") if package.has(name)), None)
            if file is None:
                message = phrase(
                    "the executable '{executable}' runs '{module}', which does not exist",
                    executable=entry.executable,
                    module=entry.module,
                )
                yield self.report(
                    message, span=entry.span, source=setup.source, hint=make_similar_file_hint(package, f"{path}.py")
                )
            elif entry.function is not None and not _defines(package, file, entry.function.partition(".")[0]):
                message = phrase(
                    "the executable '{executable}' runs '{function}', which '{file}' does not define",
                    executable=entry.executable,
                    function=entry.function,
                    file=file,
                )
                hint = phrase("define {function}() in '{file}'", function=entry.function, file=file)
                yield self.report(message, span=entry.span, source=setup.source, hint=hint)


class PythonPackageMissing(PackageRule):
    """``setup.py`` names a Python package whose folder does not exist.

    ## Why

    The build stops with "package directory does not exist". Even a package with only descriptions needs its Python
    folder, with an empty `__init__.py`.

    ## Example

    ```python
    packages=['my_robot_description'],
    ```

    in a package without a folder `my_robot_description`.

    ## Use instead

    Create an empty file `my_robot_description/__init__.py`, or write `packages=find_packages(exclude=['test'])`.
    """

    code = "LW828"
    name = "python-package-missing"
    severity = Severity.ERROR

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each Python package in ``setup.py`` whose folder does not exist."""
        setup = package.setup
        if setup is None or setup.packages is None or "package_dir" in setup.source.text:
            return
        for name, span in setup.packages:
            path = name.replace(".", "/")
            if name and not package.has(path):
                message = phrase("setup.py names the Python package '{name}', which has no folder", name=name)
                hint = make_checkout_hint(package, path) or phrase("add an empty file '{path}/__init__.py'", path=path)
                yield self.report(message, span=span, source=setup.source, hint=hint)


class SetupCfgDiffers(PackageRule):
    """``setup.cfg`` does not install the executables where ``ros2 run`` looks for them.

    ## Why

    By default, setuptools installs executables into `bin`. `ros2 run` and launch files search `lib/NAME`, and report
    that the executable is not found.

    ## Example

    A package with `console_scripts` and without a `setup.cfg`.

    ## Use instead

    ```ini
    [develop]
    script_dir=$base/lib/my_robot
    [install]
    install_scripts=$base/lib/my_robot
    ```
    """

    code = "LW829"
    name = "setup-cfg-differs"

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding if ``setup.cfg`` installs the executables into another folder."""
        setup = package.setup
        if setup is None or not setup.entry_points or not is_ament_python(package):
            return
        script_folder = f"$base/lib/{package.name}"
        source = package.text("setup.cfg")
        if source is None:
            message = phrase("without a setup.cfg, ros2 run does not find the executables of this package")
            hint = phrase("write a setup.cfg with install_scripts={folder} in [install]", folder=script_folder)
            yield self.report(message, span=setup.entry_points[0].span, source=setup.source, hint=hint)
            return
        for match in _SCRIPT_FOLDERS.finditer(source.text):
            if match[2] != script_folder:
                span = source.span(*match.span(2))
                message = phrase(
                    "setup.cfg puts executables into '{folder}', where ros2 run does not look", folder=match[2]
                )
                yield self.report(
                    message,
                    span=span,
                    source=source,
                    hint=phrase("write {option}={folder}", option=match[1], folder=script_folder),
                )


def is_ament_python(package: PackageContext) -> bool:
    """Return whether colcon builds the package with setuptools for ROS 2."""
    return package.manifest is not None and package.manifest.build_type == "ament_python"


def _defines(package: PackageContext, file: str, name: str) -> bool:
    source = package.text(file)
    if source is None:
        return True
    name = re.escape(name)
    patterns = (
        rf"(async def|def|class)\s+{name}\b",
        rf"{name}\s*[:=]",
        rf"\s*(from|import)\b.*\b{name}\b",
        "from.*import [*(]",
    )
    text = source.text
    is_defined = re.search(rf"^({'|'.join(patterns)})", text, re.MULTILINE) or "__getattr__" in text
    return bool(is_defined or _WEBOTS_DRIVER.search(text))
