"""``linkwright bag convert``, ``reindex`` and ``list``: rewrite recordings, list plugins."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import NamedTuple

from linkwright.cli.bag.options import add_storage_argument

_USAGE_ERROR = 2


class _Plugin(NamedTuple):
    name: str
    type_name: str
    base: str
    description: str


_PLUGINS = {
    "storage": (
        _Plugin(
            "mcap",
            "rosbag2_storage_plugins::MCAPStorage",
            "rosbag2_storage::storage_interfaces::ReadWriteInterface",
            "recordings as MCAP files",
        ),
        _Plugin(
            "sqlite3",
            "rosbag2_storage_plugins::SqliteStorage",
            "rosbag2_storage::storage_interfaces::ReadWriteInterface",
            "recordings as SQLite databases",
        ),
    ),
    "converter": (),
    "compressor": (
        _Plugin(
            "zstd",
            "rosbag2_compression_zstd::ZstdCompressor",
            "rosbag2_compression::BaseCompressorInterface",
            "compression by Zstandard",
        ),
    ),
    "decompressor": (
        _Plugin(
            "zstd",
            "rosbag2_compression_zstd::ZstdDecompressor",
            "rosbag2_compression::BaseDecompressorInterface",
            "decompression by Zstandard",
        ),
    ),
}
"""Linkwright's equivalents of rosbag2's plugins, by the kinds of ``ros2 bag list``.

CDR needs no converter.
"""


def configure_convert(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bag convert``."""
    parser.add_argument(
        "-i",
        "--input",
        metavar=("BAG", "STORAGE"),
        nargs="+",
        action="append",
        required=True,
        help="a recording to read and its format, which is detected if omitted; may be repeated",
    )
    parser.add_argument(
        "-o",
        "--output-options",
        metavar="FILE",
        required=True,
        help="a YAML file with the key output_bags: the options of each recording to write",
    )


def run_convert(arguments: argparse.Namespace) -> int:
    """Convert recordings as specified by the file with the output options."""
    from linkwright.bag.rewriting import rewrite

    for input_arguments in arguments.input:
        if len(input_arguments) > 2:
            print(
                f"linkwright bag convert: --input expects 1 or 2 arguments, {len(input_arguments)} provided",
                file=sys.stderr,
            )
            return _USAGE_ERROR
    rewrite([words[0] for words in arguments.input], arguments.output_options)
    return 0


def configure_reindex(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bag reindex``."""
    parser.add_argument("bag", metavar="BAG", type=Path, help="the folder of a recording")
    add_storage_argument(parser)


def run_reindex(arguments: argparse.Namespace) -> int:
    """Rebuild the metadata of a recording."""
    from linkwright.bag.reindexing import reindex

    if not arguments.bag.is_dir():
        print("linkwright bag reindex: must specify a bag directory", file=sys.stderr)
        return _USAGE_ERROR
    reindex(arguments.bag)
    return 0


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bag list``."""
    parser.add_argument("kind", metavar="KIND", choices=_PLUGINS, help="storage, converter, compressor or decompressor")
    parser.add_argument("-v", "--verbose", action="store_true", help="also describe each entry")


def run_list(arguments: argparse.Namespace) -> int:
    """Print Linkwright's equivalents of rosbag2's plugins of the requested kind."""
    if arguments.verbose:
        print(f"available {arguments.kind} plugins are:")
    for plugin in _PLUGINS[arguments.kind]:
        print(f"{'name: ' if arguments.verbose else ''}{plugin.name}")
        if arguments.verbose:
            print(f"\t{plugin.description}\n\ttype: {plugin.type_name}\n\tbase_class: {plugin.base}")
    return 0
