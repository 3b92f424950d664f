"""Opening and saving configurations from pages."""

from __future__ import annotations

import pytest
import yaml

from linkwright.graph import QoSProfile, ReliabilityPolicy
from linkwright.rviz import RvizConfig
from tests.viewer.configured import TEXT, PointStamped, display_names, open_configured, perform_edit


async def test_configuration_is_saved_and_reopened(tmp_path):
    path = tmp_path / "a.rviz"
    async with open_configured(path=path) as (_, client):
        assert client.first["configuration"]["path"] == str(path)
        await client.set("display-1/Alpha", 0.25)
        await client.until("configuration", unsaved=True)
        await client.send("save_configuration", path=None, replace=False)
        assert (await client.until("configuration_saved"))["path"] == str(path)
        state = await client.until("configuration", unsaved=False)
        while not state["recent"]:
            state = await client.until("configuration")
        assert state["recent"] == [str(path)]
        assert yaml.safe_load(path.read_text())["Visualization Manager"]["Displays"][0]["Alpha"] == 0.25
        await client.send("new_configuration", discard=False)
        tree = await client.until("tree")
        assert [display["name"] for display in tree["displays"]] == ["Grid"]
        state = await client.until("configuration", path=None)
        assert (state["opened"], state["unsaved"], state["undo"]) == (2, False, None)
        await client.send("open_configuration", path=str(path), discard=False)
        tree = await client.until("tree")
        assert [display["name"] for display in tree["displays"]] == ["Grid", "Marks", "Clicks", "Radar"]
        assert {display["id"] for display in tree["displays"]}.isdisjoint({f"display-{n}" for n in range(1, 6)})
    assert not list(tmp_path.glob(".*rviz*"))


async def test_unsaved_changes_are_not_discarded_without_confirmation(tmp_path):
    path = tmp_path / "a.rviz"
    path.write_text(TEXT, encoding="utf-8")
    async with open_configured() as (world, client):
        await client.set("display-1/Alpha", 0.25)
        await client.until("configuration", unsaved=True)
        for kind, fields in (
            ("new_configuration", {}),
            ("open_configuration", {"path": str(path)}),
            ("load_configuration", {"name": "b.rviz", "text": TEXT}),
        ):
            await client.send(kind, discard=False, **fields)
            assert (await client.until("configuration_refused"))["question"] == "unsaved"
        assert world.viewer.manager.opened == 1
        await client.send("open_configuration", path=str(path), discard=True)
        assert (await client.until("configuration", opened=2))["unsaved"] is False


async def test_existing_file_is_not_replaced_without_confirmation(tmp_path):
    path, other = tmp_path / "a.rviz", tmp_path / "b.rviz"
    other.write_text("precious", encoding="utf-8")
    async with open_configured(path=path) as (world, client):
        await client.send("save_configuration", path=str(other), replace=False)
        assert (await client.until("configuration_refused"))["question"] == "exists"
        assert other.read_text() == "precious"
        path.write_text(TEXT + "# by another\n", encoding="utf-8")
        await client.send("save_configuration", path=None, replace=False)
        assert (await client.until("configuration_refused"))["question"] == "changed_on_disk"
        await client.send("save_configuration", path=str(other), replace=True)
        await client.until("configuration_saved", path=str(other))
        assert world.viewer.config.path == other
        assert RvizConfig.load(other).displays
        await client.send("save_configuration", path="below/c.rviz", replace=False)
        assert "cannot write" in (await client.until("configuration_refused"))["message"]
        await client.send("save_configuration", path="c.rviz", replace=False)
        await client.until("configuration_saved", path=str(tmp_path / "c.rviz"))


@pytest.mark.parametrize("name", ["/etc/passwd", "a.yaml", "", "a.rviz\0", "link.rviz", "~nobody-at-all/a.rviz"])
async def test_only_rviz_files_are_opened_and_saved(tmp_path, name):
    (tmp_path / "secret.txt").write_text("secret", encoding="utf-8")
    (tmp_path / "link.rviz").symlink_to(tmp_path / "secret.txt")
    async with open_configured(path=tmp_path / "a.rviz") as (_, client):
        for kind, fields in (("save_configuration", {"replace": True}), ("open_configuration", {"discard": True})):
            await client.send(kind, path=name, **fields)
            refusal = await client.until("configuration_refused")
            assert "is not a valid file name for an RViz configuration" in refusal["message"]
    assert (tmp_path / "secret.txt").read_text() == "secret"


async def test_unreadable_configuration_is_reported_and_changes_nothing(tmp_path):
    (tmp_path / "bad.rviz").write_text("a: [1\n", encoding="utf-8")
    async with open_configured(path=tmp_path / "a.rviz") as (world, client):
        await client.send("open_configuration", path="bad.rviz", discard=True)
        assert "bad.rviz:2" in (await client.until("configuration_refused"))["message"]
        await client.send("load_configuration", name="mine.rviz", text="- 1\n", discard=True)
        assert "mine.rviz" in (await client.until("configuration_refused"))["message"]
        assert (world.viewer.manager.opened, len(display_names(world))) == (1, 4)


