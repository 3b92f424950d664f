"""Installation of models from their makers, mirrors, files and folders.

Incomplete models are never installed.
"""

from __future__ import annotations

import io
import sys
import zipfile
from dataclasses import replace

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.model_files import find_model, install, is_installed, remove, verify
from tests.full_disk import full_disk, needs_limits
from tests.model_files.model_server import ARCHIVE, ARCHIVE_ENTRY, FILE_ENTRY, FILES, archive


def ignore_progress(received, total):
    pass


def get(entry, source=None, folder=None):
    return install(entry, None if source is None else str(source), folder, ignore_progress)


def install_error(*arguments):
    with pytest.raises(LinkwrightError) as error:
        get(*arguments)
    (diagnostic,) = error.value.diagnostics
    return diagnostic


def files_below(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_archive_is_downloaded_unpacked_and_verified(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
    progress = []
    folder = install(entry, None, None, lambda received, total: progress.append((received, total)))
    assert folder == home / "toy-1.0" == find_model(entry)
    assert {name: (folder / name).read_bytes() for name in FILES} == FILES
    assert files_below(home) == {f"toy-1.0/{name}" for name in FILES}
    assert progress[-1] == (len(ARCHIVE), len(ARCHIVE))
    assert [received for received, _ in progress] == sorted(received for received, _ in progress)


def test_single_file_model_is_installed_and_removed(model_server, home):
    entry = model_server.add(FILE_ENTRY, "net.tflite", b"network" * 1_000)
    assert get(entry).read_bytes() == b"network" * 1_000
    assert files_below(home) == {"net.tflite"}
    assert remove(entry) == home / "net.tflite"
    assert not is_installed(entry)


def test_interrupted_download_is_resumed(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
    model_server.disconnect_after = [200, 100, 0]
    get(entry)
    assert model_server.range_headers == [None, "bytes=200-", "bytes=300-", "bytes=300-"]
    assert files_below(home) == {f"toy-1.0/{name}" for name in FILES}


def test_repeatedly_interrupted_download_fails_and_is_resumed_later(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
    model_server.disconnect_after = [150, 0, 0, 0]
    diagnostic = install_error(entry)
    assert diagnostic.code == "MODEL103"
    assert entry.address in str(diagnostic.message)
    assert "--from FILE" in str(diagnostic.hint)
    assert not is_installed(entry)
    model_server.range_headers.clear()
    get(entry)
    assert model_server.range_headers == ["bytes=150-"]


def test_server_without_range_support_restarts_download(model_server):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
    model_server.supports_ranges, model_server.disconnect_after = False, [200]
    assert (get(entry) / "conf" / "model.conf").read_bytes() == FILES["conf/model.conf"]


def test_partial_file_of_another_version_is_downloaded_again(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
    home.mkdir(parents=True)
    (home / ".toy.zip.part").write_bytes(b"of another version")
    get(entry)
    assert model_server.range_headers == ["bytes=18-", None]


def test_oversized_partial_file_is_downloaded_again(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
    home.mkdir(parents=True)
    (home / ".toy.zip.part").write_bytes(bytes(len(ARCHIVE) + 1))
    get(entry)
    assert model_server.range_headers == [f"bytes={len(ARCHIVE) + 1}-", None]


def test_complete_partial_file_is_not_downloaded_again(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
    home.mkdir(parents=True)
    (home / ".toy.zip.part").write_bytes(ARCHIVE)
    get(entry)
    assert model_server.range_headers == [f"bytes={len(ARCHIVE)}-"]


def test_wrong_checksum_is_rejected_and_leaves_no_files(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", archive({**FILES, "am/final.mdl": b"another"}))
    diagnostic = install_error(entry)
    assert diagnostic.code == "MODEL104"
    assert ARCHIVE_ENTRY.sha256 in str(diagnostic.notes[0].message)
    assert str(diagnostic.message).startswith(f"'{entry.address}' is not"), "the message names the URL"
    assert files_below(home) == set()


def test_file_checksums_are_verified_without_archive_checksum(model_server, home):
    entry = replace(
        model_server.add(ARCHIVE_ENTRY, "toy.zip", archive({**FILES, "am/final.mdl": b"another"})), sha256=None
    )
    diagnostic = install_error(entry)
    assert diagnostic.code == "MODEL104"
    assert "final.mdl" in str(diagnostic.message)
    assert files_below(home) == set()


def test_http_404_is_reported(model_server, home):
    entry = replace(ARCHIVE_ENTRY, address=f"{model_server.address}/toy.zip")
    diagnostic = install_error(entry)
    assert diagnostic.code == "MODEL103"
    assert "404" in str(diagnostic.message)
    assert files_below(home) == set()


def test_unreachable_server_is_reported(model_server, home):
    diagnostic = install_error(replace(ARCHIVE_ENTRY, address="http://127.0.0.1:9/toy.zip"))
    assert diagnostic.code == "MODEL103"
    assert "toy.zip" in str(diagnostic.hint)
    assert files_below(home) == set()


def test_oversized_download_is_rejected(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", bytes(2_000_001))
    assert install_error(entry).code == "MODEL103"
    assert files_below(home) == set()


def test_mirror_can_be_file_or_folder_url(model_server, tmp_path):
    entry = replace(ARCHIVE_ENTRY, address="http://127.0.0.1:9/models/toy.zip")
    model_server.files["toy.zip"] = ARCHIVE
    assert get(entry, f"{model_server.address}/toy.zip", tmp_path / "a").is_dir()
    assert get(entry, f"{model_server.address}/", tmp_path / "b").is_dir()


@pytest.mark.parametrize("form", ["file", "folder with it", "unpacked", "above unpacked"])
def test_model_is_installed_from_file_or_folder(form, tmp_path, home):
    entry = replace(ARCHIVE_ENTRY, address="http://127.0.0.1:9/toy.zip")
    source_folder = tmp_path / "given"
    source_folder.mkdir()
    (source_folder / "toy.zip").write_bytes(ARCHIVE)
    if "unpacked" in form:
        (source_folder / "toy.zip").unlink()
        zipfile.ZipFile(io.BytesIO(ARCHIVE)).extractall(source_folder)
    source = {"file": source_folder / "toy.zip", "unpacked": source_folder / "toy-1.0"}.get(form, source_folder)
    assert get(entry, source) == home / "toy-1.0"
    verify(entry, home / "toy-1.0")
    assert source.exists()


@pytest.mark.parametrize("source", ["nowhere", "."])
def test_source_without_model_is_rejected(source, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    diagnostic = install_error(ARCHIVE_ENTRY, source)
    assert diagnostic.code == "MODEL107"


def test_only_listed_files_are_extracted(tmp_path, home):
    zip_file = tmp_path / "toy.zip"
    zip_file.write_bytes(
        archive(**{"../outside": b"x", "/absolute": b"x", "toy-1.0/../../up": b"x", "toy-1.0/more": b"x"})
    )
    get(replace(ARCHIVE_ENTRY, sha256=None), zip_file)
    assert files_below(tmp_path) == {"toy.zip", *(f"data/linkwright/models/toy-1.0/{name}" for name in FILES)}


def test_decompression_bomb_is_rejected(tmp_path, home, monkeypatch):
    monkeypatch.setattr("linkwright.model_files.archives._MAX_BYTES", 10_000)
    zip_file = tmp_path / "toy.zip"
    zip_file.write_bytes(ARCHIVE)
    diagnostic = install_error(ARCHIVE_ENTRY, zip_file)
    assert diagnostic.code == "MODEL105"
    assert "too large" in str(diagnostic.message)
    assert files_below(home) == set()


@pytest.mark.parametrize(
    "data",
    [b"no archive", ARCHIVE[:-30], archive({"am/final.mdl": FILES["am/final.mdl"]}), b""],
    ids=["text", "cut", "lacks", "empty"],
)
def test_invalid_archive_is_rejected(data, tmp_path, home):
    zip_file = tmp_path / "toy.zip"
    zip_file.write_bytes(data)
    assert install_error(replace(ARCHIVE_ENTRY, sha256=None), zip_file).code == "MODEL105"
    assert files_below(home) == set()


def test_damaged_archive_is_rejected(tmp_path, home):
    zip_file = tmp_path / "toy.zip"
    offset = ARCHIVE.index(b"acoustic" * 3)
    zip_file.write_bytes(ARCHIVE[:offset] + b"X" + ARCHIVE[offset + 1 :])
    assert install_error(replace(ARCHIVE_ENTRY, sha256=None), zip_file).code == "MODEL105"
    assert files_below(home) == set()


@needs_limits
@pytest.mark.parametrize("free_bytes", [100, len(ARCHIVE) - 5_000])
def test_full_disk_keeps_installed_model(free_bytes, model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)
    installed = home / "toy-1.0" / "am"
    installed.mkdir(parents=True)
    (installed / "final.mdl").write_bytes(b"old")
    with full_disk(free_bytes):
        diagnostic = install_error(entry)
    assert diagnostic.code == "MODEL106"
    assert (installed / "final.mdl").read_bytes() == b"old"
    assert files_below(home) - {".toy.zip.part"} == {"toy-1.0/am/final.mdl"}
    get(entry)
    assert files_below(home) == {f"toy-1.0/{name}" for name in FILES}


@pytest.mark.skipif(sys.platform == "win32", reason="Windows reports another error for a file in place of a folder")
def test_uncreatable_folder_is_reported(tmp_path):
    (tmp_path / "file").write_text("")
    assert install_error(ARCHIVE_ENTRY, None, tmp_path / "file" / "models").code == "MODEL106"


def test_keyboard_interrupt_keeps_partial_download(model_server, home):
    entry = model_server.add(ARCHIVE_ENTRY, "toy.zip", ARCHIVE)

    def interrupt(received, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        install(entry, None, None, interrupt)
    assert files_below(home) == {".toy.zip.part"}
    get(entry)
    assert files_below(home) == {f"toy-1.0/{name}" for name in FILES}


def test_modified_model_fails_verification(home, tmp_path):
    zip_file = tmp_path / "toy.zip"
    zip_file.write_bytes(ARCHIVE)
    folder = get(ARCHIVE_ENTRY, zip_file)
    (folder / "conf" / "model.conf").write_bytes(b"--beam=1\n")
    with pytest.raises(LinkwrightError) as error:
        verify(ARCHIVE_ENTRY, folder)
    assert error.value.diagnostics[0].code == "MODEL104"
    (folder / "conf" / "model.conf").unlink()
    with pytest.raises(LinkwrightError) as error:
        verify(ARCHIVE_ENTRY, folder)
    assert error.value.diagnostics[0].code == "MODEL105"
    get(ARCHIVE_ENTRY, zip_file)
    verify(ARCHIVE_ENTRY, folder)


def test_missing_model_has_install_hint():
    with pytest.raises(LinkwrightError) as error:
        find_model(ARCHIVE_ENTRY)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "MODEL102"
    assert "linkwright models get toy" in str(diagnostic.hint)
