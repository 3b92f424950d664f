"""The lines of a review about plugins in parameter files whose packages are not declared."""

from __future__ import annotations

import pytest

MANIFEST = "<package format='2'><name>lamp</name><version>1.0.0</version>{}</package>\n"
PLANNER = "planner_server:\n  ros__parameters:\n    Grid:\n      plugin: lamp_planner/Lamp\n      tolerance: 0.5\n"
KINEMATICS = "arm:\n  kinematics_solver: kdl_kinematics_plugin/KDLKinematicsPlugin\n  timeout: 0.1\n"
CONTROLLERS = "controller_manager:\n  ros__parameters:\n    rate: 10\n"
DEPENDENCY = "<depend>{}</depend>"
REASON = "package.xml does not name '{}', without which the plugin is not loaded"


@pytest.mark.parametrize(
    ("text", "old", "new", "depend", "reasons"),
    [
        (PLANNER, "lamp_planner/Lamp", "sun_planner/Sun", "", [REASON.format("sun_planner")]),
        (PLANNER, "lamp_planner/Lamp", "sun_planner::deep::Sun", "", [REASON.format("sun_planner")]),
        (PLANNER, "lamp_planner/Lamp", "sun_planner/Sun", "sun_planner", []),
        (PLANNER, "lamp_planner/Lamp", "nav2_smac_planner/Grid", "navigation2", []),
        (PLANNER, "lamp_planner/Lamp", "opennav_docking::Dock", "nav2_bringup", []),
        (PLANNER, "lamp_planner/Lamp", "lamp_planner/Candle", "", []),
        (PLANNER, "lamp_planner/Lamp", "solver_plugins::CeresSolver", "", []),
        (PLANNER, "lamp_planner/Lamp", "lamp_plans/Lamp", "", []),
        (PLANNER, "lamp_planner/Lamp", "lamp_planner::Lamp", "", []),
        (
            PLANNER,
            "tolerance: 0.5",
            "tolerance: 0.5\n      layer: {plugin: sun_layer/Sun}",
            "",
            [REASON.format("sun_layer")],
        ),
        (PLANNER, "tolerance: 0.5", "tolerance: 0.5\n      note: sun_layer/Sun", "", []),
        (KINEMATICS, "kdl_kinematics_plugin/KDL", "fast_ik/Fast", "", [REASON.format("fast_ik")]),
        (KINEMATICS, "kdl_kinematics_plugin/KDL", "lma_kinematics_plugin/LMA", "", []),
        (CONTROLLERS, "rate: 10\n", "rate: 10\n    arm: {type: sun_controllers/Sun}\n", "", []),
    ],
)
def test_a_plugin_of_an_undeclared_package_is_breaking(repository, compare, text, old, new, depend, reasons):
    dependency = DEPENDENCY.format(depend) if depend else ""
    repository.commit({"lamp/package.xml": MANIFEST.format(dependency), "lamp/config/a.yaml": text})
    repository.write({"lamp/config/a.yaml": text.replace(old, new)})
    result = compare(repository)
    assert [str(change.reason) for _, change in result.breaking_changes] == reasons


LAYER = "costmap:\n  ros__parameters:\n    layer:\n      plugin: {}\n"
VOXELS = "nav2_costmap_2d::VoxelLayer"


@pytest.mark.parametrize(
    ("text", "old", "new", "reason"),
    [
        (LAYER, VOXELS, "nav2_costmap_2d/VoxelLayer",
         f"there is no plugin 'nav2_costmap_2d/VoxelLayer', only '{VOXELS}'"),
        (LAYER, "nav2_costmap_2d/VoxelLayer", VOXELS, None),
        (LAYER, "nav2_costmap_2d/VoxelLayer", "nav2_costmap_2d/StaticLayer", None),
        (LAYER, "nav2_navfn_planner::NavfnPlanner", "nav2_navfn_planner/NavfnPlanner", None),
        ("moveit_controller_manager: {}\n", "moveit_simple_controller_manager/MoveItSimpleControllerManager",
         "controller_manager/MoveItSimpleControllerManager",
         ("there is no plugin 'controller_manager/MoveItSimpleControllerManager', only "
          "'moveit_simple_controller_manager/MoveItSimpleControllerManager'")),
        ("arm:\n  kinematics_solver: {}\n", "kdl_kinematics_plugin/KDLKinematicsPlugin",
         "kdl_kinematics_plugin/IKFastKinematics",
         ("there is no plugin 'kdl_kinematics_plugin/IKFastKinematics', "
          "only 'kdl_kinematics_plugin/KDLKinematicsPlugin'")),
    ],
)  # fmt: skip
def test_a_plugin_that_its_known_package_does_not_have_is_breaking(repository, compare, text, old, new, reason):
    depends = "".join(DEPENDENCY.format(name) for name in ("nav2_costmap_2d", "nav2_navfn_planner"))
    repository.commit({"lamp/package.xml": MANIFEST.format(depends), "lamp/config/a.yaml": text.format(old)})
    repository.write({"lamp/config/a.yaml": text.format(new)})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    assert reasons == ([] if reason is None else [reason])


