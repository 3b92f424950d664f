"""The views of RViz: their properties, values and files."""

from __future__ import annotations

import pytest
import yaml

from linkwright.page.protocol.views_and_tools import View
from linkwright.rviz import RvizConfig
from linkwright.rviz.config.views import CURRENT_NAME, ORBIT, PITCH_LIMIT, VIEW_SCHEMAS, make_view_classes
from tests.viewer.scene import open_page, open_world

FLYING = """\
Visualization Manager:
  Views:
    Current:
      Class: rviz_default_plugins/FPS
      Enable Stereo Rendering:
        Stereo Eye Separation: 0.05999999865889549
        Stereo Focal Distance: 1
        Swap Stereo Eyes: false
        Value: false
      Invert Z Axis: false
      Mine: kept
      Name: Current View
      Near Clip Distance: 0.009999999776482582
      Pitch: 0.5
      Position:
        X: 1
        Y: 2
        Z: 3
      Target Frame: <Fixed Frame>
      Value: FPS (rviz)
      Yaw: -1
    Saved:
      - Class: rviz_default_plugins/TopDownOrtho
        Name: from above
        Scale: 70
        Other: kept
      - Class: somebody/Else
        Name: unknown
"""


def config_of(view: str) -> RvizConfig:
    return RvizConfig.parse(yaml.safe_dump({"Visualization Manager": {"Views": {"Current": yaml.safe_load(view)}}}))


def default_view(cls: str = ORBIT) -> View:
    """Return the default view of a class, as a page creates it."""
    return next(
        View(view_class.cls, CURRENT_NAME, view_class.defaults)
        for view_class in make_view_classes()
        if view_class.cls == cls
    )


def test_negative_scale_is_kept():
    """A long drag with the right button in RViz makes the scale negative."""
    config = config_of("{Class: rviz/TopDownOrtho, Scale: -88.9}")
    assert config.views.current.values["Scale"] == -88.9
    assert config.warnings == []


def test_view_classes_and_properties_match_rviz():
    classes = {view_class.cls.rpartition("/")[2]: view_class for view_class in make_view_classes()}
    assert list(classes) == ["FPS", "Orbit", "ThirdPersonFollower", "TopDownOrtho", "XYOrbit"]
    rows = [row.name for row in classes["Orbit"].properties]
    assert rows[:3] == ["Near Clip Distance", "Invert Z Axis", "Target Frame"]
    assert [row.name for row in classes["TopDownOrtho"].properties][2:] == ["Scale", "Angle", "X", "Y"]
    assert classes["FPS"].defaults["Position/Z"] == 10.0
    assert classes["XYOrbit"].defaults["Enable Stereo Rendering/Stereo Eye Separation"] == 0.06


@pytest.mark.parametrize("cls", VIEW_SCHEMAS)
def test_view_of_each_class_survives_saving(cls):
    config = RvizConfig.default()
    view = default_view(cls)
    view.values |= {name: value + 0.25 for name, value in view.values.items() if isinstance(value, float)}
    view.values["Target Frame"] = "base_link"
    config.views.current = view
    reread = RvizConfig.parse(config.text())
    assert reread.views.current == view
    assert reread.warnings == []
    current = yaml.safe_load(config.text())["Visualization Manager"]["Views"]["Current"]
    assert current["Value"].startswith(cls.rpartition("/")[2])


def test_file_changes_only_where_view_differs():
    config = RvizConfig.parse(FLYING)
    config.views.current = config.views.current
    assert config.text() == FLYING
    view = config.views.current
    view.values["Pitch"] = 0.75
    config.views.current = view
    assert config.text() == FLYING.replace("Pitch: 0.5", "Pitch: 0.75")


def test_view_values_are_clamped_and_angles_kept():
    config = config_of("{Class: rviz/Orbit, Pitch: 3, Yaw: -0.5, Near Clip Distance: 0}")
    values = config.views.current.values
    assert (values["Pitch"], values["Yaw"], values["Near Clip Distance"]) == (PITCH_LIMIT, -0.5, 0.001)
    assert config.views.current.cls == "rviz_default_plugins/Orbit"


def test_file_without_view_uses_rviz_default():
    assert RvizConfig.parse("Visualization Manager: {}").views.current == default_view()


def test_changing_view_class_removes_old_keys_and_keeps_unknown_ones():
    config = RvizConfig.parse(FLYING)
    config.views.current = default_view("rviz_default_plugins/TopDownOrtho")
    current = yaml.safe_load(config.text())["Visualization Manager"]["Views"]["Current"]
    assert current["Class"] == "rviz_default_plugins/TopDownOrtho"
    assert not {"Pitch", "Yaw", "Position"} & set(current)
    assert current["Mine"] == "kept"
    assert RvizConfig.parse(config.text()).views.current == default_view("rviz_default_plugins/TopDownOrtho")


