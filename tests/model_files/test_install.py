"""Models come from their makers, mirrors, files and folders; whole and checked, or not at all."""

from __future__ import annotations

import io
import sys
import zipfile
from dataclasses import replace

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.model_files import find_model, install, is_installed, remove, verify
from tests.full_disk import full_disk, needs_limits
from tests.model_files.shop import ARCHIVE, FILES, PACKED, SINGLE, archive


def silent(received, total):
    pass


def get(entry, source=None, folder=None):
    return install(entry, None if source is None else str(source), folder, silent)


def refused(*given):
    with pytest.raises(LinkwrightError) as caught:
        get(*given)
    (diagnostic,) = caught.value.diagnostics
    return diagnostic


def below(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_archive_is_downloaded_unpacked_and_verified(shop, home):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)
    seen = []
    place = install(entry, None, None, lambda received, total: seen.append((received, total)))
    assert place == home / "toy-1.0" == find_model(entry)
    assert {name: (place / name).read_bytes() for name in FILES} == FILES
    assert below(home) == {f"toy-1.0/{name}" for name in FILES}
    assert seen[-1] == (len(ARCHIVE), len(ARCHIVE))
    assert [received for received, _ in seen] == sorted(received for received, _ in seen)


def test_single_file_model_is_installed_and_removed(shop, home):
    entry = shop.of(SINGLE, "net.tflite", b"network" * 1_000)
    assert get(entry).read_bytes() == b"network" * 1_000
    assert below(home) == {"net.tflite"}
    assert remove(entry) == home / "net.tflite"
    assert not is_installed(entry)


def test_interrupted_download_is_resumed(shop, home):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)
    shop.breaks = [200, 100, 0]
    get(entry)
    assert shop.asked == [None, "bytes=200-", "bytes=300-", "bytes=300-"]
    assert below(home) == {f"toy-1.0/{name}" for name in FILES}


def test_repeatedly_interrupted_download_fails_and_is_resumed_later(shop, home):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)
    shop.breaks = [150, 0, 0, 0]
    diagnostic = refused(entry)
    assert diagnostic.code == "MODEL103"
    assert entry.address in str(diagnostic.message)
    assert "--from FILE" in str(diagnostic.hint)
    assert not is_installed(entry)
    shop.asked.clear()
    get(entry)
    assert shop.asked == ["bytes=150-"]


def test_server_without_range_support_restarts_download(shop):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)
    shop.ranges, shop.breaks = False, [200]
    assert (get(entry) / "conf" / "model.conf").read_bytes() == FILES["conf/model.conf"]


def test_partial_file_of_another_version_is_downloaded_again(shop, home):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)
    home.mkdir(parents=True)
    (home / ".toy.zip.part").write_bytes(b"of another version")
    get(entry)
    assert shop.asked == ["bytes=18-", None]


def test_oversized_partial_file_is_downloaded_again(shop, home):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)
    home.mkdir(parents=True)
    (home / ".toy.zip.part").write_bytes(bytes(len(ARCHIVE) + 1))
    get(entry)
    assert shop.asked == [f"bytes={len(ARCHIVE) + 1}-", None]


def test_complete_partial_file_is_not_downloaded_again(shop, home):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)
    home.mkdir(parents=True)
    (home / ".toy.zip.part").write_bytes(ARCHIVE)
    get(entry)
    assert shop.asked == [f"bytes={len(ARCHIVE)}-"]


def test_wrong_checksum_is_rejected_and_leaves_no_files(shop, home):
    entry = shop.of(PACKED, "toy.zip", archive({**FILES, "am/final.mdl": b"another"}))
    diagnostic = refused(entry)
    assert diagnostic.code == "MODEL104"
    assert PACKED.sha256 in str(diagnostic.notes[0].message)
    assert str(diagnostic.message).startswith(f"'{entry.address}' is not"), "and not where it was kept meanwhile"
    assert below(home) == set()


def test_file_checksums_are_verified_without_archive_checksum(shop, home):
    entry = replace(shop.of(PACKED, "toy.zip", archive({**FILES, "am/final.mdl": b"another"})), sha256=None)
    diagnostic = refused(entry)
    assert diagnostic.code == "MODEL104"
    assert "final.mdl" in str(diagnostic.message)
    assert below(home) == set()


def test_http_404_is_reported(shop, home):
    entry = replace(PACKED, address=f"{shop.address}/toy.zip")
    diagnostic = refused(entry)
    assert diagnostic.code == "MODEL103"
    assert "404" in str(diagnostic.message)
    assert below(home) == set()


def test_unreachable_server_is_reported(shop, home):
    diagnostic = refused(replace(PACKED, address="http://127.0.0.1:9/toy.zip"))
    assert diagnostic.code == "MODEL103"
    assert "toy.zip" in str(diagnostic.hint)
    assert below(home) == set()


def test_oversized_download_is_rejected(shop, home):
    entry = shop.of(PACKED, "toy.zip", bytes(2_000_001))
    assert refused(entry).code == "MODEL103"
    assert below(home) == set()


