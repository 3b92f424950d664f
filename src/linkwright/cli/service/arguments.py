"""An argument that the verbs for services share."""

from __future__ import annotations

import argparse


def add_hidden_argument(parser: argparse.ArgumentParser) -> None:
    """Declare ``--include-hidden-services``, which may stand before the verb too."""
    parser.add_argument(
        "--include-hidden-services",
        "-a",
        "--all",
        action="store_true",
        default=argparse.SUPPRESS,
        help="consider hidden services as well",
    )
