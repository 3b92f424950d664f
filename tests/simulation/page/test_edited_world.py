"""A world that is edited: its file stays what it is but for what was changed."""

from __future__ import annotations

import codecs
from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.sdf.editing import Change, EditError, change
from linkwright.sdf.resources import model_file
from linkwright.simulation.page.modeling.edited_world import EditedWorld
from tests.sdf.editing.texts import PLAIN

NOWHERE = PackageFinder(start=Path("/nonexistent"), environment={})


def edited(path: Path, name: str = "机器人 é") -> EditedWorld:
    world = EditedWorld.of_file(path, NOWHERE)
    world.edit(lambda text: change(text, [Change("box", new_name=name)]))
    return world


@pytest.mark.parametrize(
    ("mark", "encoding", "declared"),
    [
        (b"", "utf-8", ""),
        (codecs.BOM_UTF8, "utf-8", ""),
        (codecs.BOM_UTF16_LE, "utf-16-le", "utf-16"),
        (b"", "latin-1", "latin-1"),
    ],
)
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_save_keeps_encoding_bom_and_line_ends(tmp_path, mark, encoding, declared, newline):
    text = PLAIN.replace("<!-- the box -->", "<!-- ü -->").replace("\n", newline)
    if declared:
        text = text.replace('version="1.0"', f'version="1.0" encoding="{declared}"')
    path = tmp_path / "w.world"
    path.write_bytes(mark + text.encode(encoding))
    edited(path).save(None)
    data = path.read_bytes()
    assert data.startswith(mark)
    after = data.removeprefix(mark).decode(encoding)
    shown = "&#26426;&#22120;&#20154; é" if encoding == "latin-1" else "机器人 é"
    assert after == text.replace("'box'", f"'{shown}'")
    assert "机器人 é" in EditedWorld.of_file(path, NOWHERE).world.entities


def test_change_without_effect_adds_no_undo_step(tmp_path):
    path = tmp_path / "w.world"
    path.write_text(PLAIN)
    world = EditedWorld.of_file(path, NOWHERE)
    world.edit(lambda text: change(text, [Change("box", pose=(2, 0, 0.25, 0, 0, 0), size=(0.5, 0.5, 0.5))]))
    assert (world.can_undo, world.is_unsaved) == (False, False)
    world.undo()
    world.redo()
    assert world.world.text == PLAIN


def test_new_change_clears_redo(tmp_path):
    path = tmp_path / "w.world"
    path.write_text(PLAIN)
    world = edited(path, "a")
    world.undo()
    assert (world.can_undo, world.can_redo, world.is_unsaved) == (False, True, False)
    world.edit(lambda text: change(text, [Change("box", static=True)]))
    assert (world.can_undo, world.can_redo) == (True, False)


def test_save_does_not_overwrite_other_files(tmp_path):
    path, other = tmp_path / "w.world", tmp_path / "other.world"
    path.write_text(PLAIN)
    other.write_text("mine")
    world = edited(path)
    with pytest.raises(EditError, match=r"the file '.*other\.world' already exists: choose another name"):
        world.save("other.world")
    with pytest.raises(EditError, match=r"cannot write '.*none/w.world'"):
        world.save("none/w.world")
    for name in ("", "w.txt", "w.world.xacro", "a\0.world", "~nobody-at-all/w.world"):
        with pytest.raises(EditError, match=r"it must end in \.world or \.sdf"):
            world.save(name)
    assert (other.read_text(), path.read_text()) == ("mine", PLAIN)
    world.save(str(path))
    assert not world.is_unsaved
    path.unlink()
    world.save(None)
    assert path.exists()


def test_xacro_world_is_saved_expanded_to_new_file(tmp_path):
    path = tmp_path / "w.world.xacro"
    source = PLAIN.replace("-- dashes", "dashes").replace("<sdf ", '<sdf xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    path.write_text(source.replace(">2 0 0.250", ">${1 + 1} 0 0.250"))
    world = edited(path)
    assert (world.file, world.path) == (None, tmp_path / "w.world")
    with pytest.raises(EditError, match="no file yet"):
        world.save(None)
    with pytest.raises(EditError, match="it must end in"):
        world.save("w.world.xacro")
    world.save("made.world")
    assert world.file == tmp_path / "made.world"
    assert "${" in path.read_text()
    assert EditedWorld.of_file(world.file, NOWHERE).world.entities["机器人 é"].world_pose[0] == 2


def test_shipped_worlds_are_not_overwritten(tmp_path):
    import linkwright

    shipped = Path(linkwright.__file__).parent / "w.world"
    assert EditedWorld(PLAIN, shipped, NOWHERE).file is None
    path = model_file(Path(linkwright.__file__).parent / "sdf" / "models" / "sun")
    with pytest.raises(EditError, match="there is no world in"):
        EditedWorld.of_file(path, NOWHERE)


def test_unsaved_changes_are_stored(tmp_path):
    path, folder = tmp_path / "w.world", tmp_path / "state" / "unsaved"
    path.write_bytes(codecs.BOM_UTF8 + PLAIN.encode())
    result = [edited(path, name).store_unsaved(folder) for name in ("a", "b")]
    (file,) = folder.iterdir()
    assert [diagnostic.code for diagnostic in result] == ["RVIZ301", "RVIZ301"]
    assert f"'{path}'" in result[0].message
    assert f"'{file}'" in result[0].message
    assert file.read_bytes() == codecs.BOM_UTF8 + PLAIN.replace("'box'", "'b'").encode()
    (tmp_path / "file").touch()
    lost = edited(path).store_unsaved(tmp_path / "file" / "unsaved")
    assert (lost.code, "cannot write" in lost.message) == ("RVIZ104", True)
