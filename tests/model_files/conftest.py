"""Fixtures of the model tests: a server of models, and a home folder."""

from __future__ import annotations

import pytest

from tests.model_files.model_server import run_model_server


@pytest.fixture
def model_server():
    with run_model_server() as server:
        yield server


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    for name in ("http_proxy", "https_proxy", "all_proxy"):
        monkeypatch.delenv(name, raising=False)
        monkeypatch.delenv(name.upper(), raising=False)
    return tmp_path / "data" / "linkwright" / "models"
