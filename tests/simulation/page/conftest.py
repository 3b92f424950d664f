"""Fixtures of the tests of simulation panels."""

from __future__ import annotations

from tests.viewer.conftest import _isolated_user_state  # noqa: F401  # a fixture