async def test_configuration_is_loaded_from_text():
    async with open_configured() as (_, client):
        await client.send("load_configuration", name="mine.rviz", text="\ufeff" + TEXT, discard=False)
        await client.until("configuration", opened=2)
        await client.send("request_configuration_text")
        response = await client.until("configuration_text")
        assert (response["name"], response["text"]) == ("untitled.rviz", TEXT)


async def test_configuration_is_reverted(tmp_path):
    async with open_configured(path=tmp_path / "a.rviz") as (world, client):
        await perform_edit(client, "remove_displays", displays=["display-1"])
        await client.send("revert_configuration")
        state = await client.until("configuration", opened=2)
        assert (state["unsaved"], display_names(world)) == (False, ["Grid", "Marks", "Clicks", "Radar"])


async def test_folders_are_listed(tmp_path):
    (tmp_path / "deeper").mkdir()
    (tmp_path / ".hidden").mkdir()
    (tmp_path / "b.rviz").touch()
    (tmp_path / "notes.txt").touch()
    async with open_configured(path=tmp_path / "a.rviz") as (_, client):
        await client.send("request_folder", path=None)
        folder = await client.until("folder")
        assert (folder["path"], folder["parent"]) == (str(tmp_path), str(tmp_path.parent))
        assert folder["folders"][-1] == "deeper"
        assert (".hidden" in folder["folders"], folder["files"]) == (False, ["a.rviz", "b.rviz"])
        await client.send("request_folder", path="deeper")
        assert (await client.until("folder"))["files"] == []
        for nowhere in ("/nowhere/at/all", "~nobody-at-all", "a\0b"):
            await client.send("request_folder", path=nowhere)
            assert "cannot list the folder" in (await client.until("configuration_refused"))["message"]


# --- files of RViz 1 -----------------------------------------------------------------------------------------------

ROS_1 = """\
Panels:
  - Class: rviz/Displays
    Name: Displays
Toolbars:
  toolButtonStyle: 2
Visualization Manager:
  Class: ""
  Displays:
    - Alpha: 0.5
      Class: rviz/Grid
      Enabled: true
      Name: Grid
      Reference Frame: <Fixed Frame>
      Value: true
    - Class: rviz/Group
      Displays:
        - Class: rviz/PointStamped
          Enabled: true
          Name: Clicks
          Queue Size: 7
          Topic: /clicked_point
          Unreliable: true
          Value: true
      Enabled: true
      Name: Marks
    - Class: rviz/RobotModel
      Enabled: true
      Links:
        All Links Enabled: true
        Link Tree Style: ""
      Name: RobotModel
      Robot Description: my_robot
      Value: true
    - Class: rviz/TF
      Enabled: true
      Frame Timeout: 15
      Frames:
        All Enabled: true
      Name: TF
      Tree:
        {}
      Value: true
    - Class: rviz/PointCloud
      Enabled: true
      Name: Cloud
      Style: Flat Squares
      Value: true
  Enabled: true
  Global Options:
    Background Color: 48; 48; 48
    Default Light: true
    Fixed Frame: base
    Frame Rate: 30
  Name: root
  Tools:
    - Class: rviz/Interact
      Hide Inactive Objects: true
    - Class: rviz/SetInitialPose
      Theta std deviation: 0.2617993950843811
      Topic: /initialpose
      X std deviation: 0.5
  Value: true
  Views:
    Current:
      Class: rviz/Orbit
      Distance: 18.42949676513672
      Field of View: 0.7853981852531433
      Name: Current View
      Target Frame: base_link
    Saved: ~
Window Geometry:
  QMainWindow State: 000000ff00000000fd0000000400
"""


async def test_rviz1_configuration_keeps_its_format():
    async with open_configured(ROS_1) as (world, client):
        displays = client.first["tree"]["displays"]
        assert [display["cls"] for display in displays][:5] == [
            "rviz_default_plugins/Grid",
            "rviz_common/Group",
            "rviz_default_plugins/PointStamped",
            "rviz_default_plugins/RobotModel",
            "rviz_default_plugins/TF",
        ]
        assert "RVIZ" not in world.logged()
        assert "used" not in world.logged()
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        publisher = world.graph.create_node("clicks").create_publisher(PointStamped, "/clicked_point", qos)
        assert publisher.get_subscription_count() == 1
        assert world.display("RobotModel").properties.text("Description Topic") == "my_robot"
        assert world.viewer.config.text() == ROS_1
        await client.set("display-3/Topic/Depth", 9)
        await client.until("configuration", unsaved=True)
        assert world.viewer.config.text() == ROS_1.replace("Queue Size: 7", "Queue Size: 9")
