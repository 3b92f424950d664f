"""The server of aiohttp is loaded without the client, which is loaded on demand."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from linkwright.page.http_server import SERVER_LOGGER
from tests.places import REPOSITORY

SERVER = "import sys; from linkwright.page.http_server import web; import aiohttp; "


def run_python(code: str) -> list[str]:
    result = subprocess.run(
        [sys.executable, "-W", "error", "-c", SERVER + code], capture_output=True, text=True, check=True
    )
    return result.stdout.split()


def test_server_does_not_load_client():
    assert run_python("print('aiohttp.web' in sys.modules, 'aiohttp.connector' in sys.modules)") == ["True", "False"]


def test_client_is_loaded_on_demand():
    code = "from aiohttp import ClientSession; print(ClientSession is aiohttp.client.ClientSession)"
    assert run_python(f"{code}; print(aiohttp.web is web, aiohttp.WSMsgType is web.WSMsgType)") == ["True"] * 3


def test_package_version_is_available_before_and_after_client():
    code = "from importlib.metadata import version; print(version('aiohttp'), aiohttp.__version__)"
    assert len(set(run_python(f"{code}; aiohttp.ClientSession; print(aiohttp.__version__)"))) == 1


def test_unknown_attributes_of_package_are_missing():
    for name in ("nothing", "__nothing__"):
        assert run_python(f"print(hasattr(aiohttp, '{name}'))") == ["False"]


def test_server_that_needs_whole_package_loads_it(tmp_path):
    package = tmp_path / "aiohttp"
    package.mkdir()
    (package / "__init__.py").write_text("X = 1\nfrom .web import A\n")
    (package / "web.py").write_text("from . import X\nA = X + 1\n")
    (package / "http_exceptions.py").write_text("HttpProcessingError = ValueError\n")
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r}); from linkwright.page.http_server import web; print(web.A)"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.split() == ["2"]


def test_already_loaded_package_is_kept():
    code = "import aiohttp.web; given = aiohttp.web; from linkwright.page.http_server import web; print(web is given)"
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout.split() == ["True"]


def test_server_error_is_logged(caplog):
    SERVER_LOGGER.error("Error handling request", exc_info=RuntimeError("ours"))
    assert "ours" in caplog.text


@pytest.mark.parametrize("fault", [ConnectionResetError(), BrokenPipeError()])
def test_disconnected_client_is_not_logged(caplog, fault):
    SERVER_LOGGER.error("Error handling request", exc_info=fault)
    assert caplog.records == []


def test_servers_log_errors_to_server_logger():
    """aiohttp's own logger prints a traceback for each client that leaves."""
    runners = [
        words
        for path in (REPOSITORY / "src").rglob("*.py")
        for words in re.findall(r"web\.AppRunner\(([^)]*)\)", path.read_text(encoding="utf-8"))
    ]
    assert len(runners) >= 2
    assert [words for words in runners if "logger=SERVER_LOGGER" not in words] == []
