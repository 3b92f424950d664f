"""A pytest plugin, with which tests import ``rclpy``, ``launch`` and messages as in ROS 2.

A plain ``python -m pytest`` is sufficient: pytest loads the plugin in every environment that has Linkwright. It
provides the modules that a shell of Linkwright adds to ``PYTHONPATH``, and imports nothing before a test does. If a
real rclpy is installed, it provides nothing.
"""

from __future__ import annotations

import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

_STARTUP = Path(__file__).parent / "standins" / "startup"
_LINTER_MARKERS = {
    "linter": "a check of style",
    "copyright": "a check of the headers of files",
    "flake8": "a check by flake8",
    "pep257": "a check of docstrings",
}
"""Markers of the tests that ``ros2 pkg create`` writes. In ROS the linters' own plugins declare them."""


def offer_stand_ins() -> None:
    """Make ``rclpy``, messages and other stand-ins importable, as in a shell of Linkwright."""
    if str(_STARTUP) in sys.path:
        return
    sys.path.append(str(_STARTUP))
    loader = SourceFileLoader("linkwright_startup", str(_STARTUP / "sitecustomize.py"))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None
    loader.exec_module(module_from_spec(spec))


offer_stand_ins()  # before pytest imports a conftest.py


def pytest_addoption(pluginmanager: pytest.PytestPluginManager) -> None:
    """Register the plugin of launch_pytest and launch_testing early enough to add its options."""
    if not pluginmanager.has_plugin("linkwright_pytest"):
        pluginmanager.import_plugin("linkwright_pytest")


def pytest_configure(config: pytest.Config) -> None:
    """Register the linters' markers."""
    for name, meaning in _LINTER_MARKERS.items():
        config.addinivalue_line("markers", f"{name}: {meaning}")
