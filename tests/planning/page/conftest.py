"""Fixtures of the tests of the MotionPlanning display."""

from __future__ import annotations

from tests.viewer.conftest import _isolated_user_state  # noqa: F401  # a fixture