def test_unknown_view_class_is_shown_as_orbit_and_kept_in_file():
    text = "Visualization Manager: {Views: {Current: {Class: mine/Fancy, Distance: 3}}}\n"
    config = RvizConfig.parse(text)
    assert [warning.code for warning in config.warnings] == ["RVIZ203"]
    view = config.views.current
    assert (view.cls, view.values["Distance"]) == ("rviz_default_plugins/Orbit", 3.0)
    config.views.current = view
    assert config.text() == text


def test_frame_aligned_view_is_shown_as_fps_and_keeps_its_class():
    text = (
        "Visualization Manager: {Views: {Current: {Class: rviz/FrameAligned, Name: Current View, "
        "Point towards: +x axis, Yaw: 1.5, Position: {X: 1, Y: 2, Z: 3}}}}\n"
    )
    config = RvizConfig.parse(text)
    assert [warning.message for warning in config.warnings] == [
        "the view class 'rviz/FrameAligned' is not supported; it is shown as FPS"
    ]
    view = config.views.current
    assert (view.cls, view.values["Yaw"], view.values["Position/Z"]) == ("rviz_default_plugins/FPS", 1.5, 3.0)
    view.values["Yaw"] = 2.0
    config.views.current = view
    assert config.text() == text.replace("1.5", "2.0")


@pytest.mark.parametrize(
    "view",
    [
        View("mine/Fancy", "Current View", {}),
        View("rviz_default_plugins/Orbit", "Current View", {"Focal Point": 1.0}),
        View("rviz_default_plugins/Orbit", "Current View", {"Distance": "far"}),
        View("rviz_default_plugins/FPS", "Current View", {"Distance": 1.0}),
        View("rviz_default_plugins/FPS", "n" * 5000, {}),
    ],
)
def test_invalid_view_is_rejected_and_nothing_is_written(view):
    config = RvizConfig.default()
    before = config.text()
    with pytest.raises(ValueError):
        config.views.current = view
    with pytest.raises(ValueError):
        config.views.save(view)
    assert config.text() == before


def test_saved_views_are_renamed_changed_and_removed():
    config = RvizConfig.parse(FLYING)
    above, unknown = config.views.saved
    assert config.views.saved[above].values["Scale"] == 70.0
    view = config.views.saved[above]
    view.name = "map"
    config.views.change(above, view)
    added = config.views.save(config.views.current)
    config.views.remove(unknown)
    saved = yaml.safe_load(config.text())["Visualization Manager"]["Views"]["Saved"]
    assert [(view["Class"].rpartition("/")[2], view["Name"]) for view in saved] == [
        ("TopDownOrtho", "map"),
        ("FPS", "Current View"),
    ]
    assert saved[0]["Other"] == "kept"
    assert saved[1]["Position"] == {"X": 1, "Y": 2, "Z": 3}
    reread = RvizConfig.parse(config.text()).views
    assert list(reread.saved.values()) == [config.views.saved[above], config.views.saved[added]]


def test_view_can_be_saved_to_file_without_saved_views():
    config = RvizConfig.default()
    config.views.save(default_view("rviz_default_plugins/FPS"))
    config = RvizConfig.parse(config.text())
    assert [view.cls for view in config.views.saved.values()] == ["rviz_default_plugins/FPS"]


async def test_pages_share_saved_views():
    async with open_world() as world, open_page(world.viewer) as first, open_page(world.viewer) as second:
        opening = await first.opened()
        await second.opened()
        assert opening["saved_views"]["views"] == []
        assert [view_class["cls"] for view_class in opening["view_classes"]["classes"]] == list(VIEW_SCHEMAS)
        view = opening["view_state"]["view"] | {"name": "mine"}
        await first.send("save_view", view=view)
        (saved,) = (await second.until("saved_views"))["views"]
        assert saved["view"] == view
        changed = view | {"name": "ours", "values": view["values"] | {"Distance": 4.0}}
        await second.send("change_saved_view", id=saved["id"], view=changed)
        await first.until("saved_views")
        assert (await first.until("saved_views"))["views"] == [saved | {"view": changed}]
        await first.send("remove_saved_view", id=saved["id"])
        await first.send("remove_saved_view", id=saved["id"])
        await first.send("save_view", view=view | {"cls": "no/Such"})
        assert (await first.until("saved_views"))["views"] == []
    assert "an invalid view" in world.logged()
