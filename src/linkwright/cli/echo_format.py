"""The output format of ``topic echo`` and ``service echo``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from linkwright.cli.numbers import unsigned_int
from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, phrase

if TYPE_CHECKING:
    from linkwright.graph.endpoints.base import MessageInfo

SEPARATOR = "---\n"
"""The line between messages."""
_DEFAULT_TRUNCATE_LENGTH = 128


def add_format_arguments(parser: argparse.ArgumentParser, *, flow_help: str) -> None:
    """Declare the format options that `EchoFormat.of` reads.

    Args:
        parser: the parser of the command.
        flow_help: the help text of ``--flow-style``.
    """
    parser.add_argument("--csv", action="store_true", help="print the values separated by commas")
    parser.add_argument("-f", "--full-length", action="store_true", help="do not truncate long arrays and strings")
    parser.add_argument(
        "-l",
        "--truncate-length",
        metavar="N",
        type=unsigned_int,
        default=_DEFAULT_TRUNCATE_LENGTH,
        help="truncate arrays and strings after this many elements (default: %(default)s)",
    )
    parser.add_argument("--no-arr", action="store_true", help="do not print the elements of arrays")
    parser.add_argument("--no-str", action="store_true", help="do not print strings")
    parser.add_argument("--flow-style", action="store_true", help=flow_help)


@dataclass(frozen=True, slots=True)
class EchoFormat:
    """The format in which messages are printed.

    Attributes:
        field: the path of the field to print; empty for the entire message.
        csv: whether to print comma-separated values instead of YAML.
        truncate_length: the length at which arrays and strings are truncated; None to print them completely.
        no_arr: whether to omit the elements of arrays.
        no_str: whether to omit strings.
        flow_style: whether to print each message on one line of YAML.
        message_info: whether to print the times of publication and reception before each message.
    """

    field: tuple[str, ...] = ()
    csv: bool = False
    truncate_length: int | None = _DEFAULT_TRUNCATE_LENGTH
    no_arr: bool = False
    no_str: bool = False
    flow_style: bool = False
    message_info: bool = False

    @classmethod
    def of(
        cls, arguments: argparse.Namespace, field: tuple[str, ...] = (), *, message_info: bool = False
    ) -> EchoFormat:
        """Return the format that the command line requests.

        Args:
            arguments: the parsed options of `add_format_arguments`.
            field: the path of the field to print; empty for the entire message.
            message_info: whether to print the times of publication and reception.
        """
        return cls(
            field=field,
            csv=arguments.csv,
            truncate_length=None if arguments.full_length else arguments.truncate_length,
            no_arr=arguments.no_arr,
            no_str=arguments.no_str,
            flow_style=arguments.flow_style,
            message_info=message_info,
        )

    def format_message(self, message: Any, info: MessageInfo | None = None) -> str:
        """Format a message, given as an object or as bytes.

        Raises:
            LinkwrightError: CLI414, the message has no such field.
        """
        value = select_field(message, self.field)
        if not hasattr(value, "get_fields_and_field_types"):
            return f"{self._format_info(info)}{value}\n{SEPARATOR}"
        from linkwright.messages import to_csv, to_yaml

        if self.csv:
            times = f"{info.source_timestamp},{info.received_timestamp}," if self.message_info and info else ""
            text = to_csv(value, truncate_length=self.truncate_length, no_arr=self.no_arr, no_str=self.no_str)
            return f"{times}{text}\n"
        text = to_yaml(
            value,
            truncate_length=self.truncate_length,
            no_arr=self.no_arr,
            no_str=self.no_str,
            flow_style=self.flow_style,
        )
        return f"{self._format_info(info)}{text}{SEPARATOR}"

    def _format_info(self, info: MessageInfo | None) -> str:
        if not self.message_info or info is None:
            return ""
        return f"received_timestamp: {info.received_timestamp}\nsource_timestamp: {info.source_timestamp}\n{SEPARATOR}"


def parse_field_path(text: str | None) -> tuple[str, ...]:
    """Split the value of ``--field``, such as ``pose.pose.position``, into field names.

    Raises:
        LinkwrightError: CLI414, a name is missing between dots.
    """
    if text is None:
        return ()
    names = tuple(text.split("."))
    if not all(names):
        raise LinkwrightError(
            Diagnostic(
                "CLI414", phrase("Invalid field '{text}'", text=text), hint=phrase("separate names by single dots")
            )
        )
    return names


def select_field(message: Any, path: Sequence[str]) -> Any:
    """Return the value of a field by its path of names.

    Raises:
        LinkwrightError: CLI414, there is no such field.
    """
    value = message
    for name in path:
        fields: dict[str, str] = getattr(value, "get_fields_and_field_types", dict)()
        if name not in fields:
            full_path = ".".join(path)
            type_name = getattr(value, "TYPE_NAME", type(value).__name__)
            fallback_hint = (
                phrase("its fields are {fields}", fields=", ".join(fields)) if fields else phrase("it has no fields")
            )
            raise LinkwrightError(
                Diagnostic(
                    "CLI414",
                    phrase(
                        "Invalid field '{whole}': {type} has no field '{name}'",
                        whole=full_path,
                        type=type_name,
                        name=name,
                    ),
                    hint=did_you_mean(name, fields) or fallback_hint,
                )
            )
        value = getattr(value, name)
    return value
