"""Parsers of launch files in markup languages, and the selection of a parser for a file."""

from __future__ import annotations

import io
import os
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.launch.errors.exceptions import InvalidFrontendLaunchFileError, as_ros_error
from linkwright.launch.errors.locations import error_at
from linkwright.launch.frontend import extensions, grammar
from linkwright.launch.frontend.instantiate import instantiate_action

if TYPE_CHECKING:
    from linkwright.launch.model.action import Action
    from linkwright.launch.model.description import LaunchDescription
    from linkwright.launch.model.markup.entity import Entity
    from linkwright.launch.model.substitution import Substitution


class Parser:
    """A parser that creates actions and substitutions from the entities of a launch file.

    The parser of each language overrides `load`.
    """

    extensions_loaded: ClassVar[bool] = False
    frontend_parsers: ClassVar[dict[str, type[Parser]] | None] = None

    @classmethod
    def load_launch_extensions(cls) -> None:
        """Import the modules that register actions and substitutions.

        The modules are those of Linkwright and of installed packages.
        """
        if Parser.extensions_loaded:
            return
        for _ in extensions.load(extensions.ACTION_GROUP):
            pass
        Parser.extensions_loaded = True

    @classmethod
    def load_parser_implementations(cls) -> None:
        """Load Linkwright's parsers for XML and YAML, and the parsers of installed packages."""
        if Parser.frontend_parsers is not None:
            return
        parsers: dict[str, type[Parser]] = {}
        for name, parser in extensions.load(extensions.PARSER_GROUP):
            parsers.setdefault(name, parser)
        Parser.frontend_parsers = dict(sorted(parsers.items()))

    # --- interface for functions that read tags -------------------------------------------------------------

    def parse_action(self, entity: Entity) -> Action:
        """Return the action that an entity describes."""
        self.load_launch_extensions()
        return instantiate_action(entity, self)

    def parse_substitution(self, value: str) -> list[Substitution]:
        """Parse a text that may contain ``$(...)`` into substitutions."""
        self.load_launch_extensions()
        return grammar.parse_substitution(value)

    def parse_if_substitutions(self, value: Any) -> Any:
        """Return a value with the substitutions in its strings parsed."""
        self.load_launch_extensions()
        return grammar.parse_if_substitutions(value)

    def escape_characters(self, value: str) -> str:
        """Return the text with its backslash escapes resolved."""
        return grammar.replace_escaped_characters(value)

    def parse_description(self, entity: Entity) -> LaunchDescription:
        """Return the launch description of a root entity.

        Raises:
            RuntimeError: LAUNCH109, the root is not named ``launch``.
        """
        from linkwright.launch.model.description import LaunchDescription

        if entity.type_name != "launch":
            ros_error = RuntimeError("Expected 'launch' as root tag")
            message = phrase(
                "the root of a launch file must be 'launch', not '{type_name}'", type_name=entity.type_name
            )
            raise error_at(entity.source_location, "LAUNCH109", message, ros_error=ros_error)
        deprecated = entity.get_attr("deprecated", optional=True)
        entity.get_attr("version", optional=True)  # "version" is the format version in the ROS 2 launch design
        actions = []
        errors = []
        for child in entity.children:
            try:
                actions.append(self.parse_action(child))
            except LinkwrightError as error:  # noqa: PERF203 - independent errors are reported together
                errors.append(error)
        if len(errors) == 1:
            raise errors[0]
        if errors:
            errors[0].diagnostics = tuple(
                diagnostic for child_error in errors for diagnostic in child_error.diagnostics
            )
            raise errors[0]
        entity.assert_entity_completely_parsed()
        return LaunchDescription(actions, deprecated_reason=deprecated)

    # --- choice of the parser for a file ----------------------------------------------------------------------

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the file name extensions that this parser reads, without the leading dot.

        This base class returns an empty set.
        """
        return set()

    @classmethod
    def may_parse(cls, filename: str) -> bool:
        """Return whether a file name has an extension that this parser reads."""
        return any(filename.endswith("." + extension) for extension in cls.get_file_extensions())

    @classmethod
    def get_available_extensions(cls) -> list[str]:
        """Return the names of the available parsers."""
        return list(cls._parsers())

    @classmethod
    def is_extension_valid(cls, extension: str) -> bool:
        """Return whether there is a parser with the given name."""
        warnings.warn("Parser.is_extension_valid is deprecated, use Parser.is_filename_valid instead", stacklevel=2)
        return extension in cls._parsers()

    @classmethod
    def get_parser_from_extension(cls, extension: str) -> type[Parser]:
        """Return the parser with the given name.

        Raises:
            RuntimeError: there is no such parser.
        """
        warnings.warn(
            "Parser.get_parser_from_extension is deprecated, use Parser.get_parsers_from_filename instead",
            stacklevel=2,
        )
        try:
            return cls._parsers()[extension]
        except KeyError:
            raise RuntimeError("Not recognized frontend implementation") from None

    @classmethod
    def is_filename_valid(cls, filename: str) -> bool:
        """Return whether any parser reads files with the given name."""
        return any(parser.may_parse(filename) for parser in cls._parsers().values())

    @classmethod
    def get_parsers_from_filename(cls, filename: str) -> list[type[Parser]]:
        """Return the parsers that read files with the given name."""
        return [parser for parser in cls._parsers().values() if parser.may_parse(filename)]

    @classmethod
    def get_file_extensions_from_parsers(cls) -> set[str]:
        """Return the file name extensions that the available parsers read."""
        return {extension for parser in cls._parsers().values() for extension in parser.get_file_extensions()}

    @classmethod
    def load(cls, file: Any) -> tuple[Entity, Parser]:
        """Return the root entity of a launch file, given as a path or open file, and its parser.

        If the file name does not determine the parser, all parsers are tried.

        Raises:
            InvalidFrontendLaunchFileError: LAUNCH107 to LAUNCH109 and XML codes, the errors in the file.
        """
        name, text = read_file(file)
        candidates = cls.get_parsers_from_filename(name) or _find_parsers_by_suffix(name, cls._parsers())
        errors: list[Exception] = []
        for parser in candidates or cls._parsers().values():
            file_copy = io.StringIO(text)
            file_copy.name = name
            try:
                return parser.load(file_copy)
            except RecursionError:  # no other parser can read a text that is nested too deeply
                raise
            except Exception as error:  # noqa: BLE001 - third-party parsers may raise any exception
                errors.append(error)
        extension = os.path.splitext(name)[1][1:] if cls.is_filename_valid(name) else ""  # noqa: PTH122
        ros_error = InvalidFrontendLaunchFileError(extension, likely_errors=errors)
        raise as_ros_error(ros_error, *_choose_likely_diagnostics(name, text, errors)) from (
            errors[0] if errors else None
        )

    @classmethod
    def _parsers(cls) -> dict[str, type[Parser]]:
        cls.load_parser_implementations()
        assert Parser.frontend_parsers is not None
        return Parser.frontend_parsers


def read_file(file: Any) -> tuple[str, str]:
    """Return the name and text of a path or open file.

    Raises:
        LinkwrightError: LAUNCH101, there is no such file; LAUNCH102, it cannot be read.
    """
    if isinstance(file, (str, bytes, os.PathLike)):
        from linkwright.launch.frontend.python_file import read_launch_file

        source = read_launch_file(Path(os.fsdecode(file)))
        return source.name, source.text
    name = getattr(file, "name", None)
    return name if isinstance(name, str) else "<string>", file.read()


def _choose_likely_diagnostics(name: str, text: str, errors: Sequence[Exception]) -> tuple[Diagnostic, ...]:
    """Return the findings of the parser for the language that an unreadable file probably has.

    If no parser fits, the result is one finding LAUNCH107.
    """
    reports = [error.diagnostics for error in errors if isinstance(error, LinkwrightError)]
    looks_like_xml = text.lstrip().startswith("<")
    for diagnostics in reports:
        if len(reports) == 1 or diagnostics[0].code.startswith("XML") is looks_like_xml:
            return diagnostics
    message = phrase("launch file '{name}' is neither an XML nor a YAML launch file", name=display_path(name))
    return (Diagnostic("LAUNCH107", message),)


def _find_parsers_by_suffix(name: str, parsers: dict[str, type[Parser]]) -> list[type[Parser]]:
    suffix = {".xml": "xml", ".launch": "xml", ".yaml": "yaml", ".yml": "yaml"}.get(os.path.splitext(name)[1])  # noqa: PTH122
    return [parsers[suffix]] if suffix in parsers else []
