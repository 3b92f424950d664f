"""Parsers for the numbers in command-line options."""

from __future__ import annotations

import argparse


def positive_int(text: str) -> int:
    """Parse a positive integer.

    Raises:
        argparse.ArgumentTypeError: the text is not a positive integer.
    """
    value = unsigned_int(text)
    if value == 0:
        raise argparse.ArgumentTypeError("value must be a positive integer")
    return value


def unsigned_int(text: str) -> int:
    """Parse a non-negative integer.

    Raises:
        argparse.ArgumentTypeError: the text is not a non-negative integer.
    """
    if text.isascii() and text.isdigit():
        return int(text)
    raise argparse.ArgumentTypeError("value must be non-negative integer")


def positive_float(text: str) -> float:
    """Parse a positive number.

    Raises:
        argparse.ArgumentTypeError: the text is not a positive number.
    """
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError("value must be positive")
    return value


def fraction(text: str) -> float:
    """Parse a number from 0 to 1.

    Raises:
        argparse.ArgumentTypeError: the text is not a number from 0 to 1.
    """
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value <= 1.0:
        raise argparse.ArgumentTypeError("value must be from 0 to 1")
    return value
