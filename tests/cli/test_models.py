"""`linkwright models`: the output, and one message for each error."""

from __future__ import annotations

import json

import pytest

from linkwright.cli import main
from linkwright.cli.completion.candidates import complete
from tests.model_files.model_server import ARCHIVE, ARCHIVE_ENTRY, run_model_server


@pytest.fixture(autouse=True)
def home(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    monkeypatch.delenv("http_proxy", raising=False)
    return tmp_path / "linkwright" / "models"


@pytest.fixture
def toy(monkeypatch):
    with run_model_server() as server:
        entry = server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
        monkeypatch.setattr("linkwright.model_files.table.model_table", lambda: {"toy": entry})
        monkeypatch.setattr("linkwright.model_files.model_table", lambda: {"toy": entry})
        yield server


def test_models_list_prints_license_and_status(capsys):
    assert main(["models", "list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["vosk-en", "vosk-zh", "efficientdet-lite0", "efficientdet-lite2"]
    assert all("Apache-2.0  not downloaded: " in line for line in lines)
    assert main(["--lang", "zh", "models", "list"]) == 0
    assert "未下载: 中文语音命令" in capsys.readouterr().out
    assert main(["models", "list", "--json"]) == 0
    first = json.loads(capsys.readouterr().out)[0]
    assert (first["name"], first["path"]) == ("vosk-en", None)


def test_model_is_downloaded_found_verified_and_removed(toy, home, capsys):
    assert main(["models", "get", "toy"]) == 0
    captured = capsys.readouterr()
    assert captured.out == f"{home / 'toy-1.0'}\n"
    assert "license Apache-2.0" in captured.err
    assert main(["models", "path", "toy"]) == 0
    assert capsys.readouterr().out == f"{home / 'toy-1.0'}\n"
    assert main(["models", "get", "toy"]) == 0
    assert len(toy.range_headers) == 1  # the installed model is not downloaded again
    assert main(["models", "check"]) == 0
    (home / "toy-1.0" / "conf" / "model.conf").write_text("other")
    capsys.readouterr()
    assert main(["models", "check", "toy"]) == 1
    assert "MODEL104" in capsys.readouterr().err
    assert main(["models", "get", "toy"]) == 0
    assert "is downloaded again" in capsys.readouterr().err
    assert main(["models", "remove", "toy"]) == 0
    assert main(["models", "remove", "toy"]) == 1
    assert "MODEL102" in capsys.readouterr().err


def test_download_progress_is_shown_on_terminal(toy, capsys, monkeypatch):
    monkeypatch.setattr("linkwright.cli.progress.sys.stderr.isatty", lambda: True)
    assert main(["models", "get", "toy"]) == 0
    assert f"{'#' * 30} 0.0 of 0.0 MB" in capsys.readouterr().err


def test_model_names_are_completed():
    assert complete(["linkwright", "models", "get", "vosk"]) == ["vosk-en", "vosk-zh"]
