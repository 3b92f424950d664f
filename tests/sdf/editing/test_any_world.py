"""Edits of generated worlds: an edit and its inverse restore the text."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from linkwright.sdf.editing import Change, change, copy, delete, group, ungroup
from linkwright.sdf.editing.shapes import format_length
from linkwright.sdf.frames import placed_links
from tests.sdf.editing.texts import world_text

NUMBERS = st.floats(-100, 100).map(lambda value: round(value, 6) or 0.0)
ANGLES = st.floats(-1.5, 1.5).map(lambda value: round(value, 6) or 0.0)
POSES = st.tuples(NUMBERS, NUMBERS, NUMBERS, ANGLES, ANGLES, ANGLES)
SIZES = st.tuples(*[st.floats(0.01, 50).map(lambda value: round(value, 4))] * 3)
SPACES = st.sampled_from(["", " ", "\n", "\n    ", "\t", "<!-- a < b -- c -->", "\n<!-- é 机器人 -->\n", "<?p i?>"])
QUOTES = st.sampled_from(["'", '"'])
SEPARATORS = st.sampled_from([" ", "  ", "\n\t"])
ENDS = st.sampled_from(["\n", "\r\n"])


@st.composite
def boxes(draw, name: str) -> str:
    """Generate a box in any notation and frame."""
    space, quote, separator = draw(SPACES), draw(QUOTES), draw(SEPARATORS)
    numbers = [format_length(number) for number in draw(POSES)]
    form = draw(st.sampled_from(["", ' relative_to="f"', " frame = 'f'"]))
    pose = draw(
        st.sampled_from([f"<pose{form}>{space if '?' not in space else ''}{separator.join(numbers)}</pose>", ""])
    )
    size = separator.join(format_length(length) for length in draw(SIZES))
    geometry = f"<geometry>{space}<box><size>{size}</size></box></geometry>"
    visual = f"<visual name={quote}v{quote}>{geometry}</visual>"
    inertial = draw(st.sampled_from(["", "<inertial><mass>2</mass></inertial>"]))
    link = f"<link name={quote}l{quote}>{inertial}{space}{visual}<collision name='c'>{geometry}</collision></link>"
    return f"{draw(SPACES)}<model name = {quote}{name}{quote} >{space}{pose}{link}{space}</model>{draw(SPACES)}"


@st.composite
def worlds(draw) -> str:
    """Generate a world with three boxes and a frame."""
    frame = f"<frame name='f'><pose>{' '.join(format_length(number) for number in draw(POSES))}</pose></frame>"
    models = [draw(boxes(name)) for name in ("a", "b&amp;c", "d")]
    text = f"<?xml version='1.0'?>\n<sdf version='1.9'>\n<world name='w'>{frame}{''.join(models)}\n</world>\n</sdf>\n"
    return text.replace("\n", draw(ENDS))


def link_poses(world) -> dict[str, tuple[float, ...]]:
    return {placed_link.name: placed_link.pose for placed_link in placed_links(world.world)}


def are_close(first, second, tolerance: float = 1e-6) -> bool:
    """Return whether transforms are equal; a quaternion equals its negative."""
    straight = all(abs(a - b) <= tolerance for a, b in zip(first[:3], second[:3], strict=True))
    return straight and abs(abs(sum(a * b for a, b in zip(first[3:], second[3:], strict=True))) - 1) <= tolerance


@settings(max_examples=40)
@given(worlds(), POSES, st.sampled_from(["a", "b&c", "d"]))
def test_moved_entity_has_new_pose_and_others_stay(text, pose, name):
    original = world_text(text)
    moved = change(original, [Change(name, pose=pose)])
    expected = world_text(
        f"<sdf version='1.9'><world name='w'><model name='m'><pose>{' '.join(map(format_length, pose))}</pose>"
        "<link name='l'/></model></world></sdf>"
    )
    assert are_close(moved.entities[name].world_pose, expected.entities["m"].world_pose, 1e-5)
    for other in {"a", "b&c", "d"} - {name}:
        assert moved.entities[other].world_pose == original.entities[other].world_pose
    element = original.entities[name].element
    start = element.offset
    tail_length = len(text) - text.index("</model>", start)
    assert moved.text[:start] == text[:start]
    assert moved.text[-tail_length:] == text[-tail_length:]


@settings(max_examples=40)
@given(worlds(), SIZES, st.booleans())
def test_inverse_size_and_name_changes_restore_text(text, size, is_repeated):
    original = world_text(text)
    old = original.entities["a"].shape.size
    names = ["a", "d"] if is_repeated else ["a"]
    changed = change(original, [Change(name, new_name=f"new {name}", size=size) for name in names])
    assert changed.entities["new a"].shape.size == size
    masses = [model.links[0].inertial for model in original.world.models]
    inverse = [Change(f"new {name}", new_name=name, size=original.entities[name].shape.size) for name in names]
    restored = change(changed, inverse)
    assert restored.entities["a"].shape.size == old
    if not any(masses):
        assert restored.text == text


@settings(max_examples=40)
@given(worlds(), st.tuples(NUMBERS, NUMBERS, NUMBERS))
def test_deleting_copies_restores_text(text, offset):
    original = world_text(text)
    with_copies, names = copy(original, ["a", "b&c", "d"], offset)
    assert names == ["a_2", "b&c_2", "d_2"]
    for name, new in zip(["a", "b&c", "d"], names, strict=True):
        old_pose = original.entities[name].world_pose
        expected_pose = (*(a + b for a, b in zip(old_pose[:3], offset, strict=True)), *old_pose[3:])
        assert are_close(with_copies.entities[new].world_pose, expected_pose, 1e-5)
        assert original.entities[name].element.text() == with_copies.entities[name].element.text()
    assert "".join(delete(with_copies, names).text.split()) == "".join(text.split())


@settings(max_examples=40)
@given(worlds())
def test_ungrouping_restores_poses(text):
    original = world_text(text)
    grouped = group(original, ["a", "d"], "g")
    assert set(grouped.entities) == {"g", "b&c"}
    poses_before, ungrouped = link_poses(original), ungroup(grouped, "g")[0]
    for name, pose in link_poses(ungrouped).items():
        assert are_close(pose, poses_before[name], 1e-5)
    for name, pose in link_poses(grouped).items():
        assert are_close(pose, poses_before[name.removeprefix("g::")], 1e-5)
