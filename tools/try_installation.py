"""Test an installed Linkwright: its version, a check of a robot, and the page's response.

Run it with the Python of the environment to test, which needs only Linkwright.

Usage: PYTHON -I tools/try_installation.py VERSION [--engine]

With --engine, only linkwright-core is installed, and its commands are tested with a generated robot.
"""

from __future__ import annotations

import importlib.util
import os
import re
import signal
import subprocess
import sys
import sysconfig
import tempfile
from http.cookiejar import CookieJar
from pathlib import Path
from urllib.parse import urljoin
from urllib.request import HTTPCookieProcessor, ProxyHandler, build_opener

_PROGRAM = Path(sysconfig.get_path("scripts"), "linkwright")
_XACRO = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="base"><visual><geometry><box size="${2 * 0.5} 1 1"/></geometry></visual></link>
</robot>
"""
_ROBOT = Path("robots", "my_robot_description", "urdf", "mbot_with_laser.urdf")
_TIMEOUT_S = 120
"""A timeout that suffices on any machine, because nothing is measured here."""


def try_linkwright(version: str) -> str:
    """Test the installation, and return a summary in one line.

    Raises:
        AssertionError: a test fails.
    """
    with tempfile.TemporaryDirectory() as home:
        environment = {**os.environ, "HOME": home, "XDG_CONFIG_HOME": home, "XDG_CACHE_HOME": home}
        text = _run(environment, "--version")
        assert text.strip() == f"linkwright {version}", text
        specification = importlib.util.find_spec("linkwright")
        assert specification is not None
        assert specification.origin is not None
        robot = Path(specification.origin).parent / _ROBOT
        checked = _run(environment, "check", str(robot))
        fetched = _count_page_files(environment, robot)
    python = f"{sys.version_info[0]}.{sys.version_info[1]}"
    tree = checked.count("\n")
    return (
        f"installed for Python {python}: {text.strip()}, check ({tree} lines), the page with {fetched} files of its own"
    )


def try_engine(version: str) -> str:
    """Test linkwright-core alone, and return a summary in one line.

    Raises:
        AssertionError: a test fails.
    """
    with tempfile.TemporaryDirectory() as home:
        environment = {**os.environ, "HOME": home, "XDG_CONFIG_HOME": home, "XDG_CACHE_HOME": home}
        file, other = Path(home, "robot.xacro"), Path(home, "other.xacro")
        file.write_text(_XACRO, encoding="utf-8")
        other.write_text(_XACRO.replace("0.5", "0.6"), encoding="utf-8")
        printed = _run(environment, "--version")
        assert printed.strip() == f"linkwright {version}", printed
        assert 'size="1.0 1 1"' in _run(environment, "xacro", str(file))
        assert "root Link: base" in _run(environment, "check", str(file))
        assert "<sdf" in _run(environment, "convert", str(file))
        assert "base" in _run(environment, "inertia", str(file))
        assert "box 1 1 1 -> box 1.2 1 1 m" in _run(environment, "diff", str(file), str(other), status=1)
        assert "LW302" in _run(environment, "explain", "LW302")
        assert importlib.util.find_spec("linkwright.viewer") is None
        size = sum(path.stat().st_size for path in Path(sys.prefix).rglob("*") if path.is_file())
    python = f"{sys.version_info[0]}.{sys.version_info[1]}"
    return f"the engine installed for Python {python}: {printed.strip()}, six commands, {size >> 20} MB"


def _run(environment: dict[str, str], *words: str, status: int = 0) -> str:
    result = subprocess.run(
        [_PROGRAM, *words], env=environment, capture_output=True, text=True, timeout=_TIMEOUT_S, check=False
    )
    assert result.returncode == status, (
        f"linkwright {' '.join(words)}: status {result.returncode}\n{result.stdout}{result.stderr}"
    )
    return result.stdout


def _count_page_files(environment: dict[str, str], robot: Path) -> int:
    """Return the number of files that the page of a robot names and the server provides."""
    words = [_PROGRAM, "view", str(robot), "--no-open"]
    with subprocess.Popen(
        words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as viewer:
        assert viewer.stdout is not None
        try:
            lines = []
            for line in viewer.stdout:
                lines.append(line)
                if match := re.search(r"Viewer: (http://\S+)", line):
                    break
            else:
                raise AssertionError("linkwright view ended by itself:\n" + "".join(lines))
            opener = build_opener(ProxyHandler({}), HTTPCookieProcessor(CookieJar()))
            with opener.open(match[1], timeout=_TIMEOUT_S) as answer:
                page, address = answer.read().decode("utf-8"), answer.geturl()
            files = re.findall(r'(?:src|href)="(\./[^"]+)"', page)
            assert any(file.endswith(".js") for file in files), page
            for file in files:
                with opener.open(urljoin(address, file), timeout=_TIMEOUT_S) as answer:
                    assert answer.read(), file
        finally:
            viewer.send_signal(signal.SIGTERM if os.name == "nt" else signal.SIGINT)
    return len(files)


if __name__ == "__main__":
    print((try_engine if "--engine" in sys.argv else try_linkwright)(sys.argv[1]))
