"""Python modules of the packages in the workspace, for launch files that import them.

In ROS, a launch file may import the modules of every package that is built and sourced. Here, a launch file may also
import the modules of packages that exist only as sources, and of packages in install folders that are not sourced.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import spec_from_file_location
from itertools import chain
from pathlib import Path

from linkwright.diagnostics import SourceText
from linkwright.packages import PackageFinder, enclosing_package, install_prefix, is_installed
from linkwright.packages.programs.source_programs import NON_PROGRAM_MODULES, find_python_root
from linkwright.packages.programs.workspace_environment import find_python_folders
from linkwright.packages.readers.entry_points import read_text


def find_module(finder: PackageFinder, name: str, near: Path) -> ModuleSpec | None:
    """Return the spec of a top-level module, or None if no package contains the module.

    Args:
        finder: the finder of packages.
        name: the name of the module. The package with this name is searched first, then the importing package, then all
            others, because many packages have a module ``scripts`` or ``utils``.
        near: the folder of the file that imports the module.
    """
    if name in NON_PROGRAM_MODULES:
        return None
    package_folder = finder.find(name)
    if package_folder is not None:
        spec = _find_module(name, _list_module_folders(package_folder, name))
        if spec is None:
            spec = _find_renamed_package(package_folder, name)
        if spec is None and any((package_folder / name).glob("*.py")):
            spec = PathFinder.find_spec(name, [str(package_folder)])  # the package's module folder has no __init__.py
        if spec is not None:
            return spec
    asking = enclosing_package(near)
    packages = chain(() if asking is None else (asking,), finder.packages().items())
    return _find_module(
        name, (folder for package, share in packages for folder in _list_module_folders(share, package))
    )


def _list_module_folders(share: Path, package: str) -> Iterator[Path]:
    """Yield the folders from which a package's modules are imported."""
    if is_installed(share):
        yield from find_python_folders(install_prefix(share), package)
        return
    root = find_python_root(share, package)
    if root is not None:
        yield root


def _find_renamed_package(share: Path, name: str) -> ModuleSpec | None:
    """Return the spec of a Python package that ``CMakeLists.txt`` installs from a folder with another name."""
    build_file = share / "CMakeLists.txt"
    if is_installed(share) or "PACKAGE_DIR" not in read_text(build_file):
        return None
    from linkwright.packages.readers.cmake import read_cmake

    folder = read_cmake(SourceText(str(build_file), read_text(build_file)), share).python_packages.get(name)
    if folder is None or not (share / folder / "__init__.py").is_file():
        return None
    return spec_from_file_location(
        name, share / folder / "__init__.py", submodule_search_locations=[str(share / folder)]
    )


def _find_module(name: str, folders: Iterable[Path]) -> ModuleSpec | None:
    for folder in folders:
        if (folder / name / "__init__.py").is_file() or (folder / f"{name}.py").is_file():
            return PathFinder.find_spec(name, [str(folder)])
    return None
