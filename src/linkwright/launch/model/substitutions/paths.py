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
from linkwright.launch.errors.locations import error_at
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
"""Programs that `Command` runs in the launcher's process, and that need not be installed."""

_LAUNCH_STEMS = ("", ".launch", "_launch")
_LAUNCH_SUFFIXES = (".py", ".xml", ".yaml")


class PathSubstitution(DeclaredSubstitution, shown="Path({path})"):
    """A path.

    The operator ``/`` appends a component: ``PathSubstitution("a") / "b"``.
    """

    path: Texts = Texts()

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, other])

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        return perform_substitutions(context, self.path)


class PathJoinSubstitution(DeclaredSubstitution, tag="path-join", shown="PathJoin({substitutions})"):
    """The components of a path, joined with the system's separator.

    The operator ``/`` appends a component: ``PathJoinSubstitution(["a"]) / "b"``.
    """

    substitutions: TextLists = TextLists(
        read=lambda paths: [paths] if isinstance(paths, (str, Substitution)) else paths
    )

    @classmethod
    def parse(cls, data: Sequence[Any]) -> tuple[Any, dict[str, Any]]:
        """Return the class and keyword arguments for the components.

        Raises:
            ValueError: there are no components.
        """
        if not data:
            raise ValueError("path-join substitution expects at least 1 argument")
        return cls, {"substitutions": data}

    def __truediv__(self, other: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([*self.substitutions, other])

    def perform(self, context: LaunchContext) -> str:
        """Return the joined path."""
        return os.path.join(*(perform_substitutions(context, component) for component in self.substitutions))  # noqa: PTH118


class FindExecutable(DeclaredSubstitution, tag="find-exec", shown="FindExec({name})"):
    """The path of a program on ``PATH``.

    xacro and programs that a Linkwright node replaces need not be installed. For these, the result is the bare name of
    the program if it is not on ``PATH``.
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
        from linkwright.launch.model.replaced_programs import load_replaced_programs

        replaceable_programs = IN_PROCESS_PROGRAMS | load_replaced_programs().keys()
        if name in replaceable_programs:
            return name
        hint = did_you_mean(name, replaceable_programs) or phrase("install it, or add its folder to PATH")
        ros_error = SubstitutionFailure(f"executable '{name}' not found on the PATH")
        raise error_at(
            self.source_location,
            "LAUNCH124",
            phrase("program '{name}' is not on PATH", name=name),
            hint,
            ros_error=ros_error,
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
                self.source_location,
                "LAUNCH125",
                phrase("file '{path}' does not exist", path=path),
                ros_error=ros_error,
            ) from error
        except (OSError, UnicodeDecodeError) as error:
            ros_error = SubstitutionFailure(f"Failed to open file: {path}")
            message = phrase("file '{path}' cannot be read: {error}", path=path, error=foreign(error))
            raise error_at(self.source_location, "LAUNCH125", message, ros_error=ros_error) from error


class FindLaunchfile(DeclaredSubstitution, tag="find-launchfile", shown="FindLaunchfile(name={name}, path={path})"):
    """The path of the launch file with a given name in a folder, in Python, XML or YAML.

    Args:
        name: the name of the file, or its stem without ``.launch``, ``_launch`` and the extension.
        path: the folder.
    """

    name: Texts = Texts(kw_only=True)
    path: Texts = Texts(kw_only=True)

    def perform(self, context: LaunchContext) -> str:
        """Return the path.

        Raises:
            SubstitutionFailure: LAUNCH125, the folder does not exist, or contains no such file or several.
        """
        name = perform_substitutions(context, self.name)
        folder = Path(perform_substitutions(context, self.path))
        if not folder.is_dir():
            raise self._create_error(phrase("'{folder}' is not a folder", folder=folder))
        files = sorted(file for file in folder.iterdir() if file.is_file() and file.suffix in _LAUNCH_SUFFIXES)
        matching_files = [
            file
            for file in files
            if file.name == name or file.stem in [name + stem_ending for stem_ending in _LAUNCH_STEMS]
        ]
        if len(matching_files) == 1:
            return str(matching_files[0])
        if matching_files:
            names_text = ", ".join(file.name for file in matching_files)
            raise self._create_error(
                phrase(
                    "folder '{folder}' has several launch files '{name}': {paths}",
                    name=name,
                    folder=folder,
                    paths=names_text,
                )
            )
        raise self._create_error(
            phrase("folder '{folder}' has no launch file '{name}'", name=name, folder=folder),
            did_you_mean(name, [file.name for file in files]),
        )

    def _create_error(self, message: Phrase, hint: Phrase | None = None) -> Exception:
        return error_at(self.source_location, "LAUNCH125", message, hint, ros_error=SubstitutionFailure(message))
