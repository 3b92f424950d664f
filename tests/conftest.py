"""Fixtures and hooks for all tests."""

from __future__ import annotations

import gc
import re
import signal
import sys
from collections.abc import Generator, Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.domains import own_domain
from tests.forked import ForkServer
from tests.order import spread_waiting_files
from tests.places import REPOSITORY
from tests.repository_tools import load_tool

# The duration of an example depends on the machine's load. With CI set, hypothesis draws the same examples each time.
settings.register_profile("unhurried", settings(), deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("unhurried")

_MODULE_OF_EXTRA = re.compile(r"^pytestmark = \[?\s*pytest\.mark\.extra\(", re.MULTILINE)

# Background jobs of a shell ignore SIGINT, and programs under nohup ignore SIGHUP. Their child processes inherit this,
# and tests that end them by these signals would wait forever.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if sys.platform != "win32" and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Freeze the collected objects, so that the garbage collector ignores 17,000 tests."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.enable()
        gc.freeze()


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Spread the files of tests that wait over those that compute; see docs/decisions/0041."""
    items[:] = spread_waiting_files(items, REPOSITORY / "tests")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Ignore modules of pages, and wholly marked modules, in `make test-base`.

    Their imports would fail.
    """
    if "not extra" not in config.option.markexpr:
        return None
    if collection_path.name == "browser":
        return True
    is_module = collection_path.suffix == ".py" and collection_path.is_file()
    return True if is_module and _MODULE_OF_EXTRA.search(collection_path.read_text(encoding="utf-8")) else None


@pytest.fixture(autouse=True, scope="session")
def _isolated_user_state(tmp_path_factory):
    """Keep the state files of tested programs separate from the user's."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_STATE_HOME", str(tmp_path_factory.mktemp("state")))
        yield


@pytest.fixture(autouse=True, scope="session")
def _catalogs():
    """Use the catalogs of the checkout for other languages."""
    load_tool("catalogs").compile_catalogs()


@pytest.fixture(scope="session")
def fork_server() -> Iterator[ForkServer]:
    """Return a server that starts ``python -m linkwright`` in a fifth of the time."""
    server = ForkServer()
    yield server
    server.close()


@pytest.fixture(autouse=True)
def plain_environment(monkeypatch):
    """Remove settings of workspace, color and language, and use a domain of this run.

    Nodes of other test runs are in other domains.
    """
    for name in ("AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH", "ROS_PACKAGE_PATH", "NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("LINKWRIGHT_LANG", "en")
    monkeypatch.setenv("ROS_DOMAIN_ID", str(own_domain()))


@pytest.fixture(autouse=True)
def own_definitions():
    """Drop message definitions that recordings brought along, after each test."""
    yield
    module = sys.modules.get("linkwright.messages.definitions.library")
    carried = module.LIBRARY._embedded_sources if module is not None else {}
    if not carried:
        return
    library, classes = module.LIBRARY, sys.modules["linkwright.messages.classes"]._classes
    brought = {name for name in carried if name not in library._sources or library._sources[name] is carried[name]}
    for table in (library._definitions, library._sources, classes):
        for name in brought & table.keys():
            del table[name]
    library._checked -= brought
    carried.clear()
