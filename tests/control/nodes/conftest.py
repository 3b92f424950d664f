"""Fixtures of the tests of teleoperation nodes."""

from __future__ import annotations

from tests.nodes.conftest import clock, graph, harness, log, logged  # noqa: F401  # fixtures
