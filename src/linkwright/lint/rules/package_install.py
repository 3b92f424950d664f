"""Rules about files that a build file does not install or cannot find.

The rules about missing files do not apply if the set of installed files is unknown. It is unknown if it depends on a
value that only CMake can compute, or on a command of another package.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator

from linkwright.diagnostics import Diagnostic, Phrase, Severity, nearest, phrase, quoted
from linkwright.lint.generated_files import find_submodule, is_created_by_cmake, is_ignored_by_git
from linkwright.lint.package_fixes import make_cmake_folder_fix, make_setup_folders_fix
from linkwright.lint.rules.package_manifest import PackageRule
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.lint.package import PackageContext
    from linkwright.packages.readers.cmake import CMakeFile
    from linkwright.packages.readers.setup_py import DataFile, SetupFile

_SHARED_FILE = lazy_pattern(
    r".*\.(urdf|xacro|sdf|world|rviz|stl|dae|obj|glb|gltf|launch\.py|launch\.xml|launch\.yaml|srdf|yaml)$",
    re.IGNORECASE,
)
USUAL_FOLDERS = frozenset(
    {
        *("launch", "urdf", "xacro", "robot", "robots", "description", "mesh", "meshes", "model", "models", "media"),
        *("materials", "world", "worlds", "config", "configs", "cfg", "param", "params", "rviz", "map", "maps", "srdf"),
    }
)
"""The names of folders with files that are usually installed. Other folders may contain templates or sources."""
_SETTINGS_FILE = lazy_pattern(r"(?<!\.launch)\.(rviz|yaml)$", re.IGNORECASE)
_UNSHARED_FOLDER = lazy_pattern(r"(^|/)(test|tests|docs?|scripts?|\w*_py|src|include|resource|ci|docker)(/|$)")


class PatternMatchesNothing(PackageRule):
    """A pattern in the ``data_files`` of ``setup.py`` matches no file.

    ## Why

    `glob` does not report that it finds nothing, so the intended files are missing after the build. A launch file or an
    include then fails with "no such file". A misspelled folder is the usual cause. If another pattern finds files in
    the same folder, the finding is informational.

    ## Example

    ```python
    (os.path.join('share', package_name, 'urdf/sensors'), glob('urdf/sensors/*.*')),
    ```

    in a package whose folder is called `urdf/sensor`.

    ## Use instead

    ```python
    (os.path.join('share', package_name, 'urdf/sensor'), glob('urdf/sensor/*.*')),
    ```
    """

    code = "LW821"
    name = "pattern-matches-nothing"

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each pattern in ``setup.py`` that matches no file."""
        setup = package.setup
        if setup is None:
            return
        matched_folders = {item.text.rpartition("/")[0] for item in setup.installed if item.files(package.folder)}
        for item in setup.installed:
            if not item.is_pattern or item.files(package.folder):
                continue
            folder = item.text.rpartition("/")[0]
            suggested_folder = find_similar_folder(package, folder)
            if suggested_folder:
                hint: Phrase | None = phrase(
                    "did you mean the folder '{similar_folder}'?", similar_folder=suggested_folder
                )
            elif folder and package.has(folder):
                hint = (
                    phrase("there are other files in '{folder}'", folder=folder)
                    if folder in package.folders
                    else phrase("'{name}' is empty", name=folder)
                )
            else:
                hint = phrase("there is no folder '{folder}'", folder=folder) if folder else None
            is_doubtful = suggested_folder or (folder and package.has(folder) and folder not in matched_folders)
            severity = self.severity if is_doubtful else Severity.INFO
            message = phrase("the pattern '{text}' in setup.py matches no file", text=item.text)
            yield self.report(message, span=item.span, source=setup.source, hint=hint, severity=severity)


