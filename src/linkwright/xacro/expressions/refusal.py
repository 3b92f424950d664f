"""The error for operations that expressions may not use."""

from __future__ import annotations


class RefusalError(Exception):
    """An expression tried something that expressions may not do."""