def test_an_added_plugin_that_its_known_package_does_not_have_is_breaking(repository, compare):
    manifest = MANIFEST.format(DEPENDENCY.format("nav2_costmap_2d"))
    repository.commit({"lamp/package.xml": manifest, "lamp/config/a.yaml": LAYER.format(VOXELS)})
    added = "    other:\n      plugin: nav2_costmap_2d/StaticLayer\n"
    repository.write({"lamp/config/a.yaml": LAYER.format(VOXELS) + added})
    (change,) = [change for _, change in compare(repository).breaking_changes]
    assert str(change.sentence) == "costmap.ros__parameters.other.plugin nav2_costmap_2d/StaticLayer added"


@pytest.mark.parametrize(
    ("started", "type_", "reasons"),
    [
        ("arm", "sun_controllers/Sun", [REASON.format("sun_controllers")]),
        ("wrist", "sun_controllers/Sun", []),
        ("arm_2", "sun_controllers/Sun", []),
        ("arm", "lamp/Lamp", []),
    ],
)
def test_the_type_of_an_added_controller_that_a_launch_file_starts(repository, compare, started, type_, reasons):
    spawner = f"<launch><node pkg='controller_manager' exec='spawner' args='{started}'/></launch>\n"
    files = {"lamp/package.xml": MANIFEST.format(""), "lamp/launch/a.launch.xml": spawner}
    repository.commit({"lamp/config/a.yaml": CONTROLLERS, **files})
    repository.write({"lamp/config/a.yaml": f"{CONTROLLERS}    arm: {{type: {type_}}}\n"})
    assert [str(change.reason) for _, change in compare(repository).breaking_changes] == reasons


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("sun_planner/package.xml", "<package format='2'><name>sun_planner</name><version>1.0.0</version></package>\n"),
        ("lamp/config/other.yaml", "planner: {plugin: sun_planner/Sun}\n"),
    ],
)
def test_a_package_that_the_old_version_has_or_names(repository, compare, path, text):
    repository.commit({"lamp/package.xml": MANIFEST.format(""), "lamp/config/a.yaml": PLANNER, path: text})
    repository.write({"lamp/config/a.yaml": PLANNER.replace("lamp_planner/Lamp", "sun_planner/Sun")})
    assert [change for _, change in compare(repository).breaking_changes] == []


@pytest.mark.parametrize(("controller", "reasons"), [("arm", [REASON.format("sun_controllers")]), ("hand", [])])
def test_a_controller_of_an_undeclared_package_that_a_launch_file_starts(repository, compare, controller, reasons):
    launch = f'<launch><node pkg="controller_manager" exec="spawner" args="{controller}"/></launch>\n'
    files = {"lamp/package.xml": MANIFEST.format(""), "lamp/launch/a.launch.xml": launch}
    repository.commit({**files, "lamp/config/a.yaml": CONTROLLERS})
    repository.write({"lamp/config/a.yaml": f"{CONTROLLERS}    arm: {{type: sun_controllers/Sun}}\n"})
    assert [str(change.reason) for _, change in compare(repository).breaking_changes] == reasons


LAUNCH = "<launch>\n  <param name='{}' value='{}'/>\n  <node pkg='lamp' type='lamp' name='lamp'/>\n</launch>\n"


@pytest.mark.parametrize(
    ("parameter", "value", "depend", "is_breaking"),
    [
        ("moveit_controller_manager", "sun_controllers/Manager", "", True),
        ("move_base/base_global_planner", "sun_planner/Sun", "", True),
        ("move_base/base_global_planner", "base_local_planner/Sun", "move_base", False),
        ("moveit_controller_manager", "sun_controllers/Manager", "sun_controllers", False),
        ("greeting", "sun_controllers/Manager", "", False),
    ],
)
@pytest.mark.parametrize("old", [None, "<launch>\n</launch>\n"])
def test_a_launch_file_that_newly_loads_a_plugin_of_an_undeclared_package_is_breaking(
    repository, compare, parameter, value, depend, is_breaking, old
):
    dependency = DEPENDENCY.format(depend) if depend else ""
    path = "lamp/launch/a.launch"
    files = {"lamp/package.xml": MANIFEST.format(dependency), path: old}
    repository.commit({name: text for name, text in files.items() if text is not None})
    repository.write({path: LAUNCH.format(parameter, value)})
    changes = [change for _, change in compare(repository).breaking_changes]
    line = f"loads the plugin '{value}' for the first time", REASON.format(value.partition("/")[0])
    assert [(str(change.sentence), str(change.reason)) for change in changes] == ([line] if is_breaking else [])


def test_a_plugin_that_the_launch_file_loaded_before_is_no_change(repository, compare):
    path, text = "lamp/launch/a.launch", LAUNCH.format("arm_plugin", "sun_arm/Arm")
    repository.commit({"lamp/package.xml": MANIFEST.format(""), path: text})
    repository.write({path: text.replace("name='lamp'", "name='light'")})
    assert not any("loads the plugin" in str(change.sentence) for _, change in compare(repository).breaking_changes)
