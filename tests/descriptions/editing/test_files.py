"""Writing and undoing edits of robots."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright import descriptions
from linkwright.descriptions import examine
from linkwright.descriptions.editing import EditHistory, EditPlan, EditRefusedError, EditRequest, Workspace, plan_edit

ROBOT = (
    '<robot name="r"><link name="a"/><link name="b"/>\r\n'
    '\t<joint name="j" type="fixed"><origin xyz="0 0 1"/><parent link="a"/><child link="b"/></joint>'
    "<!-- é -->\r\n</robot>"
)


def raise_link(path: Path, z: float) -> EditPlan:
    return plan_edit(examine(path), EditRequest("joint", "j", xyz=(0, 0, z)))


@pytest.mark.parametrize(
    "bytes_of",
    [
        lambda text: text.encode(),
        lambda text: b"\xef\xbb\xbf" + text.encode(),
        lambda text: ('<?xml version="1.0" encoding="iso-8859-1"?>\r\n' + text).encode("latin-1"),
        lambda text: b"\xff\xfe" + text.encode("utf-16-le"),
    ],
    ids=["utf-8", "byte order mark", "latin-1", "utf-16"],
)
def test_edit_and_undo_preserve_other_bytes(tmp_path: Path, bytes_of: Callable[[str], bytes]) -> None:
    path = tmp_path / "robot.urdf"
    path.write_bytes(bytes_of(ROBOT))
    history = EditHistory()
    history.apply(raise_link(path, 2))
    after = bytes_of(ROBOT.replace("0 0 1", "0 0 2"))
    assert path.read_bytes() == after
    assert (history.can_undo, history.can_redo) == (True, False)
    history.undo()
    assert path.read_bytes() == bytes_of(ROBOT)
    assert (history.can_undo, history.can_redo) == (False, True)
    history.redo()
    assert path.read_bytes() == after


def test_file_changed_meanwhile_is_not_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "robot.urdf"
    path.write_bytes(ROBOT.encode())
    plan, history = raise_link(path, 2), EditHistory()
    path.write_text(ROBOT.replace("é", "e"))
    with pytest.raises(EditRefusedError) as caught:
        history.apply(plan)
    assert caught.value.diagnostic.code == "EDIT107"
    assert path.read_text() == ROBOT.replace("é", "e").replace("\r\n", "\n")

    history.apply(raise_link(path, 2))
    path.write_text("mine")
    with pytest.raises(EditRefusedError):
        history.undo()
    assert path.read_text() == "mine"
    assert history.can_undo


def test_several_files_are_written_together_or_not_at_all(tmp_path: Path) -> None:
    first, second = tmp_path / "one.xacro", tmp_path / "two.xacro"
    first.write_text("1")
    second.write_text("2")
    history = EditHistory()
    plan = EditPlan({str(first): "one", str(second): "two"}, {str(first): "1", str(second): "2"})
    second.unlink()
    with pytest.raises(EditRefusedError):
        history.apply(plan)
    assert first.read_text() == "1"
    second.write_text("2")
    history.apply(plan)
    assert (first.read_text(), second.read_text()) == ("one", "two")
    first.write_text("other")
    with pytest.raises(EditRefusedError):
        history.undo()
    assert second.read_text() == "two"


def test_symlink_is_preserved(tmp_path: Path) -> None:
    real, link = tmp_path / "real.urdf", tmp_path / "robot.urdf"
    real.write_bytes(ROBOT.encode())
    link.symlink_to(real)
    EditHistory().apply(raise_link(link, 2))
    assert link.is_symlink()
    assert "0 0 2" in real.read_text()


def test_workspace_is_package_repository_or_src_parent(tmp_path: Path) -> None:
    folder = tmp_path / "ws" / "src" / "robot" / "urdf"
    folder.mkdir(parents=True)
    main = folder / "robot.urdf"
    main.write_text("")
    assert Workspace(main).folder == (tmp_path / "ws").resolve()
    lone_folder = tmp_path / "lone" / "urdf"
    lone_folder.mkdir(parents=True)
    assert Workspace(lone_folder / "robot.urdf").folder == lone_folder.resolve()
    (tmp_path / "lone" / "package.xml").write_text("")
    assert Workspace(lone_folder / "robot.urdf").folder == (tmp_path / "lone").resolve()


def test_files_outside_workspace_or_installed_are_rejected(tmp_path: Path) -> None:
    main = tmp_path / "mine" / "robot.urdf"
    main.parent.mkdir()
    main.write_text("")
    workspace = Workspace(main)
    assert workspace.refusal(os.path.realpath(main)) is None

    other = tmp_path / "other.xacro"
    other.write_text("")
    program_file = Path(descriptions.__file__).resolve()
    installed = tmp_path / "mine" / "install" / "share" / "robot" / "robot.urdf"
    installed.parent.mkdir(parents=True)
    installed.write_text("")
    (installed.parents[1] / "ament_index").mkdir()
    for path, reason in ((other, "outside the workspace"), (program_file, "this program"), (installed, "installed")):
        refusal = workspace.refusal(os.path.realpath(path))
        assert refusal is not None
        assert refusal.code == "EDIT106"
        assert path.name in refusal.message
        assert reason in refusal.message