def test_mirror_can_be_file_or_folder_url(shop, tmp_path):
    entry = replace(PACKED, address="http://127.0.0.1:9/models/toy.zip")
    shop.files["toy.zip"] = ARCHIVE
    assert get(entry, f"{shop.address}/toy.zip", tmp_path / "a").is_dir()
    assert get(entry, f"{shop.address}/", tmp_path / "b").is_dir()


@pytest.mark.parametrize("form", ["file", "folder with it", "unpacked", "above unpacked"])
def test_model_is_installed_from_file_or_folder(form, tmp_path, home):
    entry = replace(PACKED, address="http://127.0.0.1:9/toy.zip")
    given = tmp_path / "given"
    given.mkdir()
    (given / "toy.zip").write_bytes(ARCHIVE)
    if "unpacked" in form:
        (given / "toy.zip").unlink()
        zipfile.ZipFile(io.BytesIO(ARCHIVE)).extractall(given)
    source = {"file": given / "toy.zip", "unpacked": given / "toy-1.0"}.get(form, given)
    assert get(entry, source) == home / "toy-1.0"
    verify(entry, home / "toy-1.0")
    assert source.exists()


@pytest.mark.parametrize("source", ["nowhere", "."])
def test_source_without_model_is_rejected(source, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    diagnostic = refused(PACKED, source)
    assert diagnostic.code == "MODEL107"


def test_only_listed_files_are_extracted(tmp_path, home):
    packed = tmp_path / "toy.zip"
    packed.write_bytes(
        archive(**{"../outside": b"x", "/absolute": b"x", "toy-1.0/../../up": b"x", "toy-1.0/more": b"x"})
    )
    get(replace(PACKED, sha256=None), packed)
    assert below(tmp_path) == {"toy.zip", *(f"data/linkwright/models/toy-1.0/{name}" for name in FILES)}


def test_decompression_bomb_is_rejected(tmp_path, home, monkeypatch):
    monkeypatch.setattr("linkwright.model_files.archives._MAX_BYTES", 10_000)
    packed = tmp_path / "toy.zip"
    packed.write_bytes(ARCHIVE)
    diagnostic = refused(PACKED, packed)
    assert diagnostic.code == "MODEL105"
    assert "too large" in str(diagnostic.message)
    assert below(home) == set()


@pytest.mark.parametrize(
    "data",
    [b"no archive", ARCHIVE[:-30], archive({"am/final.mdl": FILES["am/final.mdl"]}), b""],
    ids=["text", "cut", "lacks", "empty"],
)
def test_invalid_archive_is_rejected(data, tmp_path, home):
    packed = tmp_path / "toy.zip"
    packed.write_bytes(data)
    assert refused(replace(PACKED, sha256=None), packed).code == "MODEL105"
    assert below(home) == set()


def test_damaged_archive_is_rejected(tmp_path, home):
    packed = tmp_path / "toy.zip"
    at = ARCHIVE.index(b"acoustic" * 3)
    packed.write_bytes(ARCHIVE[:at] + b"X" + ARCHIVE[at + 1 :])
    assert refused(replace(PACKED, sha256=None), packed).code == "MODEL105"
    assert below(home) == set()


@needs_limits
@pytest.mark.parametrize("room", [100, len(ARCHIVE) - 5_000])
def test_full_disk_keeps_installed_model(room, shop, home):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)
    old = home / "toy-1.0" / "am"
    old.mkdir(parents=True)
    (old / "final.mdl").write_bytes(b"old")
    with full_disk(room):
        diagnostic = refused(entry)
    assert diagnostic.code == "MODEL106"
    assert (old / "final.mdl").read_bytes() == b"old"
    assert below(home) - {".toy.zip.part"} == {"toy-1.0/am/final.mdl"}
    get(entry)
    assert below(home) == {f"toy-1.0/{name}" for name in FILES}


@pytest.mark.skipif(sys.platform == "win32", reason="a file where a folder is wanted is another error there")
def test_uncreatable_folder_is_reported(tmp_path):
    (tmp_path / "file").write_text("")
    assert refused(PACKED, None, tmp_path / "file" / "models").code == "MODEL106"


def test_keyboard_interrupt_keeps_partial_download(shop, home):
    entry = shop.of(PACKED, "toy.zip", ARCHIVE)

    def interrupt(received, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        install(entry, None, None, interrupt)
    assert below(home) == {".toy.zip.part"}
    get(entry)
    assert below(home) == {f"toy-1.0/{name}" for name in FILES}


def test_modified_model_fails_verification(home, tmp_path):
    packed = tmp_path / "toy.zip"
    packed.write_bytes(ARCHIVE)
    place = get(PACKED, packed)
    (place / "conf" / "model.conf").write_bytes(b"--beam=1\n")
    with pytest.raises(LinkwrightError) as caught:
        verify(PACKED, place)
    assert caught.value.diagnostics[0].code == "MODEL104"
    (place / "conf" / "model.conf").unlink()
    with pytest.raises(LinkwrightError) as caught:
        verify(PACKED, place)
    assert caught.value.diagnostics[0].code == "MODEL105"
    get(PACKED, packed)
    verify(PACKED, place)


def test_missing_model_has_install_hint():
    with pytest.raises(LinkwrightError) as caught:
        find_model(PACKED)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "MODEL102"
    assert "linkwright models get toy" in str(diagnostic.hint)
