"""`linkwright.show` in a notebook.

A cell of JupyterLab shows the robot, with sliders for its joints.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from linkwright import show
from linkwright.diagnostics import LinkwrightError
from tests.browser.conftest import state, wait_until_equal
from tests.waiting import wait_until

ARM = """<robot name="arm">
  <link name="base"/>
  <link name="tip"><visual><geometry><box size="0.2 0.1 0.1"/></geometry></visual></link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/>
    <child link="tip"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>"""
TOKEN = "test"


@pytest.fixture
def lab(tmp_path: Path):
    """Return the address of a JupyterLab with a notebook that shows a robot."""
    cell = {
        "cell_type": "code",
        "execution_count": None,
        "id": "robot",
        "metadata": {},
        "outputs": [],
        "source": f"import linkwright\nlinkwright.show({ARM!r})",
    }
    kernel = {"name": "python3", "display_name": "Python 3"}
    notebook = {"cells": [cell], "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    (tmp_path / "robot.ipynb").write_text(json.dumps(notebook), encoding="utf-8")
    command = [
        *(sys.executable, "-m", "jupyterlab", "--no-browser", "--ip=127.0.0.1", "--port=0", "--allow-root"),
        *(f"--IdentityProvider.token={TOKEN}", f"--ServerApp.root_dir={tmp_path}"),
    ]
    folders = {f"JUPYTER_{name}_DIR": str(tmp_path / name) for name in ("CONFIG", "RUNTIME", "DATA")}
    with (tmp_path / "lab.log").open("w") as log:
        process = subprocess.Popen(
            command,
            env={**os.environ, **folders, "HOME": str(tmp_path)},
            stdout=log,
            stderr=subprocess.STDOUT,
        )

    def address() -> str:
        """Return the server's address from the file that it writes; empty until it runs."""
        assert process.poll() is None, (tmp_path / "lab.log").read_text()
        for file in (tmp_path / "RUNTIME").glob("jpserver-*.json"):
            with contextlib.suppress(OSError, json.JSONDecodeError):  # the server may still be writing the file
                url: str = json.loads(file.read_text())["url"]
                urllib.request.urlopen(f"{url}api?token={TOKEN}").close()
                return url
        return ""

    try:
        wait_until(address, what="JupyterLab", pause=0.1)
        yield f"{address()}lab/tree/robot.ipynb?token={TOKEN}"
    finally:
        process.terminate()
        process.wait()


def test_jupyterlab_cell_shows_robot_with_working_slider(browser, lab):
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.goto(lab)
    page.get_by_text("(ipykernel) | Idle").wait_for()  # a cell that is run before that is lost
    page.locator(".jp-Cell .cm-content").first.click()
    page.keyboard.press("Shift+Enter")
    frame = page.wait_for_selector("iframe[title=arm]").content_frame()
    wait_until_equal(lambda: frame.evaluate("() => window.linkwright?.ready === true"), True)
    level = highest_point(frame)
    frame.get_by_role("slider").first.fill("0.5")
    wait_until_equal(lambda: highest_point(frame) > level + 0.01, True)
    page.close()


def highest_point(frame) -> float:
    """Return the height of the highest point of the tip, in meters."""
    robot = next(display for display in state(frame, "displays") if display["class"].endswith("RobotModel"))
    (visual,) = robot["drawn"]["links"]["tip"]["visuals"]
    return visual["bounds"]["max"][2]


def test_show_raises_if_description_is_invalid():
    with pytest.raises(LinkwrightError) as error:
        show("<robot name='a'><joint/></robot>")
    assert error.value.diagnostics


def test_a_notebook_holds_the_page_once_and_a_terminal_prints_one_line():
    cell = show(ARM)
    assert len(cell._repr_html_()) > 100_000
    assert len(repr(cell)) < 200
