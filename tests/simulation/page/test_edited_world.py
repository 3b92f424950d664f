"""Edited worlds: saving changes only the edited parts of the file."""

from __future__ import annotations

import codecs
from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.sdf.editing import Change, EditError, change
from linkwright.sdf.resources import find_model_file
from linkwright.simulation.page.modeling.edited_world import EditedWorld
from tests.sdf.editing.texts import PLAIN_WORLD

NO_PACKAGES = PackageFinder(start=Path("/nonexistent"), environment={})


def rename_world(path: Path, name: str = "机器人 é") -> EditedWorld:
    world = EditedWorld.from_file(path, NO_PACKAGES)
    world.edit(lambda text: change(text, [Change("box", new_name=name)]))
    return world


@pytest.mark.parametrize(
    ("bom", "encoding", "declared_encoding"),
    [
        (b"", "utf-8", ""),
        (codecs.BOM_UTF8, "utf-8", ""),
        (codecs.BOM_UTF16_LE, "utf-16-le", "utf-16"),
        (b"", "latin-1", "latin-1"),
    ],
)
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_save_keeps_encoding_bom_and_line_ends(tmp_path, bom, encoding, declared_encoding, newline):
    text = PLAIN_WORLD.replace("<!-- the box -->", "<!-- ü -->").replace("\n", newline)
    if declared_encoding:
        text = text.replace('version="1.0"', f'version="1.0" encoding="{declared_encoding}"')
    path = tmp_path / "w.world"
    path.write_bytes(bom + text.encode(encoding))
    rename_world(path).save(None)
    data = path.read_bytes()
    assert data.startswith(bom)
    saved_text = data.removeprefix(bom).decode(encoding)
    written_name = "&#26426;&#22120;&#20154; é" if encoding == "latin-1" else "机器人 é"
    assert saved_text == text.replace("'box'", f"'{written_name}'")
    assert "机器人 é" in EditedWorld.from_file(path, NO_PACKAGES).world.entities


def test_change_without_effect_adds_no_undo_step(tmp_path):
    path = tmp_path / "w.world"
    path.write_text(PLAIN_WORLD)
    world = EditedWorld.from_file(path, NO_PACKAGES)
    world.edit(lambda text: change(text, [Change("box", pose=(2, 0, 0.25, 0, 0, 0), size=(0.5, 0.5, 0.5))]))
    assert (world.can_undo, world.is_unsaved) == (False, False)
    world.undo()
    world.redo()
    assert world.world.text == PLAIN_WORLD


def test_new_change_clears_redo(tmp_path):
    path = tmp_path / "w.world"
    path.write_text(PLAIN_WORLD)
    world = rename_world(path, "a")
    world.undo()
    assert (world.can_undo, world.can_redo, world.is_unsaved) == (False, True, False)
    world.edit(lambda text: change(text, [Change("box", static=True)]))
    assert (world.can_undo, world.can_redo) == (True, False)


def test_save_does_not_overwrite_other_files(tmp_path):
    path, other = tmp_path / "w.world", tmp_path / "other.world"
    path.write_text(PLAIN_WORLD)
    other.write_text("mine")
    world = rename_world(path)
    with pytest.raises(EditError, match=r"the file '.*other\.world' already exists: choose another name"):
        world.save("other.world")
    with pytest.raises(EditError, match=r"cannot write '.*none/w.world'"):
        world.save("none/w.world")
    for name in ("", "w.txt", "w.world.xacro", "a\0.world", "~nonexistent-user/w.world"):
        with pytest.raises(EditError, match=r"it must end in \.world or \.sdf"):
            world.save(name)
    assert (other.read_text(), path.read_text()) == ("mine", PLAIN_WORLD)
    world.save(str(path))
    assert not world.is_unsaved
    path.unlink()
    world.save(None)
    assert path.exists()


def test_xacro_world_is_saved_expanded_to_new_file(tmp_path):
    path = tmp_path / "w.world.xacro"
    source = PLAIN_WORLD.replace("-- dashes", "dashes").replace(
        "<sdf ", '<sdf xmlns:xacro="http://www.ros.org/wiki/xacro" '
    )
    path.write_text(source.replace(">2 0 0.250", ">${1 + 1} 0 0.250"))
    world = rename_world(path)
    assert (world.file, world.path) == (None, tmp_path / "w.world")
    with pytest.raises(EditError, match="no file yet"):
        world.save(None)
    with pytest.raises(EditError, match="it must end in"):
        world.save("w.world.xacro")
    world.save("made.world")
    assert world.file == tmp_path / "made.world"
    assert "${" in path.read_text()
    assert EditedWorld.from_file(world.file, NO_PACKAGES).world.entities["机器人 é"].world_pose[0] == 2


def test_shipped_worlds_are_not_overwritten(tmp_path):
    import linkwright

    shipped_path = Path(linkwright.__file__).parent / "w.world"
    assert EditedWorld(PLAIN_WORLD, shipped_path, NO_PACKAGES).file is None
    path = find_model_file(Path(linkwright.__file__).parent / "sdf" / "models" / "sun")
    with pytest.raises(EditError, match="there is no world in"):
        EditedWorld.from_file(path, NO_PACKAGES)


def test_unsaved_changes_are_stored(tmp_path):
    path, folder = tmp_path / "w.world", tmp_path / "state" / "unsaved"
    path.write_bytes(codecs.BOM_UTF8 + PLAIN_WORLD.encode())
    diagnostics = [rename_world(path, name).store_unsaved(folder) for name in ("a", "b")]
    (file,) = folder.iterdir()
    assert [diagnostic.code for diagnostic in diagnostics] == ["RVIZ301", "RVIZ301"]
    assert f"'{path}'" in diagnostics[0].message
    assert f"'{file}'" in diagnostics[0].message
    assert file.read_bytes() == codecs.BOM_UTF8 + PLAIN_WORLD.replace("'box'", "'b'").encode()
    (tmp_path / "file").touch()
    diagnostic = rename_world(path).store_unsaved(tmp_path / "file" / "unsaved")
    assert (diagnostic.code, "cannot write" in diagnostic.message) == ("RVIZ104", True)
