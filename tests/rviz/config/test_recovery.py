"""Unsaved changes at the end of the program."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.rviz import RvizConfig, find_unsaved
from linkwright.rviz.config.locations import RecentFiles, recovery_file, recovery_folder
from tests.rviz.visualization.test_managers import open_own_page
from tests.viewer.configured import open_configured, perform_edit


def recovery_files() -> list[Path]:
    folder = recovery_folder()
    return sorted(folder.iterdir()) if folder.exists() else []


async def change_alpha(client, alpha: float = 0.25) -> None:
    await client.set("display-1/Alpha", alpha)
    await client.until("configuration", unsaved=True)


async def test_unsaved_changes_are_recovered_on_next_start(tmp_path):
    path = tmp_path / "a.rviz"
    async with open_configured(path=path) as (world, client):
        text = path.read_text()
        await change_alpha(client)
        (notice,) = world.viewer.keep_unsaved()
        edited = world.viewer.config.text()
    (recovered,) = recovery_files()
    assert (notice.code, path.read_text(), recovered.read_text()) == ("RVIZ301", text, edited)
    assert f"'{path}'" in notice.message
    assert f"'{recovered}'" in notice.message
    assert RecentFiles().paths[0] == str(recovered)
    (result,) = find_unsaved(RvizConfig.load(path))
    assert result.code == "RVIZ302"
    assert f"'{recovered}'" in result.message
    assert find_unsaved(RvizConfig.load(recovered)) == []
    assert find_unsaved(RvizConfig.default()) == []


async def test_saving_removes_recovery_file(tmp_path):
    path = tmp_path / "a.rviz"
    async with open_configured(path=path) as (world, client):
        await change_alpha(client)
        world.viewer.keep_unsaved()
        assert len(recovery_files()) == 1
        await client.send("save_configuration", path=None, replace=False)
        await client.until("configuration_saved")
        assert recovery_files() == []
        assert (await client.until("configuration", unsaved=False))["recent"] == [str(path)]
        assert world.viewer.keep_unsaved() == []


async def test_saving_recovered_file_elsewhere_removes_recovery_file(tmp_path):
    path = tmp_path / "a.rviz"
    async with open_configured(path=path) as (world, client):
        await change_alpha(client)
        world.viewer.keep_unsaved()
        (recovered,) = recovery_files()
        await client.send("open_configuration", path=str(recovered), discard=True)
        await client.until("configuration", path=str(recovered))
        assert world.viewer.keep_unsaved() == []
        await client.send("add_display", cls="rviz_default_plugins/Axes", name="More", group=None, topic=None)
        await client.until("configuration", unsaved=True)
        world.viewer.keep_unsaved()
        assert recovery_files() == [recovered]
        assert "Name: More" in recovered.read_text()
        await client.send("save_configuration", path=str(path), replace=True)
        await client.until("configuration_saved")
        assert "Name: More" in path.read_text()
        assert recovery_files() == []


async def test_no_recovery_file_without_edits(tmp_path):
    path = tmp_path / "a.rviz"
    async with open_configured(path=path) as (world, client):
        assert world.viewer.keep_unsaved() == []
        await change_alpha(client)
        await perform_edit(client, "undo")
        assert world.viewer.keep_unsaved() == []
        # The user reverts the edit by hand.
        await client.send("show_panels", shown=["time"])
        await client.until("configuration", unsaved=True)
        await client.send("show_panels", shown=[])
        await client.drain(0.03)
        assert world.viewer.manager.history.has_unsaved_edits
        assert world.viewer.keep_unsaved() == []
    assert not recovery_folder().exists()


async def test_untitled_displays_are_kept_for_recovery(tmp_path):
    async with open_configured() as (world, client):
        await change_alpha(client)
        (notice,) = world.viewer.keep_unsaved()
    assert [path.name for path in recovery_files()] == ["untitled.rviz"]
    assert notice.message.startswith("unsaved displays are stored in")


async def test_displays_of_own_page_have_separate_recovery_file(tmp_path):
    async with open_configured(path=tmp_path / "a.rviz") as (world, client), open_own_page(world) as own_client:
        first = await own_client.opened()
        await change_alpha(client)
        await own_client.set(f"{first['tree']['displays'][0]['id']}/Alpha", 0.125)
        await own_client.until("configuration", unsaved=True)
        assert [diagnostic.code for diagnostic in world.viewer.keep_unsaved()] == ["RVIZ301", "RVIZ301"]
    shared, own_file = (
        recovery_files()
        if len(recovery_files()[0].stem) < len(recovery_files()[1].stem)
        else reversed(recovery_files())
    )
    assert "Alpha: 0.25" in shared.read_text()
    assert "Alpha: 0.125" in own_file.read_text()


def test_configurations_have_separate_recovery_files(tmp_path, monkeypatch):
    text = RvizConfig.default().text()
    files = [tmp_path / "a" / "x.rviz", tmp_path / "b" / "x.rviz"]
    for file in files:
        file.parent.mkdir()
        file.write_text(text)
    first, second = (recovery_file(RvizConfig.load(file)) for file in files)
    assert first != second
    assert first.name.startswith("x-")
    monkeypatch.chdir(tmp_path / "a")
    assert recovery_file(RvizConfig.load("x.rviz")) == first
    assert recovery_file(RvizConfig.parse(text, "from my computer.rviz")).name.startswith("from my computer-")


async def test_unwritable_recovery_folder_is_reported(tmp_path, monkeypatch):
    blocked = tmp_path / "blocked"
    blocked.write_text("no folder")
    path = tmp_path / "a.rviz"
    async with open_configured(path=path) as (world, client):
        await change_alpha(client)
        monkeypatch.setenv("XDG_STATE_HOME", str(blocked))
        (notice,) = world.viewer.keep_unsaved()
    assert notice.code == "RVIZ104"


@pytest.mark.parametrize("name", ["ü x.rviz", "a.b.rviz"])
def test_recovery_file_name_contains_configuration_name(tmp_path, name):
    file = tmp_path / name
    file.write_text(RvizConfig.default().text())
    recovered_file = recovery_file(RvizConfig.load(file))
    assert recovered_file.name.startswith(file.stem + "-")
    assert recovered_file.suffix == ".rviz"


@pytest.mark.parametrize("name", ["../../x", "/etc/x.rviz", "a\0b", "..", "", "x" * 5000, "C:\\x:y?.rviz", "\n"])
def test_recovery_file_stays_in_its_folder_for_any_name(name):
    path = recovery_file(RvizConfig.parse(RvizConfig.default().text(), name))
    assert path.parent == recovery_folder()
    path.parent.mkdir(parents=True)
    path.write_text("")
    assert recovery_files() == [path]
    assert not path.name.startswith(".")
