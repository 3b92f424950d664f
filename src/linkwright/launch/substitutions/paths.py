"""Substitutions that give paths and what is in files."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import did_you_mean
from linkwright.launch.context import LaunchContext
from linkwright.launch.frontend.expose import expose_substitution
from linkwright.launch.places import error_at
from linkwright.launch.substitution import (
    Parsed,
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    describe,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

IN_PROCESS_PROGRAMS = frozenset({"xacro"})
"""Programs that `Command` runs inside this process, so that they need not be installed."""

_LAUNCH_STEMS = ("", ".launch", "_launch")
_LAUNCH_SUFFIXES = (".py", ".xml", ".yaml")


class PathSubstitution(Substitution):
    """A path. With ``/`` it gives a path below it: ``PathSubstitution("a") / "b"``."""

    def __init__(self, path: SomeSubstitutionsType | Path) -> None:
        self._path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """The path, as substitutions."""
        return self._path

    def describe(self) -> str:
        """The path."""
        return f"Path({describe(self._path)})"

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, other])

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return perform_substitutions(context, self._path)


@expose_substitution("path-join")
class PathJoinSubstitution(Substitution):
    """Parts of a path, joined with the separator of the system.

    Also written with the ``/`` operator: ``PathJoinSubstitution(["a"]) / "b"``.
    """

    def __init__(self, substitutions: Iterable[SomeSubstitutionsType]) -> None:
        if isinstance(substitutions, (str, Substitution)):
            substitutions = [substitutions]
        self._parts = [normalize_to_list_of_substitutions(part) for part in substitutions]

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[type[Substitution], dict[str, Any]]:
        """The class and its arguments, for the parts.

        Raises:
            ValueError: there are none.
        """
        if not data:
            raise ValueError("path-join substitution expects at least 1 argument")
        return cls, {"substitutions": data}

    @property
    def substitutions(self) -> list[list[Substitution]]:
        """The parts."""
        return self._parts

    def describe(self) -> str:
        """The parts."""
        return f"PathJoin({', '.join(describe(part) for part in self._parts)})"

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self._parts, other])

    def perform(self, context: LaunchContext) -> str:
        """The path."""
        return os.path.join(*(perform_substitutions(context, part) for part in self._parts))  # noqa: PTH118


@expose_substitution("find-exec")
class FindExecutable(Parsed, Substitution):
    """The path of a program on ``PATH``.

    A program that `Command` runs inside this process is found even where it is not installed: then its bare
    name is given.
    """

    PARSED_AS = "find-exec"
    ARGUMENTS = ("name",)

    def __init__(self, *, name: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    def describe(self) -> str:
        """The name."""
        return f"FindExec({describe(self._name)})"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            SubstitutionFailure: LAUNCH124, if there is no such program.
        """
        name = perform_substitutions(context, self._name)
        path = shutil.which(name, path=context.environment.get("PATH"))
        if path is not None:
            return path
        if name in IN_PROCESS_PROGRAMS:
            return name
        hint = did_you_mean(name, IN_PROCESS_PROGRAMS) or "install it, or add its folder to PATH"
        promised = SubstitutionFailure(f"executable '{name}' not found on the PATH")
        raise error_at(self.place, "LAUNCH124", f"executable '{name}' is not on PATH", hint, promises=promised)


@expose_substitution("file-content")
class FileContent(Parsed, Substitution):
    """What is in a text file."""

    PARSED_AS = "file-content"
    ARGUMENTS = ("path",)

    def __init__(self, path: SomeSubstitutionsType | Path) -> None:
        self._path = normalize_to_list_of_substitutions(path)

    @property
    def path(self) -> list[Substitution]:
        """The path, as substitutions."""
        return self._path

    def describe(self) -> str:
        """The path."""
        return f"FileContent({describe(self._path)})"

    def perform(self, context: LaunchContext) -> str:
        """The text.

        Raises:
            SubstitutionFailure: LAUNCH125, if the file cannot be read.
        """
        path = perform_substitutions(context, self._path)
        try:
            return Path(path).read_text(encoding="utf-8")
        except FileNotFoundError as error:
            promised = SubstitutionFailure(f"File not found: {path}")
            raise error_at(self.place, "LAUNCH125", f"file '{path}' does not exist", promises=promised) from error
        except (OSError, UnicodeDecodeError) as error:
            promised = SubstitutionFailure(f"Failed to open file: {path}")
            message = f"file '{path}' cannot be read: {error}"
            raise error_at(self.place, "LAUNCH125", message, promises=promised) from error


@expose_substitution("find-launchfile")
class FindLaunchfile(Parsed, Substitution):
    """The path of the launch file of a name in a folder, whatever its kind.

    Args:
        name: the name of the file, or its beginning, without ``.launch``, ``_launch`` and the ending.
        path: the folder.
    """

    PARSED_AS = "find-launchfile"
    ARGUMENTS = ("name", "path")

    def __init__(self, *, name: SomeSubstitutionsType, path: SomeSubstitutionsType) -> None:
        self._name = normalize_to_list_of_substitutions(name)
        self._path = normalize_to_list_of_substitutions(path)

    @property
    def name(self) -> list[Substitution]:
        """The name, as substitutions."""
        return self._name

    @property
    def path(self) -> list[Substitution]:
        """The folder, as substitutions."""
        return self._path

    def describe(self) -> str:
        """Name and folder."""
        return f"FindLaunchfile(name={describe(self._name)}, path={describe(self._path)})"

    def perform(self, context: LaunchContext) -> str:
        """The path.

        Raises:
            SubstitutionFailure: LAUNCH125, if there is no such file, or more than one.
        """
        name = perform_substitutions(context, self._name)
        folder = Path(perform_substitutions(context, self._path))
        if not folder.is_dir():
            raise self._failure(f"'{folder}' is no folder")
        files = sorted(file for file in folder.iterdir() if file.is_file() and file.suffix in _LAUNCH_SUFFIXES)
        found = [
            file for file in files if file.name == name or file.stem in [name + ending for ending in _LAUNCH_STEMS]
        ]
        if len(found) == 1:
            return str(found[0])
        if found:
            listed = ", ".join(file.name for file in found)
            raise self._failure(f"several launch files '{name}' are in '{folder}': {listed}")
        raise self._failure(
            f"no launch file '{name}' is in '{folder}'", did_you_mean(name, [file.name for file in files])
        )

    def _failure(self, message: str, hint: str | None = None) -> Exception:
        return error_at(self.place, "LAUNCH125", message, hint, promises=SubstitutionFailure(message))
