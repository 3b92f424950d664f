"""A pytest plugin that brings ``launch_pytest`` to the tests that import it; pytest finds it where the stand-ins are.

It imports nothing else before that, and steps back where the real ``launch_pytest`` is installed.
"""

from __future__ import annotations

import importlib
import sys
from typing import Any

import pytest

_PLUGIN = "launch_pytest"


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known, since a module's own markers are looked at while it is imported."""
    if not config.pluginmanager.has_plugin(_PLUGIN):
        config.addinivalue_line("markers", "launch(fixture, shutdown=False): a test beside a launch (launch_pytest)")


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: Any, name: str, obj: object) -> Any:
    """Register the plugin when the first test is collected after ``launch_pytest`` was imported."""
    module = sys.modules.get(_PLUGIN)
    manager = collector.config.pluginmanager
    if not str(getattr(module, "__file__", "")).endswith(".txt"):  # not imported, or the real one
        return None
    if any(manager.has_plugin(each) or manager.is_blocked(each) for each in (_PLUGIN, f"{_PLUGIN}.plugin")):
        return None
    plugin = importlib.import_module(f"{_PLUGIN}.plugin")

    manager.register(plugin, _PLUGIN)
    return plugin.pytest_pycollect_makeitem(collector, name, obj)
