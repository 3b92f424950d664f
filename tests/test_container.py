"""The container file runs the demo of the Makefile.

It uses an existing Python and existing extras, and does not run as root.
"""

from __future__ import annotations

import json
import re

import pytest

from linkwright.cli.command import create_parser
from tests.places import REPOSITORY
from tests.toml_files import PROJECT, PYPROJECT


@pytest.fixture(scope="module")
def container() -> str:
    return (REPOSITORY / "Containerfile").read_text(encoding="utf-8").replace("\\\n", "")


def test_container_python_and_extras_are_declared_in_project(container):
    (python,) = re.findall(r"^ARG PYTHON=(\S+)$", container, re.MULTILINE)
    assert f"Programming Language :: Python :: {python}" in PROJECT["classifiers"]
    (extras,) = re.findall(r"^ARG EXTRAS=(\S+)$", container, re.MULTILINE)
    assert set(extras.split(",")) <= set(PROJECT["optional-dependencies"])


def test_container_runs_makefile_demo_as_non_root(container):
    (command,) = re.findall(r"^CMD (.+)$", container, re.MULTILINE)
    words = json.loads(command)
    arguments = create_parser(words[0]).parse_intermixed_args(words[1:])
    assert (arguments.host, arguments.no_open) == ("0.0.0.0", True)  # a container is reachable only through its port
    assert f"EXPOSE {arguments.port}\n" in container
    robot = words[2].removeprefix("/opt/linkwright/robots/")
    assert (REPOSITORY / "robots" / robot).is_file()
    makefile = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
    assert f"MBOT := robots/{robot}\n" in makefile
    assert f"linkwright sim {words[1]} $(MBOT) {' '.join(words[3:5])} " in makefile
    user = container.rindex("\nUSER 1000\n")
    assert container.rindex("\nRUN ") < user < container.index("\nENTRYPOINT ")


def test_dockerignore_keeps_files_needed_by_build():
    lines = (REPOSITORY / ".dockerignore").read_text(encoding="utf-8").splitlines()
    allowed = {line[1:] for line in lines if line.startswith("!")}
    included = PYPROJECT["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]
    required_folders = {path.partition("/")[0] for path in included} - {"CHANGELOG.md", "SECURITY.md"}
    assert required_folders | {"pyproject.toml", "uv.lock", "LICENSE"} <= allowed
