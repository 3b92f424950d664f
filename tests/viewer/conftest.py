from __future__ import annotations

import pytest


@pytest.fixture(autouse=True)
def _state_of_the_user(tmp_path, monkeypatch):
    """Keep the list of opened files separate from the user's."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