class FolderNotInstalled(PackageRule):
    """A folder with launch files, descriptions or meshes is not installed.

    ## Why

    ROS searches the share folder of the installed package, not the sources, so launch files and descriptions do not
    find a file that is not installed. A folder with an unusual name is only reported if a launch file of the package
    uses a file in the folder. For a folder of YAML and RViz files that no launch file of the package reads, the finding
    is informational.

    ## Example

    ```python
    data_files=[
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
    ],
    ```

    in a package with a folder `meshes`.

    ## Use instead

    ```python
        ('share/' + package_name + '/launch', glob('launch/*.launch.py')),
        ('share/' + package_name + '/meshes', glob('meshes/*')),
    ```

    or, in `CMakeLists.txt`, `install(DIRECTORY launch meshes DESTINATION share/${PROJECT_NAME})`.
    """

    code = "LW822"
    name = "folder-not-installed"

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each shared folder that is not installed."""
        if package.setup is not None and package.cmake is None:
            yield from self._check_setup(package, package.setup)
        elif package.cmake is not None and package.setup is None:
            yield from self._check_cmake(package, package.cmake)

    def _check_setup(self, package: PackageContext, setup: SetupFile) -> Iterator[Diagnostic]:
        if not setup.has_call or not setup.is_complete:
            return
        files = {file for item in setup.installed for file in item.files(package.folder)}
        installed_folders = {file.rpartition("/")[0] for file in files}
        empty_patterns = [item for item in setup.installed if item.is_pattern and not item.files(package.folder)]
        intended_folders = {
            find_similar_folder(package, item.text.rpartition("/")[0]) for item in empty_patterns
        }  # LW821 reports these folders
        uninstalled_folders: dict[str, list[str]] = {}
        for folder in _find_uninstalled_folders(
            package, lambda folder: folder in installed_folders or folder in intended_folders
        ):
            uninstalled_folders.setdefault(_find_top_folder(folder), []).append(folder)
        for folder, *others in uninstalled_folders.values():
            message = phrase("setup.py does not install the folder '{folder}'", folder=folder)
            if others:
                message = phrase("{message} (and {count} more)", message=message, count=len(others))
            hint = phrase(
                "add ('share/{name}/{folder}', glob('{folder}/*')) to data_files", name=package.name, folder=folder
            )
            severity = self._severity(package, [folder, *others])
            fix = make_setup_folders_fix(package, setup, [folder, *others], safe=severity is not Severity.INFO)
            yield self.report(
                message, span=setup.data_files_span, source=setup.source, hint=hint, fix=fix, severity=severity
            )

    def _check_cmake(self, package: PackageContext, cmake: CMakeFile) -> Iterator[Diagnostic]:
        if not cmake.is_complete or cmake.foreign or not cmake.is_ament:
            return

        def is_installed(folder: str) -> bool:
            is_covered = any(_covers(item.text, folder) for item in cmake.directories)
            return is_covered or any(item.text.startswith(f"{folder}/") for item in cmake.files)

        partly_installed = {_find_top_folder(folder) for folder in filter(is_installed, list_shared_folders(package))}
        uninstalled_folders = (
            folder if _find_top_folder(folder) in partly_installed else _find_top_folder(folder)
            for folder in _find_uninstalled_folders(package, is_installed)
        )
        for folder in dict.fromkeys(uninstalled_folders):
            message = phrase("CMakeLists.txt does not install the folder '{folder}'", folder=folder)
            parent = f"/{folder.rpartition('/')[0]}" if "/" in folder else ""
            hint = phrase(
                "add install(DIRECTORY {folder} DESTINATION share/${{PROJECT_NAME}}{parent})",
                folder=folder,
                parent=parent,
            )
            span = cmake.span(cmake.project) if cmake.project else None
            severity = self._severity(package, [folder])
            fix = make_cmake_folder_fix(cmake.source, folder, safe=severity is not Severity.INFO)
            yield self.report(message, span=span, source=cmake.source, hint=hint, fix=fix, severity=severity)

    def _severity(self, package: PackageContext, folders: Iterable[str]) -> Severity:
        """Return the severity, informational for settings that no launch file of the package reads."""
        prefixes = tuple(f"{folder}/" for folder in folders)
        shared_files = [file for file in package.files if file.startswith(prefixes) and _is_shared(file)]
        is_unread = not any(path.startswith(prefixes) for path in _find_paths_in_launch_files(package))
        return Severity.INFO if is_unread and all(map(_SETTINGS_FILE.search, shared_files)) else self.severity


class FileNotInstalled(PackageRule):
    """A folder is installed by a pattern that omits a description or launch file.

    ## Why

    The file is found in the sources but is missing after the build.

    ## Example

    ```python
    ('share/' + package_name + '/urdf', glob('urdf/*.urdf')),
    ```

    in a package with `urdf/robot.xacro`.

    ## Use instead

    ```python
    ('share/' + package_name + '/urdf', glob('urdf/*')),
    ```
    """

    code = "LW823"
    name = "file-not-installed"

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each description or launch file that a pattern omits."""
        setup = package.setup
        if setup is None or package.cmake is not None or not setup.is_complete:
            return
        patterns_by_folder: dict[str, DataFile] = {}
        files: set[str] = set()
        for item in setup.installed:
            for file in item.files(package.folder):
                files.add(file)
                if item.is_pattern:
                    patterns_by_folder.setdefault(file.rpartition("/")[0], item)
        for file in package.files:
            folder = file.rpartition("/")[0]
            pattern = patterns_by_folder.get(folder)
            if folder and pattern is not None and file not in files and _is_shared(file):
                message = phrase("the pattern '{text}' in setup.py leaves out '{file}'", text=pattern.text, file=file)
                yield self.report(
                    message,
                    span=pattern.span,
                    source=setup.source,
                    hint=phrase("write, for example, glob('{folder}/*')", folder=folder),
                )


