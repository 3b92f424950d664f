"""A pytest plugin that provides ``launch_pytest`` and ``launch_testing`` to tests.

pytest finds the plugin in the folder of the stand-ins. The plugin does nothing if the real packages are installed, and
imports other modules only when needed.
"""

from __future__ import annotations

import importlib
import sys
from importlib.machinery import PathFinder
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

_PLUGIN_PACKAGE = "launch_pytest"
_HOOKS_MODULE = "launch_testing.pytest.hooks"
_DESCRIPTION_FUNCTION = b"generate_test_description"
_MARKERS = (
    "launch(fixture, shutdown=False): a test beside a launch (launch_pytest)",
    "launch_test: mark of generate_test_description of a file of launch tests (launch_testing)",
    "rostest: the same for launch_testing_ros",
)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Register the command-line option of launch_testing."""
    if not _is_real("launch_testing"):
        parser.addoption("--launch-args", action="append", nargs="*", default=[], help="arguments of launch tests")


def pytest_addhooks(pluginmanager: pytest.PytestPluginManager) -> None:
    """Register the hook of launch_testing for ``conftest.py`` files."""
    if not _is_real("launch_testing"):
        pluginmanager.add_hookspecs(_Hooks)


def pytest_configure(config: pytest.Config) -> None:
    """Register the markers, because pytest checks a module's markers during its import."""
    for marker in _MARKERS:
        config.addinivalue_line("markers", marker)


class _Hooks:
    @pytest.hookspec(firstresult=True)
    def pytest_launch_collect_makemodule(self, path: Path, parent: pytest.Collector, entrypoint: object) -> Any:
        """Return a collector for the launch test in a file."""


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> Any:
    """Collect a file as one launch test if the marker of its description function requests it."""
    if _is_real("launch_testing") or _DESCRIPTION_FUNCTION not in module_path.read_bytes():
        return None
    return importlib.import_module(_HOOKS_MODULE)._collect_marked(module_path, parent)


@pytest.hookimpl(tryfirst=True)
def pytest_pycollect_makeitem(collector: Any, name: str, obj: object) -> Any:
    """Register the plugin of ``launch_pytest`` after a test module has imported the package."""
    manager = collector.config.pluginmanager
    if not _is_stand_in(sys.modules.get(_PLUGIN_PACKAGE)):
        return None
    if any(
        manager.has_plugin(plugin_name) or manager.is_blocked(plugin_name)
        for plugin_name in (_PLUGIN_PACKAGE, f"{_PLUGIN_PACKAGE}.plugin")
    ):
        return None
    plugin = importlib.import_module(f"{_PLUGIN_PACKAGE}.plugin")

    manager.register(plugin, _PLUGIN_PACKAGE)
    return plugin.pytest_pycollect_makeitem(collector, name, obj)


def _is_stand_in(module: ModuleType | None) -> bool:
    return str(getattr(module, "__file__", "")).endswith(".txt")


def _is_real(package: str) -> bool:
    """Return whether the real package is installed and takes precedence over the stand-in."""
    spec = PathFinder.find_spec(package)
    return spec is not None and spec.origin is not None and not spec.origin.endswith(".txt")
