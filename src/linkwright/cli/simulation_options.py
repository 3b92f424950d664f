"""The options that ``linkwright sim`` and ``linkwright drive`` have both."""

from __future__ import annotations

import argparse


def add_simulation_options(parser: argparse.ArgumentParser) -> None:
    """Declare whether there is a page, how long simulated time goes on, and how fast."""
    parser.add_argument("--headless", action="store_true", help="without a page")
    parser.add_argument(
        "--seconds", metavar="S", type=positive, default=0.0, help="end after so many simulated seconds"
    )
    parser.add_argument(
        "--rate",
        metavar="FACTOR",
        type=_rate,
        default=0.0,
        help="simulated seconds in a real one, or max (default: as the world says)",
    )


def positive(text: str) -> float:
    """A positive number of seconds.

    Raises:
        argparse.ArgumentTypeError: it is none.
    """
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"'{text}' is not a positive number of seconds")
    return value


def _rate(text: str) -> float:
    if text == "max":
        return -1.0
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < 1e6:
        raise argparse.ArgumentTypeError(f"'{text}' is neither a positive number nor max")
    return value
