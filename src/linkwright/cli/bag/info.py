"""``linkwright bag info``: what a recording holds."""

from __future__ import annotations

import argparse
import sys

from linkwright.cli.bag.storage import add_storage_argument
from linkwright.diagnostics import print_diagnostics

HELP = "print files, times and topics of a recording"


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("bag", metavar="BAG", help="the folder of a recording, or one .mcap or .db3 file")
    add_storage_argument(parser)
    parser.add_argument("-t", "--topic-name", action="store_true", help="only the names of the topics")


def run(arguments: argparse.Namespace) -> int:
    """Print it."""
    from linkwright.bag import BagReader, summary_text

    with BagReader(arguments.bag) as bag:
        if bag.finding is not None:
            print_diagnostics([bag.finding], sys.stderr)
        sys.stdout.write(summary_text(bag, topic_names_only=arguments.topic_name))
    return 0