class InstalledFileMissing(PackageRule):
    """``setup.py`` or ``CMakeLists.txt`` installs a file, folder or Python package that does not exist.

    ## Why

    The build stops with an error at the missing file.

    ## Example

    ```cmake
    install(DIRECTORY launch meshs DESTINATION share/${PROJECT_NAME})
    ```

    ## Use instead

    ```cmake
    install(DIRECTORY launch meshes DESTINATION share/${PROJECT_NAME})
    ```
    """

    code = "LW824"
    name = "installed-file-missing"
    severity = Severity.ERROR

    def check_package(self, package: PackageContext) -> Iterator[Diagnostic]:
        """Yield a finding for each missing file or folder that a build file installs."""
        setup, cmake = package.setup, package.cmake
        if setup is not None:
            for item in setup.installed:
                if (
                    item.is_pattern
                    or _exists_or_is_generated(package, item.text)
                    or item.text == f"resource/{package.name}"
                ):
                    continue
                message = phrase("setup.py installs '{text}', which does not exist", text=item.text)
                hint = make_checkout_hint(package, item.text) or make_similar_file_hint(package, item.text)
                yield self.report(message, span=item.span, source=setup.source, hint=hint)
        if cmake is not None:
            for argument in cmake.required_paths:
                text = argument.text.rstrip("/")
                if text and not text.startswith("/") and "<" not in text and not _exists_or_is_generated(package, text):
                    message = phrase("CMakeLists.txt installs '{text}', which does not exist", text=argument.text)
                    suggested_folder = find_similar_folder(package, text)
                    suggestion = (
                        phrase("did you mean {names}?", names=quoted(suggested_folder))
                        if suggested_folder
                        else make_similar_file_hint(package, text)
                    )
                    hint = make_checkout_hint(package, text) or suggestion
                    yield self.report(message, span=cmake.span(argument), source=argument.source, hint=hint)


def _exists_or_is_generated(package: PackageContext, path: str) -> bool:
    """Return whether a path is among the sources or is created before the installation.

    Files that git ignores and files that CMake creates are assumed to be created.
    """
    absolute_path = package.folder / path
    is_ignored = is_ignored_by_git(absolute_path) or is_ignored_by_git(absolute_path / "_")
    return package.has(path) or is_ignored or is_created_by_cmake(package, path)


def list_shared_folders(package: PackageContext) -> list[str]:
    """Return the sorted folders that directly contain files for the share folder."""
    return sorted({file.rpartition("/")[0] for file in package.files if "/" in file and _is_shared(file)})


def _find_uninstalled_folders(package: PackageContext, is_installed: Callable[[str], bool]) -> list[str]:
    """Return the shared folders that are not installed.

    Only folders with a usual name, and folders that a launch file uses, are returned.
    """
    launch_paths = _find_paths_in_launch_files(package)
    return [
        folder
        for folder in list_shared_folders(package)
        if not is_installed(folder)
        and (_find_top_folder(folder) in USUAL_FOLDERS or any(path.startswith(f"{folder}/") for path in launch_paths))
    ]


def _find_paths_in_launch_files(package: PackageContext) -> set[str]:
    """Return the paths in share folders that the package's launch files name."""
    return {shared_file.path for file in package.launch_files.values() for shared_file in file.paths}


def _find_top_folder(folder: str) -> str:
    return folder.partition("/")[0]


def find_similar_folder(package: PackageContext, folder: str) -> str | None:
    """Return the folder with the name most similar to a missing folder's, or None.

    Only folders in the same parent folder are compared. The result is also None if the folder exists.
    """
    if not folder or package.has(folder):
        return None
    parent = folder.rpartition("/")[0]
    siblings = [folder for folder in package.folders if folder.rpartition("/")[0] == parent]
    return next(iter(nearest(folder, siblings, 1)), None)


def _is_shared(file: str) -> bool:
    return bool(_SHARED_FILE.match(file)) and not _UNSHARED_FOLDER.search(file)


def _covers(directory: str, folder: str) -> bool:
    directory = directory.rstrip("/")
    return directory in ("", ".") or folder == directory or folder.startswith(f"{directory}/")


def make_checkout_hint(package: PackageContext, path: str) -> Phrase | None:
    """Return a hint to check out the Git submodule that contains a path, or None."""
    submodule = find_submodule(package.folder / path)
    if submodule is None:
        return None
    return phrase("'{folder}' is a Git submodule: run git submodule update --init", folder=submodule)


def make_similar_file_hint(package: PackageContext, path: str) -> Phrase | None:
    """Return a hint that names the most similar file in the folder of a path, or None."""
    folder = path.rpartition("/")[0]
    siblings = [file for file in package.files if file.rpartition("/")[0] == folder]
    nearest_path = next(iter(nearest(path, siblings, 1)), None)
    return phrase("did you mean {names}?", names=quoted(nearest_path)) if nearest_path else None
