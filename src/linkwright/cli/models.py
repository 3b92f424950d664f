"""``linkwright models``: download, verify and remove trained models for speech and vision."""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINE, print_message
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.progress import ProgressLine
from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase, term
from linkwright.diagnostics.translation import localized

if TYPE_CHECKING:
    from linkwright.model_files import ModelEntry

_BAR_WIDTH = 30
_BYTES_PER_MB = 1_000_000


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``models list``."""
    parser.add_argument("--json", action="store_true", help="print all properties of each model as a JSON list")


def run_list(arguments: argparse.Namespace) -> int:
    """Print the available models, and whether each is downloaded."""
    from linkwright.model_files import is_installed, model_table, models_folder

    if arguments.json:
        rows = [
            {
                "name": entry.name,
                "kind": entry.kind,
                "megabytes": entry.megabytes,
                "license": entry.license,
                "address": entry.address,
                "purpose": entry.purpose,
                "path": str(models_folder() / entry.installed_name) if is_installed(entry) else None,
            }
            for entry in model_table().values()
        ]
        print(json.dumps(rows, indent=2, ensure_ascii=False))
        return FINE
    width = max(map(len, model_table()))
    for entry in model_table().values():
        state = phrase("downloaded") if is_installed(entry) else phrase("not downloaded")
        size = f"{entry.megabytes} MB"
        print(
            f"{entry.name:{width}}  {entry.kind:6}  {size:>6}  {entry.license}  {localized(state)}: "
            f"{localized(term(entry.purpose))}"
        )
    return FINE


def configure_get(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``models get``."""
    _add_name_argument(parser)
    parser.add_argument(
        "--from",
        dest="source",
        metavar="SOURCE",
        help="a file or folder that contains the model, or the address of a mirror (default: the publisher's address)",
    )
    parser.add_argument(
        "--to", metavar="FOLDER", type=Path, help="store the model in this folder, which Linkwright does not search"
    )


def run_get(arguments: argparse.Namespace) -> int:
    """Download a model, and print its path."""
    from linkwright.model_files import install, is_installed, model_entry, models_folder

    entry = model_entry(arguments.name)
    folder: Path = arguments.to or models_folder()
    if is_installed(entry, folder):
        path = folder / entry.installed_name
        if not _verify_checksums(entry, path):
            print(path)
            return FINE
        print_message(localized(phrase("'{path}' is incomplete or modified, so it is downloaded again", path=path)))
    print_message(
        localized(
            phrase(
                "{name}: about {megabytes} MB from {source}, license {license}",
                name=entry.name,
                megabytes=entry.megabytes,
                source=arguments.source or entry.address,
                license=entry.license,
            )
        )
    )
    line = ProgressLine()
    try:
        path = install(
            entry,
            arguments.source,
            arguments.to,
            lambda received_bytes, total: line.show(_format_progress(entry, received_bytes, total)),
        )
    finally:
        line.end()
    print(path)
    return FINE


def _format_progress(entry: ModelEntry, done_bytes: int, total_bytes: int | None) -> Phrase:
    size = total_bytes or entry.megabytes * _BYTES_PER_MB
    filled_width = min(_BAR_WIDTH, done_bytes * _BAR_WIDTH // max(size, 1))
    return phrase(
        "{bar} {done} of {total} MB",
        bar="#" * filled_width + "." * (_BAR_WIDTH - filled_width),
        done=f"{done_bytes / _BYTES_PER_MB:.1f}",
        total=f"{size / _BYTES_PER_MB:.1f}",
    )


def configure_path(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``models path``."""
    _add_name_argument(parser)


def run_path(arguments: argparse.Namespace) -> int:
    """Print the path of a downloaded model."""
    from linkwright.model_files import find_model, model_entry

    print(find_model(model_entry(arguments.name)))
    return FINE


def configure_check(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``models check``."""
    parser.add_argument("names", metavar="MODEL", nargs="*", help="the models' names (default: all downloaded models)")


def run_check(arguments: argparse.Namespace) -> int:
    """Verify the checksums of downloaded models."""
    from linkwright.model_files import find_model, is_installed, model_entry, model_table

    entries = [model_entry(name) for name in arguments.names]
    diagnostics: list[Diagnostic] = []
    for entry in entries or [entry for entry in model_table().values() if is_installed(entry)]:
        problems = _verify_checksums(entry, find_model(entry))
        diagnostics += problems
        if not problems:
            print(localized(phrase("{name}: verified", name=entry.name)))
    if diagnostics:
        raise LinkwrightError(*diagnostics)
    return FINE


def _verify_checksums(entry: ModelEntry, path: Path) -> Sequence[Diagnostic]:
    from linkwright.model_files import verify

    try:
        verify(entry, path)
    except LinkwrightError as error:
        return error.diagnostics
    return ()


def configure_remove(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``models remove``."""
    _add_name_argument(parser)


def run_remove(arguments: argparse.Namespace) -> int:
    """Remove a downloaded model."""
    from linkwright.model_files import model_entry, remove

    print(localized(phrase("Removed {path}", path=remove(model_entry(arguments.name)))))
    return FINE


def _add_name_argument(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", metavar="MODEL", help="the model's name, as `linkwright models list` prints it")


VERBS = {
    "list": SubVerb(configure_list, run_list, help="list the available models with size, license and purpose"),
    "get": SubVerb(configure_get, run_get, help="download a model, or copy it from a file, a folder or a mirror"),
    "path": SubVerb(configure_path, run_path, help="print the path of a downloaded model"),
    "check": SubVerb(configure_check, run_check, help="verify the checksums of downloaded models"),
    "remove": SubVerb(configure_remove, run_remove, help="remove a model"),
}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the subcommands of ``models``."""
    configure_nested(parser, VERBS)


def run(arguments: argparse.Namespace) -> int:
    """Run the requested subcommand."""
    return run_nested(arguments)
