"""Substitutions for paths and for the contents of files."""

from __future__ import annotations

import os
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from linkwright.diagnostics import Phrase, did_you_mean, foreign, phrase
from linkwright.files.input_files import read_text
from linkwright.launch.errors.exceptions import SubstitutionFailure
from linkwright.launch.errors.places import error_at
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.declared_substitution import (
    DeclaredSubstitution,
    TextLists,
    Texts,
)
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    perform_substitutions,
)

IN_PROCESS_PROGRAMS = frozenset({"xacro"})
"""Programs that `Command` runs in this process and that need not be installed."""

_LAUNCH_STEMS = ("", ".launch", "_launch")
_LAUNCH_SUFFIXES = (".py", ".xml", ".yaml")


class PathSubstitution(DeclaredSubstitution, shown="Path({path})"):
    """A path.

    The operator ``/`` appends a part: ``PathSubstitution("a") / "b"``.
    """

    path: Texts = Texts()

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, other])

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return perform_substitutions(context, self.path)


class PathJoinSubstitution(DeclaredSubstitution, tag="path-join", shown="PathJoin({substitutions})"):
    """Parts of a path, joined with the system's separator.

    The operator ``/`` appends a part: ``PathJoinSubstitution(["a"]) / "b"``.
    """

    substitutions: TextLists = TextLists(
        read=lambda given: [given] if isinstance(given, (str, Substitution)) else given
    )

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
        """Return the class and its keyword arguments for the parts.

        Raises:
            ValueError: there are no parts.
        """
        if not data:
            raise ValueError("path-join substitution expects at least 1 argument")
        return cls, {"substitutions": data}

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.substitutions, other])

    def perform(self, context: LaunchContext) -> str:
        """Return the joined path."""
        return os.path.join(*(perform_substitutions(context, part) for part in self.substitutions))  # noqa: PTH118


class FindExecutable(DeclaredSubstitution, tag="find-exec", shown="FindExec({name})"):
    """The path of a program on ``PATH``.

    xacro and programs that a Linkwright node replaces need not be installed. In that case, the result is the bare name
    of the program.
    """

    name: Texts = Texts(kw_only=True)

    def perform(self, context: LaunchContext) -> str:
        """Return the path.

        Raises:
            SubstitutionFailure: LAUNCH124, there is no such program.
        """
        name = perform_substitutions(context, self.name)
        path = shutil.which(name, path=context.environment.get("PATH"))
        if path is not None:
            return path
        from linkwright.launch.model.replaced_programs import replaced_programs

        known = IN_PROCESS_PROGRAMS | replaced_programs().keys()
        if name in known:
            return name
        hint = did_you_mean(name, known) or phrase("install it, or add its folder to PATH")
        ros_error = SubstitutionFailure(f"executable '{name}' not found on the PATH")
        raise error_at(
            self.place, "LAUNCH124", phrase("executable '{name}' is not on PATH", name=name), hint, ros_error=ros_error
        )


class FileContent(DeclaredSubstitution, tag="file-content"):
    """The contents of a text file."""

    path: Texts = Texts()

    def perform(self, context: LaunchContext) -> str:
        """Read the file, and return its text.

        Raises:
            SubstitutionFailure: LAUNCH125, the file cannot be read.
        """
        path = perform_substitutions(context, self.path)
        try:
            return read_text(path)
        except FileNotFoundError as error:
            ros_error = SubstitutionFailure(f"File not found: {path}")
            raise error_at(
                self.place, "LAUNCH125", phrase("file '{path}' does not exist", path=path), ros_error=ros_error
            ) from error
        except (OSError, UnicodeDecodeError) as error:
            ros_error = SubstitutionFailure(f"Failed to open file: {path}")
            message = phrase("file '{path}' cannot be read: {error}", path=path, error=foreign(error))
            raise error_at(self.place, "LAUNCH125", message, ros_error=ros_error) from error


class FindLaunchfile(DeclaredSubstitution, tag="find-launchfile", shown="FindLaunchfile(name={name}, path={path})"):
    """The path of the launch file with a given name in a folder, in any language.

    Args:
        name: the name of the file, or its stem without ``.launch``, ``_launch`` and the extension.
        path: the folder.
    """

    name: Texts = Texts(kw_only=True)
    path: Texts = Texts(kw_only=True)

    def perform(self, context: LaunchContext) -> str:
        """Return the path.

        Raises:
            SubstitutionFailure: LAUNCH125, there is no such file, or there are several.
        """
        name = perform_substitutions(context, self.name)
        folder = Path(perform_substitutions(context, self.path))
        if not folder.is_dir():
            raise self._failure(phrase("'{folder}' is not a folder", folder=folder))
        files = sorted(file for file in folder.iterdir() if file.is_file() and file.suffix in _LAUNCH_SUFFIXES)
        found = [
            file for file in files if file.name == name or file.stem in [name + ending for ending in _LAUNCH_STEMS]
        ]
        if len(found) == 1:
            return str(found[0])
        if found:
            listed = ", ".join(file.name for file in found)
            raise self._failure(
                phrase(
                    "several launch files '{name}' are in '{folder}': {listed}", name=name, folder=folder, listed=listed
                )
            )
        raise self._failure(
            phrase("no launch file '{name}' is in '{folder}'", name=name, folder=folder),
            did_you_mean(name, [file.name for file in files]),
        )

    def _failure(self, message: Phrase, hint: Phrase | None = None) -> Exception:
        return error_at(self.place, "LAUNCH125", message, hint, ros_error=SubstitutionFailure(message))
