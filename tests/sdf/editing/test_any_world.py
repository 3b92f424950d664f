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
    gap, quote, between = draw(SPACES), draw(QUOTES), draw(SEPARATORS)
    numbers = [format_length(number) for number in draw(POSES)]
    form = draw(st.sampled_from(["", ' relative_to="f"', " frame = 'f'"]))
    pose = draw(st.sampled_from([f"<pose{form}>{gap if '?' not in gap else ''}{between.join(numbers)}</pose>", ""]))
    size = between.join(format_length(length) for length in draw(SIZES))
    geometry = f"<geometry>{gap}<box><size>{size}</size></box></geometry>"
    visual = f"<visual name={quote}v{quote}>{geometry}</visual>"
    inertial = draw(st.sampled_from(["", "<inertial><mass>2</mass></inertial>"]))
    link = f"<link name={quote}l{quote}>{inertial}{gap}{visual}<collision name='c'>{geometry}</collision></link>"
    return f"{draw(SPACES)}<model name = {quote}{name}{quote} >{gap}{pose}{link}{gap}</model>{draw(SPACES)}"


@st.composite
def worlds(draw) -> str:
    """Generate a world with three boxes and a frame."""
    frame = f"<frame name='f'><pose>{' '.join(format_length(number) for number in draw(POSES))}</pose></frame>"
    parts = [draw(boxes(name)) for name in ("a", "b&amp;c", "d")]
    text = f"<?xml version='1.0'?>\n<sdf version='1.9'>\n<world name='w'>{frame}{''.join(parts)}\n</world>\n</sdf>\n"
    return text.replace("\n", draw(ENDS))


def places(world) -> dict[str, tuple[float, ...]]:
    return {placed_link.name: placed_link.pose for placed_link in placed_links(world.world)}


def close(some, others, tolerance: float = 1e-6) -> bool:
    """Return whether transforms are equal; a quaternion equals its negative."""
    straight = all(abs(a - b) <= tolerance for a, b in zip(some[:3], others[:3], strict=True))
    return straight and abs(abs(sum(a * b for a, b in zip(some[3:], others[3:], strict=True))) - 1) <= tolerance


@settings(max_examples=40)
@given(worlds(), POSES, st.sampled_from(["a", "b&c", "d"]))
def test_moved_entity_has_new_pose_and_others_stay(text, pose, name):
    before = world_text(text)
    after = change(before, [Change(name, pose=pose)])
    wanted = world_text(
        f"<sdf version='1.9'><world name='w'><model name='m'><pose>{' '.join(map(format_length, pose))}</pose>"
        "<link name='l'/></model></world></sdf>"
    )
    assert close(after.entities[name].world_pose, wanted.entities["m"].world_pose, 1e-5)
    for other in {"a", "b&c", "d"} - {name}:
        assert after.entities[other].world_pose == before.entities[other].world_pose
    element = before.entities[name].element
    start = element.offset
    behind = len(text) - text.index("</model>", start)
    assert after.text[:start] == text[:start]
    assert after.text[-behind:] == text[-behind:]


@settings(max_examples=40)
@given(worlds(), SIZES, st.booleans())
def test_inverse_size_and_name_changes_restore_text(text, size, twice):
    before = world_text(text)
    old = before.entities["a"].shape.size
    names = ["a", "d"] if twice else ["a"]
    after = change(before, [Change(name, new_name=f"new {name}", size=size) for name in names])
    assert after.entities["new a"].shape.size == size
    masses = [model.links[0].inertial for model in before.world.models]
    back = [Change(f"new {name}", new_name=name, size=before.entities[name].shape.size) for name in names]
    again = change(after, back)
    assert again.entities["a"].shape.size == old
    if not any(masses):
        assert again.text == text


@settings(max_examples=40)
@given(worlds(), st.tuples(NUMBERS, NUMBERS, NUMBERS))
def test_deleting_copies_restores_text(text, offset):
    before = world_text(text)
    copied, names = copy(before, ["a", "b&c", "d"], offset)
    assert names == ["a_2", "b&c_2", "d_2"]
    for name, new in zip(["a", "b&c", "d"], names, strict=True):
        there = before.entities[name].world_pose
        moved = (*(a + b for a, b in zip(there[:3], offset, strict=True)), *there[3:])
        assert close(copied.entities[new].world_pose, moved, 1e-5)
        assert before.entities[name].element.text() == copied.entities[name].element.text()
    assert "".join(delete(copied, names).text.split()) == "".join(text.split())


@settings(max_examples=40)
@given(worlds())
def test_ungrouping_restores_poses(text):
    before = world_text(text)
    grouped = group(before, ["a", "d"], "g")
    assert set(grouped.entities) == {"g", "b&c"}
    there, apart = places(before), ungroup(grouped, "g")[0]
    for name, pose in places(apart).items():
        assert close(pose, there[name], 1e-5)
    for name, pose in places(grouped).items():
        assert close(pose, there[name.removeprefix("g::")], 1e-5)
