"""The server of aiohttp is loaded without the client, which is loaded on demand."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from linkwright.page.http_server import SERVER_LOGGER
from tests.places import REPOSITORY

SERVER = "import sys; from linkwright.page.http_server import web; import aiohttp; "


def output_of(code: str) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", SERVER + code], capture_output=True, text=True, check=True
    )
    return done.stdout.split()


def test_a_server_does_without_the_client():
    assert output_of("print('aiohttp.web' in sys.modules, 'aiohttp.connector' in sys.modules)") == ["True", "False"]


def test_the_client_comes_when_somebody_asks_for_it():
    code = "from aiohttp import ClientSession; print(ClientSession is aiohttp.client.ClientSession)"
    assert output_of(f"{code}; print(aiohttp.web is web, aiohttp.WSMsgType is web.WSMsgType)") == ["True"] * 3


def test_the_package_has_the_version_that_is_installed_before_and_after():
    code = "from importlib.metadata import version; print(version('aiohttp'), aiohttp.__version__)"
    assert len(set(output_of(f"{code}; aiohttp.ClientSession; print(aiohttp.__version__)"))) == 1


def test_the_names_it_has_not_are_missing_as_ever():
    for name in ("nothing", "__nothing__"):
        assert output_of(f"print(hasattr(aiohttp, '{name}'))") == ["False"]


def test_a_server_that_needs_the_whole_package_gets_it(tmp_path):
    package = tmp_path / "aiohttp"
    package.mkdir()
    (package / "__init__.py").write_text("X = 1\nfrom .web import A\n")
    (package / "web.py").write_text("from . import X\nA = X + 1\n")
    (package / "http_exceptions.py").write_text("HttpProcessingError = ValueError\n")
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); from linkwright.page.http_server import web; print(web.A)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["2"]


def test_what_was_loaded_before_stays():
    code = "import aiohttp.web; given = aiohttp.web; from linkwright.page.http_server import web; print(web is given)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True"]


def test_a_fault_of_the_server_is_told(caplog):
    SERVER_LOGGER.error("Error handling request", exc_info=RuntimeError("ours"))
    assert "ours" in caplog.text


@pytest.mark.parametrize("fault", [ConnectionResetError(), BrokenPipeError()])
def test_a_client_that_left_is_no_fault(caplog, fault):
    SERVER_LOGGER.error("Error handling request", exc_info=fault)
    assert caplog.records == []


def test_each_server_tells_its_faults_there():
    """aiohttp's own logger prints a traceback for each client that leaves."""
    runners = [
        words
        for path in (REPOSITORY / "src").rglob("*.py")
        for words in re.findall(r"web\.AppRunner\(([^)]*)\)", path.read_text(encoding="utf-8"))
    ]
    assert len(runners) >= 2
    assert [words for words in runners if "logger=SERVER_LOGGER" not in words] == []
