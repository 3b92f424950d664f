"""Fixtures of the viewer tests: a state folder of their own."""

from __future__ import annotations

import pytest


@pytest.fixture(autouse=True)
def _isolated_user_state(tmp_path, monkeypatch):
    """Keep the list of opened files separate from the user's."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
