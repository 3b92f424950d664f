from __future__ import annotations

import pytest


@pytest.fixture(autouse=True)
def _state_of_the_user(tmp_path, monkeypatch):
    """What is remembered of files that were opened is not the user's own."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
