"""What an expression may not do."""

from __future__ import annotations


class RefusalError(Exception):
    """An expression tried something that expressions may not do."""
