"""Kinds of numbers that options take."""

from __future__ import annotations

import argparse


def positive_int(text: str) -> int:
    """A whole number above nothing.

    Raises:
        argparse.ArgumentTypeError: when it is none.
    """
    value = unsigned_int(text)
    if value == 0:
        raise argparse.ArgumentTypeError("value must be a positive integer")
    return value


def unsigned_int(text: str) -> int:
    """A whole number that is not negative.

    Raises:
        argparse.ArgumentTypeError: when it is none.
    """
    if text.isascii() and text.isdigit():
        return int(text)
    raise argparse.ArgumentTypeError("value must be non-negative integer")


def positive_float(text: str) -> float:
    """A number above nothing.

    Raises:
        argparse.ArgumentTypeError: when it is none.
    """
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError("value must be positive")
    return value


def share(text: str) -> float:
    """A number from 0 to 1.

    Raises:
        argparse.ArgumentTypeError: when it is none.
    """
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= 1.0:
        raise argparse.ArgumentTypeError("value must be from 0 to 1")
    return value
