"""Read the imports in the ``__init__.py`` of a Python package."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import LinkwrightError
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.packages.readers.python_values import PythonFile
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.files.build.facts import FactKind
from linkwright.review.files.build.setup_files import SETUP_FILE, read_setup_facts
from linkwright.review.installed_paths import find_python_packages
from linkwright.review.sources.names import NameKind, SourceName, SourceNames
from linkwright.review.versions import Version
from linkwright.xacro.cache import read_document

PACKAGE_FILE = "__init__.py"
_SETUP_BUILD_TYPE = "ament_python"
_INSTALLING = "ament_python_install_package"
"""The command of CMake that installs a Python package with all folders below it."""
_UNCERTAIN_ARGUMENTS = frozenset({"packages", "package_dir", "py_modules", "**"})
"""The arguments of ``setup`` that may install modules of other folders, if their values are computed."""


def read_imports(python: PythonFile, names: SourceNames) -> None:
    """Add the public names that an ``__init__.py`` offers.

    It imports them from its package, or lists them in ``__all__``.

    Names of other packages are left out, because programs import these names from their own packages.
    """
    package = PurePosixPath(python.source.name).parent.name
    for statement in python.tree.body:
        if isinstance(statement, ast.ImportFrom):
            is_own = statement.level > 0 or (statement.module or "").partition(".")[0] == package
            names.has_star_import |= any(alias.name == "*" for alias in statement.names)
            has_objects = statement.module is not None and statement.module.rpartition(".")[2] != package
            for alias in statement.names if is_own else ():
                _add_name(python, names, alias.asname or alias.name, alias)
                if has_objects or alias.asname not in (None, alias.name):
                    names.imported_objects.add(alias.asname or alias.name)
            if statement.level == 0 and statement.module is not None:
                names.absolute_imports.append((statement.module.partition(".")[0], python.span(statement)))
        elif isinstance(statement, ast.Import):
            for alias in statement.names:
                names.absolute_imports.append((alias.name.partition(".")[0], python.span(statement)))
        elif isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == "__all__":
            items = statement.value.elts if isinstance(statement.value, (ast.List, ast.Tuple)) else ()
            for item in items:
                _add_name(python, names, python.text(item) or "", item)


def _add_name(python: PythonFile, names: SourceNames, name: str, node: ast.expr | ast.alias) -> None:
    if name.isidentifier() and not name.startswith("_"):
        names.add(SourceName(NameKind.IMPORT, name, "", python.span(node)))


def is_installed_package(version: Version, package: str | None, path: str) -> bool:
    """Return whether a file is the ``__init__.py`` of an installed Python package."""
    return PurePosixPath(path).name == PACKAGE_FILE and is_installed_module(version, package, path)


def is_installed_module(version: Version, package: str | None, path: str) -> bool:
    """Return whether a file is in the folder of a Python package that a ROS package installs."""
    if package is None:
        return False
    file = PurePosixPath(path)
    folders = [
        PurePosixPath(package) / part / name for name in find_python_packages(version, package) for part in ("", "src")
    ]
    return any(file.is_relative_to(folder) for folder in folders)


def is_in_python_package(version: Version, package: str, path: str) -> bool:
    """Return whether a module is in a Python package, or in a folder below one that its build file installs whole.

    Args:
        version: the version of the repository.
        package: the folder of the ROS package.
        path: the path of the module.
    """
    folders = PurePosixPath(path).relative_to(package).parents[:]
    if _INSTALLING not in version.text((PurePosixPath(package) / "CMakeLists.txt").as_posix()):
        folders = folders[:1]  # setup.py lists the folders
    return any((version.file(package) / folder / "__init__.py").is_file() for folder in folders)


def is_certainly_uninstalled(version: Version, package: str, path: str) -> bool:
    """Return whether the ``setup.py`` of a ROS package leaves out the folder of a module.

    It then lists the installed Python packages, which do not include packages below them.

    Args:
        version: the version of the repository.
        package: the folder of the ROS package.
        path: the path of the module.
    """
    setup_path = (PurePosixPath(package) / SETUP_FILE).as_posix()
    if Manifest(read_document(str(version.file(package) / MANIFEST))).build_type != _SETUP_BUILD_TYPE:
        return False
    try:
        facts = read_setup_facts(version, setup_path)
    except (UnreadableFileError, LinkwrightError, OSError, ValueError):
        return False
    if facts.unknown or any(name in _UNCERTAIN_ARGUMENTS for name, _ in facts.other_commands):
        return False
    folder = PurePosixPath(path).relative_to(package).parent
    return ".".join(folder.parts) not in {fact.name for fact in facts.facts if fact.kind is FactKind.MODULE}


def find_failing_imports(version: Version, package: str, path: str, names: SourceNames) -> Iterator[int]:
    """Yield the indexes of the absolute imports that fail in an installed package.

    They name a module beside the file, which Python 3 finds only if the program runs in that folder.

    Args:
        version: the version of the repository.
        package: the folder of the ROS package.
        path: the path of the ``__init__.py``.
        names: the names in the file.
    """
    if Manifest(read_document(str(version.file(f"{package}/{MANIFEST}".lstrip("/"))))).is_ros1:
        return
    folder = version.file(path).parent
    installed = {name.partition("/")[0] for name in find_python_packages(version, package)}
    for index, (name, _) in enumerate(names.absolute_imports):
        if _has_module(folder, name) and name not in installed | sys.stdlib_module_names | {folder.name}:
            yield index


def drop_defined_imports(
    items: Sequence[SourceName], own_names: SourceNames, other_names: SourceNames, other_file: Path
) -> list[SourceName]:
    """Return the imported names that the other version does not offer.

    That version offers a name if it defines it, or if it is a module of the package, which programs can import whether
    or not the ``__init__.py`` does. The result is empty if that version imports all names of a module.

    Args:
        items: the imported names that only one version has.
        own_names: the names of this version.
        other_names: the names of the other version.
        other_file: the ``__init__.py`` of the other version.
    """
    if other_names.has_star_import:
        return []
    defined = {item.name for kind in (NameKind.CLASS, NameKind.FUNCTION) for item in other_names.of_kind(kind)}
    return [
        item
        for item in items
        if item.name not in defined
        and (item.name in own_names.imported_objects or not _has_module(other_file.parent, item.name))
    ]


def _has_module(folder: Path, name: str) -> bool:
    return (folder / f"{name}.py").is_file() or (folder / name / PACKAGE_FILE).is_file()
