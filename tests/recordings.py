"""Conditions for reading and writing recordings."""

from __future__ import annotations

from importlib.util import find_spec

import pytest

needs_rosbags = pytest.mark.skipif(
    find_spec("rosbags") is None, reason="rosbags is not installed: it has no wheel for Python 3.15"
)
"""Marks tests that write or read recordings."""
