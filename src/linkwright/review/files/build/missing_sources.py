"""Find the facts of build files about files that the version does not have, so that the build fails."""

from __future__ import annotations

from pathlib import PurePosixPath

from linkwright.review.files.build.facts import Fact, FactKind
from linkwright.review.versions import Version

_FILE_KINDS = (FactKind.INTERFACE, FactKind.DYNAMIC)
"""The kinds whose names are paths relative to the package."""
_SCRIPT_SUFFIXES = (".py", ".sh", ".bash")


def names_missing_file(version: Version, build_file: str, fact: Fact) -> bool:
    """Return whether a fact needs a file of the package that the version does not have.

    A version of which git cannot write all files may have it. So may a submodule or the build, if the path is computed.

    Args:
        version: the version of the repository.
        build_file: the path of the build file relative to the root.
        fact: the fact.
    """
    if version.commit is not None and version.commit.missing_files:
        return False
    folder = PurePosixPath(build_file).parent
    if fact.kind in _FILE_KINDS:
        path = folder / fact.name
        return "$" not in fact.name and ".." not in path.parts and not _may_exist(version, path)
    if fact.kind is not FactKind.EXECUTABLE or not fact.name.endswith(_SCRIPT_SUFFIXES):
        return False
    stem = PurePosixPath(fact.name).stem
    names = {
        PurePosixPath(path).name for path in version.paths((fact.name, f"{fact.name}.in", stem), folder.as_posix())
    }
    return names.isdisjoint({fact.name, f"{fact.name}.in", stem}) and not version.file(".gitmodules").is_file()


def _may_exist(version: Version, path: PurePosixPath) -> bool:
    """Return whether a version has a file, or does not have its folder, which a submodule or the build may make."""
    return version.file(path.as_posix()).exists() or not version.file(path.parent.as_posix()).is_dir()
