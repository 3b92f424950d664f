"""The command ``bag`` and its subcommands."""

from __future__ import annotations

import argparse
import sys
from functools import partial

from linkwright.cli.bag import description, play, record, rewrite
from linkwright.cli.bag.options import add_storage_argument
from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.diagnostics import print_diagnostics


def configure_info(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bag info``."""
    parser.add_argument("bag", metavar="BAG", help="the folder of a recording, or one .mcap or .db3 file")
    add_storage_argument(parser)
    parser.add_argument("-t", "--topic-name", action="store_true", help="print only the names of the topics")


def run_info(arguments: argparse.Namespace) -> int:
    """Print the contents of a recording."""
    from linkwright.bag import BagReader, summarize_bag

    with BagReader(arguments.bag) as bag:
        print_diagnostics(bag.findings, sys.stderr)
        sys.stdout.write(summarize_bag(bag, topic_names_only=arguments.topic_name))
    return 0


VERBS = {
    "convert": SubVerb(rewrite.configure_convert, rewrite.run_convert, help="rewrite recordings with other settings"),
    "description": SubVerb(
        description.configure_description,
        description.run_description,
        help="print the robot description of a recording, or compare it with a file",
    ),
    "info": SubVerb(configure_info, run_info, help="print the files, times and topics of a recording"),
    "list": SubVerb(
        rewrite.configure_list, rewrite.run_list, help="list the storage formats, converters and compressions"
    ),
    "play": SubVerb(play.configure_play, play.run_play, help="publish the messages of a recording"),
    "record": SubVerb(record.configure_record, record.run_record, help="record topics until Ctrl-C"),
    "reindex": SubVerb(
        rewrite.configure_reindex, rewrite.run_reindex, help="rebuild a recording's metadata from its files"
    ),
}

configure = partial(configure_nested, verbs=VERBS)
run = run_nested
