"""The installation of Linkwright, and the command that adds packages to it."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from linkwright.diagnostics import install_hint
from linkwright.diagnostics.installation import (
    Installation,
    Origin,
    find_installation,
    find_installation_in,
    parse_origin,
)

PIP = ("pip", "install")


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    folder = tmp_path / "a checkout"
    folder.mkdir()
    return folder


def direct_url(path: Path, **fields: object) -> dict[str, object]:
    """Return the record of an installer for a local file or folder."""
    return {"url": path.as_uri(), "dir_info": {}, **fields}


def test_index_installation_is_extended_by_name() -> None:
    assert Installation(Origin(), PIP).command_for_extras("sim") == "pip install 'linkwright[sim]'"


def test_checkout_installation_is_extended_by_path(checkout: Path) -> None:
    installation = Installation(parse_origin(direct_url(checkout)), PIP)
    assert installation.command_for_extras("sim", "dds") == f"pip install '{checkout}[dds,sim]'"


def test_checkout_in_current_folder_is_a_dot(checkout: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(checkout)
    installation = Installation(parse_origin(direct_url(checkout)), PIP)
    assert installation.command_for_extras("sim") == "pip install '.[sim]'"


def test_editable_checkout_stays_editable(checkout: Path) -> None:
    installation = Installation(parse_origin(direct_url(checkout, dir_info={"editable": True})), PIP)
    assert installation.command_for_extras("sim") == f"pip install -e '{checkout}[sim]'"


def test_wheel_is_referenced_by_path(tmp_path: Path) -> None:
    wheel = tmp_path / "linkwright-0.1.0-py3-none-any.whl"
    wheel.touch()
    origin = parse_origin({"url": wheel.as_uri(), "archive_info": {"hash": "sha256=0"}})
    assert Installation(origin, PIP).command_for_extras("mesh") == f"pip install '{wheel}[mesh]'"


@pytest.mark.parametrize(
    ("recorded", "requirement"),
    [
        (
            {"url": "https://example.org/l.git", "vcs_info": {"vcs": "git", "commit_id": "1"}},
            "linkwright[mesh] @ git+https://example.org/l.git",
        ),
        (
            {
                "url": "https://example.org/l.git",
                "vcs_info": {"vcs": "git", "commit_id": "1", "requested_revision": "main"},
                "subdirectory": "python",
            },
            "linkwright[mesh] @ git+https://example.org/l.git@main#subdirectory=python",
        ),
        (
            {"url": "https://example.org/linkwright-1-py3-none-any.whl", "archive_info": {}},
            "linkwright[mesh] @ https://example.org/linkwright-1-py3-none-any.whl",
        ),
    ],
)
def test_url_installation_is_extended_from_its_url(recorded: dict[str, object], requirement: str) -> None:
    assert Installation(parse_origin(recorded), PIP).command_for_extras("mesh") == f"pip install '{requirement}'"


def test_missing_install_source_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    installation = Installation(Origin(str(tmp_path / "gone")), PIP)
    monkeypatch.setattr("linkwright.diagnostics.installation.find_installation", lambda: installation)
    assert str(install_hint("image")) == (
        "run pip install 'PATH_TO_LINKWRIGHT[image]', and replace PATH_TO_LINKWRIGHT with the path of a checkout or "
        f"wheel of Linkwright, because '{tmp_path / 'gone'}', from which it was installed, no longer exists"
    )


def test_pipx_reinstalls_with_previous_extras(tmp_path: Path) -> None:
    main = {"package": "linkwright", "package_or_url": "/home/me/linkwright[image, dds]"}
    (tmp_path / "pipx_metadata.json").write_text(json.dumps({"main_package": main}))
    installation = find_installation_in(tmp_path, Origin())
    assert installation.command_for_extras("sim") == "pipx install --force 'linkwright[dds,image,sim]'"
    assert installation.command_for_packages("pyserial") == "pipx inject linkwright pyserial"


def test_uv_tool_reinstalls_with_previous_requirements(tmp_path: Path) -> None:
    (tmp_path / "uv-receipt.toml").write_text(
        '[tool]\nrequirements = [{ name = "linkwright", extras = ["image"], directory = "/x" }, { name = "jinja2" }]\n'
    )
    installation = find_installation_in(tmp_path, Origin())
    assert installation.command_for_extras("sim") == "uv tool install --with jinja2 'linkwright[image,sim]'"
    assert installation.command_for_packages("pyserial") == (
        "uv tool install --with jinja2 --with pyserial 'linkwright[image]'"
    )


def test_uvx_environment_is_installed_as_tool(tmp_path: Path) -> None:
    installation = find_installation_in(tmp_path / "archive-v0" / "x", Origin())
    assert installation.command_for_extras("sim") == "uv tool install 'linkwright[sim]'"


@pytest.fixture
def pip_there(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Create an environment with pip, and return its folder of programs."""
    monkeypatch.setattr("linkwright.diagnostics.installation.find_spec", lambda _name: object())
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    (tmp_path / "pip").write_text("")
    (tmp_path / "pip").chmod(0o755)
    return tmp_path


def test_pip_on_path_is_used_if_it_belongs_to_environment(pip_there: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda _name: str(pip_there / "pip"))
    assert find_installation_in(pip_there, Origin()).command_for_packages("jinja2") == "pip install jinja2"


def test_inactive_environment_is_addressed_by_its_python(pip_there: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda _name: "/usr/bin/pip")
    command = find_installation_in(pip_there, Origin()).command_for_packages("jinja2")
    assert command == f"{pip_there / 'python'} -m pip install jinja2"


def test_uv_is_used_without_pip(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("linkwright.diagnostics.installation.find_spec", lambda _name: None)
    monkeypatch.setattr("shutil.which", lambda _name: "/usr/bin/uv")
    monkeypatch.delenv("VIRTUAL_ENV", raising=False)
    installed = find_installation_in(tmp_path, Origin())
    assert installed.command_for_packages("jinja2") == f"uv pip install --python {tmp_path} jinja2"
    monkeypatch.setenv("VIRTUAL_ENV", str(tmp_path))
    assert find_installation_in(tmp_path, Origin()).command_for_packages("jinja2") == "uv pip install jinja2"


def test_uv_of_checkout_is_used_without_other_uv(checkout: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    checkout_uv = checkout / ".build" / "uv" / "bin" / "uv"
    checkout_uv.parent.mkdir(parents=True)
    checkout_uv.touch()
    monkeypatch.setattr("linkwright.diagnostics.installation.find_spec", lambda _name: None)
    monkeypatch.setattr("shutil.which", lambda _name: None)
    command = find_installation_in(checkout / ".venv", Origin(str(checkout), editable=True)).command_for_extras("train")
    assert command.startswith(f"'{checkout_uv}' pip install --python ")


def test_windows_commands_use_double_quotes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    assert Installation(Origin(), PIP).command_for_extras("sim") == 'pip install "linkwright[sim]"'


def test_running_installation_is_found() -> None:
    assert find_installation().command_for_extras("sim").endswith("[sim]'")
