"""Included models: the search for their files, and the resulting models."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.packages import PackageFinder
from linkwright.sdf.frames import Frames, placed_links
from linkwright.sdf.includes import resolve_includes
from linkwright.sdf.resources import Missing, ResourceFinder, find_model_file
from tests.sdf.worlds import examine_world_in, read_sdf, write_files


def sdf_text(elements: str, version: str = "1.9") -> str:
    return f'<sdf version="{version}">{elements}</sdf>'


BOX = sdf_text('<model name="box"><link name="l"/></model>')


def model_names(world_reading) -> list[str]:
    return [model.name for model in world_reading.sdf.worlds[0].models]


def test_model_is_found_through_each_environment_variable(tmp_path):
    for variable in ("GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH"):
        write_files(tmp_path, {f"{variable}/box/model.sdf": BOX.replace("box", variable)})
        world_reading = examine_world_in(
            tmp_path, "<include><uri>model://box</uri></include>", **{variable: f"/nowhere:{tmp_path / variable}"}
        )
        assert (model_names(world_reading), world_reading.diagnostics) == ([variable], ())
        assert world_reading.files[1] == tmp_path / variable / "box" / "model.sdf"


def test_model_is_found_in_packages(tmp_path):
    manifest = "<package><name>{}</name>{}</package>"
    export = '<export><gazebo_ros gazebo_model_path="${prefix}/assets:${prefix}/more"/></export>'
    write_files(
        tmp_path,
        {
            "one/package.xml": manifest.format("one", export),
            "one/assets/in_assets/model.sdf": BOX.replace("box", "a"),
            "one/more/in_more/model.sdf": BOX.replace("box", "b"),
            "two/package.xml": manifest.format("two", ""),
            "two/models/in_models/model.sdf": BOX.replace("box", "c"),
            "two/any/model.sdf": BOX.replace("box", "d"),
        },
    )
    addresses = ["model://in_assets", "model://in_more", "model://in_models", "model://two/any", "package://two/any"]
    addresses += ["two/any", "two/any/model.sdf", f"file://{tmp_path}/two/any/model.sdf"]
    names = [
        f"<include><uri>{address}</uri><name>m{number}</name></include>" for number, address in enumerate(addresses)
    ]
    world_reading = examine_world_in(tmp_path, "".join(names))
    assert world_reading.diagnostics == ()
    assert len(model_names(world_reading)) == len(addresses)


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("hooks/a.dsv.in", "prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share/@PROJECT_NAME@/assets\n"),
        ("hook/a.dsv", "set;X;1\nprepend-non-duplicate;IGN_GAZEBO_RESOURCE_PATH;share/one/assets;extra\n"),
        (
            "env-hooks/a.sh.in",
            'ament_prepend_unique_value GAZEBO_MODEL_PATH "$AMENT_CURRENT_PREFIX/share/one/assets"\n',
        ),
        ("package.xml", '<export><gazebo_ros gazebo_media_path="${prefix}/assets"/></export>'),
    ],
)
def test_model_is_found_through_package_hook_or_export(tmp_path, file, text):
    files = {"one/package.xml": "<package><name>one</name></package>", "one/assets/box/model.sdf": BOX}
    file_text = f"<package><name>one</name>{text}</package>" if file == "package.xml" else text
    write_files(tmp_path, {**files, f"one/{file}": file_text})
    world_reading = examine_world_in(tmp_path, "<include><uri>model://box</uri></include>")
    assert (model_names(world_reading), world_reading.diagnostics) == (["box"], ())


def test_share_folder_hook_is_used_and_unreadable_hook_ignored(tmp_path):
    hook = "prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share\n"
    write_files(tmp_path, {"one/package.xml": "<package><name>one</name></package>", "one/hooks/a.dsv": hook})
    (tmp_path / "one/hooks/b.dsv").write_bytes(b"\xff;GZ_SIM_RESOURCE_PATH\x00")
    (tmp_path / "one/hooks/c.dsv").mkdir()
    write_files(tmp_path, {"box/model.sdf": BOX})
    assert model_names(examine_world_in(tmp_path, "<include><uri>model://box</uri></include>")) == ["box"]


def test_model_is_found_near_including_file(tmp_path):
    write_files(tmp_path, {"models/box/model.sdf": BOX, "worlds/x": ""})
    finder = ResourceFinder(PackageFinder(start=tmp_path / "worlds", environment={}), {"HOME": "/nowhere"})
    for folder in (tmp_path, tmp_path / "worlds", tmp_path / "models", tmp_path / "models/box"):
        assert finder.model("model://box", folder) == tmp_path / "models/box/model.sdf"


def test_relative_file_uri_is_found_in_search_path(tmp_path):
    write_files(tmp_path, {"a/models/box/meshes/m.stl": ""})
    packages = PackageFinder(start=tmp_path / "b", environment={})
    mesh = tmp_path / "a/models/box/meshes/m.stl"
    for folder in ("a", "a/models"):
        finder = ResourceFinder(packages, {"GAZEBO_RESOURCE_PATH": str(tmp_path / folder)})
        assert finder.file("file://models/box/meshes/m.stl", Path("/nowhere")) == mesh
        assert finder.file("file://box/meshes/m.stl", Path("/nowhere")) == mesh
    finder = ResourceFinder(packages, {})
    assert finder.file("file://models/box/meshes/m.stl", mesh.parents[1]) == mesh
    assert isinstance(finder.file("file://models/box/meshes/no.stl", mesh.parents[1]), Missing)


@pytest.mark.parametrize(("address", "severity"), [("media/models/walk.dae", "INFO"), ("meshes/walk.dae", "WARNING")])
def test_missing_gazebo_classic_media_is_info(tmp_path, address, severity):
    finding = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {}).file(f"file://{address}", tmp_path)
    assert isinstance(finding, Missing)
    assert finding.severity.name == severity


def test_newest_supported_model_version_is_used(tmp_path):
    config = "<model>{}</model>".format(
        "".join(f'<sdf version="{version}">{version}.sdf</sdf>' for version in ("1.4", "1.12", "1.99", "1.5"))
    )
    write_files(
        tmp_path, {"m/model.config": config, **{f"m/{version}.sdf": BOX for version in ("1.4", "1.12", "1.99", "1.5")}}
    )
    assert find_model_file(tmp_path / "m") == tmp_path / "m" / "1.12.sdf"
    assert isinstance(find_model_file(tmp_path), Missing)


def test_fuel_models_are_found_in_gz_cache(tmp_path):
    cache_path = "fuel.gazebosim.org/openrobotics/models/cafe table"
    write_files(
        tmp_path,
        {
            f".gz/fuel/{cache_path}/2/model.sdf": BOX.replace("box", "two"),
            f".gz/fuel/{cache_path}/10/model.sdf": BOX.replace("box", "ten"),
            ".ignition/fuel/fuel.ignitionrobotics.org/someone/models/old/1/model.sdf": BOX,
        },
    )
    cafe = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Cafe table"
    for address, name in (
        (cafe, "ten"),
        (f"{cafe}/tip", "ten"),
        (f"{cafe}/2", "two"),
        (cafe.replace(" ", "%20"), "ten"),
        ("https://fuel.ignitionrobotics.org/1.0/someone/models/Old", "box"),
        ("https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane", "ground_plane"),
    ):
        world_reading = examine_world_in(tmp_path, f"<include><uri>{address}</uri></include>")
        assert (model_names(world_reading), world_reading.diagnostics) == ([name], ())


def test_built_in_sun_and_ground_plane_are_included(tmp_path):
    includes = "<include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>"
    world_reading = examine_world_in(tmp_path, includes)
    assert world_reading.sdf is not None
    world = world_reading.sdf.worlds[0]
    assert [light.name for light in world.lights] == ["sun"]
    assert [(model.name, model.static) for model in world.models] == [("ground_plane", True)]


def test_include_overrides_name_pose_and_static(tmp_path):
    write_files(
        tmp_path, {"box/model.sdf": sdf_text('<model name="box"><pose>1 1 1 0 0 0</pose><link name="l"/></model>')}
    )
    world_reading = examine_world_in(
        tmp_path,
        """<include><uri>box</uri></include><include><uri>box</uri><name>other</name><pose>0 0 2 0 0 0</pose>
        <static>true</static><plugin filename="p"/></include>""",
    )
    assert world_reading.sdf is not None
    first, second = world_reading.sdf.worlds[0].models
    assert (first.name, first.pose.pose.xyz, first.static, first.plugins) == ("box", (1, 1, 1), False, ())
    assert (second.name, second.pose.pose.xyz, second.static) == ("other", (0, 0, 2), True)
    assert [plugin.filename for plugin in second.plugins] == ["p"]


def test_nested_includes_are_placed(tmp_path):
    write_files(
        tmp_path,
        {
            "models/car/model.sdf": sdf_text(
                """<model name="car"><link name="body"/><include><uri>model://wheel</uri><name>left</name>
                <pose relative_to="body">0 1 0 0 0 0</pose></include>
                <joint name="j" type="revolute"><parent>body</parent><child>left::rim</child></joint></model>"""
            ),
            "models/wheel/model.sdf": sdf_text('<model name="wheel"><link name="rim"/></model>'),
        },
    )
    includes = "<include><uri>model://car</uri><pose>5 0 0 0 0 0</pose></include>"
    world_reading = examine_world_in(tmp_path, includes, GZ_SIM_RESOURCE_PATH=str(tmp_path / "models"))
    assert world_reading.diagnostics == ()
    assert world_reading.sdf is not None
    positions = {placed_link.name: placed_link.pose[:3] for placed_link in placed_links(world_reading.sdf.worlds[0])}
    assert positions == {"car::body": (5, 0, 0), "car::left::rim": (5, 1, 0)}


def test_merged_include_joins_enclosing_model(tmp_path):
    write_files(
        tmp_path,
        {
            "mast/model.sdf": sdf_text(
                """<model name="mast" placement_frame="foot"><link name="pole"><pose>0 0 1 0 0 0</pose></link>
                <link name="lamp"><pose relative_to="pole">0 0 1 0 0 0</pose></link>
                <frame name="foot"><pose>1 0 0 0 0 0</pose></frame>
                <joint name="weld" type="fixed"><parent>__model__</parent><child>lamp</child></joint></model>"""
            )
        },
    )
    world_reading = examine_world_in(
        tmp_path,
        """<model name="m"><link name="base"/><include merge="true"><uri>mast</uri><pose>0 0 5 0 0 0</pose></include>
        <joint name="j" type="fixed"><parent>base</parent><child>pole</child></joint></model>""",
    )
    assert world_reading.diagnostics == ()
    assert world_reading.sdf is not None
    model = world_reading.sdf.worlds[0].models[0]
    assert [link.name for link in model.links] == ["base", "pole", "lamp"]
    frames = Frames(model)
    assert frames.pose("pole")[:3] == pytest.approx((-1, 0, 6))
    assert frames.pose("lamp")[:3] == pytest.approx((-1, 0, 7))
    assert frames.pose("foot")[:3] == pytest.approx((0, 0, 5))
    assert model.joints[1].parent == "_merged__mast__model__"
    assert frames.link("_merged__mast__model__") == "pole"


def test_failed_include_in_merged_model_is_reported_once(tmp_path):
    write_files(
        tmp_path, {"mast/model.sdf": sdf_text('<model name="mast"><include><uri>model://pole</uri></include></model>')}
    )
    world_reading = examine_world_in(
        tmp_path,
        """<model name="m"><include merge="true"><uri>mast</uri></include>
        <joint name="j" type="fixed"><parent>world</parent><child>pole::link</child></joint></model>""",
    )
    assert [diagnostic.code for diagnostic in world_reading.diagnostics] == ["SDF160"]


def test_missing_placement_frame_of_merged_model_is_reported(tmp_path):
    write_files(
        tmp_path, {"mast/model.sdf": sdf_text('<model name="mast" placement_frame="foot"><link name="pole"/></model>')}
    )
    world_reading = examine_world_in(
        tmp_path,
        """<model name="m"><link name="base"/><include merge="true"><uri>mast</uri><pose>0 0 5 0 0 0</pose></include>
        </model>""",
    )
    assert [diagnostic.code for diagnostic in world_reading.diagnostics] == ["SDF141"]
    assert world_reading.sdf is not None
    assert Frames(world_reading.sdf.worlds[0].models[0]).pose("pole")[:3] == (0, 0, 5)


@pytest.mark.parametrize(
    ("element", "kind"),
    [('<model name="box"><link name="l"/></model>', "models"), ('<light name="box" type="point"/>', "lights")],
)
def test_file_can_consist_of_an_include(tmp_path, element, kind):
    write_files(tmp_path, {"box/model.sdf": sdf_text(element)})
    sdf = read_sdf('<sdf version="1.9"><include><uri>box</uri><name>b</name></include></sdf>')
    included = resolve_includes(sdf, tmp_path / "w.sdf", ResourceFinder(PackageFinder(start=[tmp_path]), {}))
    assert [entity.name for entity in getattr(included.sdf, kind)] == ["b"]
    assert not included.sdf.includes
    assert not included.diagnostics


def test_lights_and_actors_can_be_included(tmp_path):
    write_files(tmp_path, {"lamp/model.sdf": sdf_text('<light name="lamp" type="point"/>')})
    write_files(tmp_path, {"walker/model.sdf": sdf_text('<actor name="walker"/>')})
    world_reading = examine_world_in(
        tmp_path,
        """<include><uri>lamp</uri><name>l</name><pose>0 0 3 0 0 0</pose></include>
        <include><uri>walker</uri></include>""",
    )
    assert world_reading.sdf is not None
    world = world_reading.sdf.worlds[0]
    assert [(light.name, light.pose.pose.xyz) for light in world.lights] == [("l", (0, 0, 3))]
    assert [actor.name for actor in world.actors] == ["walker"]


def test_failed_includes_are_reported_once_and_rest_is_kept(tmp_path):
    write_files(
        tmp_path,
        {
            "again/model.sdf": sdf_text('<model name="again"><include><uri>model.sdf</uri></include></model>'),
            "broken/model.sdf": "<sdf",
            "nothing/model.sdf": sdf_text('<world name="w"/>'),
            "doubtful/model.sdf": sdf_text('<model name="d"><link name="l"/><lnk name="k"/></model>'),
        },
    )
    world_reading = examine_world_in(
        tmp_path,
        "<include><uri>again</uri></include><include><uri>broken</uri></include><include><uri>nothing</uri></include>"
        "<include><uri>doubtful</uri></include><include><uri>doubtful</uri><name>e</name></include>"
        '<model name="m"><static>1</static></model>',
    )
    assert sorted(diagnostic.code for diagnostic in world_reading.diagnostics) == [
        "SDF150",
        "SDF160",
        "SDF161",
        "XML203",
    ]
    assert model_names(world_reading) == ["m", "again", "d", "e"]
    doubtful = next(diagnostic for diagnostic in world_reading.diagnostics if diagnostic.code == "SDF150")
    assert doubtful.span is not None
    assert doubtful.span.file.endswith("doubtful/model.sdf")
    assert doubtful.notes[-1].span is not None
    assert doubtful.notes[-1].span.file.endswith("w.world")


def test_names_in_missing_model_are_not_reported(tmp_path):
    world_reading = examine_world_in(
        tmp_path,
        """<model name="m"><link name="l"/><include><uri>model://arm</uri><name>arm</name></include>
        <joint name="j" type="fixed"><parent>l</parent><child>arm::base</child></joint></model>""",
    )
    assert [diagnostic.code for diagnostic in world_reading.diagnostics] == ["SDF160"]


def test_missing_file_of_known_or_renamed_model_is_warning(tmp_path):
    write_files(tmp_path, {"box/model.sdf": BOX, "box/model.config": "<model/>", "box/meshes/a.stl": ""})
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {"GZ_SIM_RESOURCE_PATH": str(tmp_path)})
    facts = {}
    for address in ("model://box/meshes/b.stl", "model://old_box/meshes/a.stl", "model://far/meshes/b.stl"):
        finding = finder.file(address, tmp_path / "box")
        assert isinstance(finding, Missing)
        facts[address.split("/")[2]] = (finding.severity.name, str(finding.hint))
    assert facts == {
        "box": ("WARNING", "choose from a.stl"),
        "old_box": ("WARNING", "the folder that contains 'meshes/a.stl' is named 'box'"),
        "far": ("INFO", "add the folder that contains 'far' to GZ_SIM_RESOURCE_PATH"),
    }


@pytest.mark.parametrize("name", ["boxed", "box_steel", "old_box"])
def test_similar_model_name_is_not_reported_as_misspelled(tmp_path, name):
    """A model name that shares a word with a built-in model may be correct.

    Gazebo has many models.
    """
    write_files(tmp_path, {"box/model.sdf": BOX, "suv/model.sdf": BOX})
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {"GZ_SIM_RESOURCE_PATH": str(tmp_path)})
    finding = finder.file(f"model://{name}", tmp_path)
    assert isinstance(finding, Missing)
    assert finding.severity.name == "INFO"
    sun = finder.file("model://sub", tmp_path)
    assert isinstance(sun, Missing)
    assert sun.severity.name == "INFO"


@pytest.mark.parametrize(
    ("address", "found"),
    [
        ("model://worlds/yard/shed.sdf", "arena/worlds/yard/shed.sdf"),
        ("model://models/hut/meshes/hut.stl", "arena/sim/models/hut/meshes/hut.stl"),
        ("model://hut", "arena/sim/models/hut"),
        ("model://tent", "arena/tent"),
        ("model://worlds", None),
    ],
)
def test_model_is_found_from_each_folder_of_package(tmp_path, address, found):
    """Launch files add one of these folders to Gazebo's variables."""
    files = ["worlds/yard/shed.sdf", "sim/models/hut/model.sdf", "sim/models/hut/meshes/hut.stl", "tent/model.sdf"]
    write_files(
        tmp_path,
        {
            "arena/package.xml": "<package><name>arena</name></package>",
            **{f"arena/{file}": BOX for file in files},
        },
    )
    finder = ResourceFinder(PackageFinder(start=tmp_path / "arena/tent", environment={}), {})
    path = finder.file(address, tmp_path / "arena/sim/models/hut/config")
    assert (None if isinstance(path, Missing) else path.relative_to(tmp_path).as_posix()) == found


def test_misspelled_model_is_warning(tmp_path):
    write_files(tmp_path, {"crate/model.sdf": BOX})
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {"GZ_SIM_RESOURCE_PATH": str(tmp_path)})
    finding = finder.file("model://craet", tmp_path)
    assert isinstance(finding, Missing)
    assert (finding.severity.name, str(finding.hint)) == ("WARNING", "did you mean 'crate'?")


def test_misspelled_uri_scheme_is_reported(tmp_path):
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {})
    finding = finder.file("models://boat/meshes/hull.dae", tmp_path)
    assert isinstance(finding, Missing)
    assert str(finding.hint) == "did you mean 'model'?"


@pytest.mark.parametrize("ending", [".jinja", ".em", ".erb", ".xacro"])
def test_file_generated_from_template_is_info(tmp_path, ending):
    files = {f"plane/plane.sdf{ending}": "", "plane/model.config": "<model/>", f"plane/meshes/wing.stl{ending}": ""}
    write_files(tmp_path, files)
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {"GZ_SIM_RESOURCE_PATH": str(tmp_path)})
    model, mesh = finder.model("model://plane", tmp_path), finder.file("model://plane/meshes/wing.stl", tmp_path)
    assert isinstance(model, Missing)
    assert isinstance(mesh, Missing)
    assert (model.severity.name, str(model.hint)) == ("INFO", f"the build creates it from 'plane.sdf{ending}'")
    assert (mesh.severity.name, str(mesh.hint)) == ("INFO", f"the build creates it from 'wing.stl{ending}'")


def test_missing_file_of_built_in_model_is_info(tmp_path):
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {})
    own_model = finder.model("model://person_standing", tmp_path)
    assert isinstance(own_model, Path)
    for folder, severity in ((tmp_path, "INFO"), (own_model.parent, "WARNING")):
        finding = finder.file("model://person_standing/meshes/no.dae", folder)
        assert isinstance(finding, Missing)
        assert finding.severity.name == severity


def test_file_uri_with_wrong_case_suggests_file(tmp_path):
    write_files(tmp_path, {"models/lamp/meshes/lamp_visual.DAE": ""})
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {})
    finding = finder.file("file://models/lamp/meshes/Lamp_visual.DAE", tmp_path / "models" / "lamp")
    assert isinstance(finding, Missing)
    assert str(finding.hint) == "did you mean 'lamp_visual.DAE'?"


def test_number_of_included_models_is_limited(tmp_path, monkeypatch):
    """The number of included models is limited.

    If each of thirty models includes the next one twice, the world has a thousand million models.
    """
    monkeypatch.setattr("linkwright.sdf.includes._MAX_MODELS", 500)
    two_includes = "<include><uri>model://m{0}</uri><name>a</name></include><include><uri>model://m{0}</uri><name>b</name></include>"
    files = {
        f"m{number}/model.sdf": sdf_text(f'<model name="m{number}">{two_includes.format(number + 1)}</model>')
        for number in range(30)
    }
    write_files(tmp_path, {**files, "m30/model.sdf": BOX})
    world_reading = examine_world_in(
        tmp_path, "<include><uri>model://m0</uri></include>", GZ_SIM_RESOURCE_PATH=str(tmp_path)
    )
    assert [diagnostic.code for diagnostic in world_reading.diagnostics].count("SDF161") == 1


@pytest.mark.parametrize("name", ["w.sdf.xacro", "w.sdf", "w.world"])
def test_world_is_expanded_with_xacro(tmp_path, name):
    from linkwright.descriptions import examine_world

    path = tmp_path / name
    path.write_text(
        """<sdf version="1.9" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" default="2"/>
        <world name="w"><xacro:property name="h" value="${0.5 * $(arg n)}"/><model name="m"><pose>0 0 ${h} 0 0 0</pose>
        <static>1</static></model></world></sdf>""",
        encoding="utf-8",
    )
    world_reading = examine_world(path, arguments={"n": "6"}, environment={})
    assert world_reading.diagnostics == ()
    assert world_reading.sdf is not None
    assert world_reading.sdf.worlds[0].models[0].pose.pose.xyz == (0, 0, 3)


def test_all_available_models_are_listed(tmp_path):
    write_files(
        tmp_path, {"a/one/model.sdf": BOX, "b/one/model.sdf": BOX, "b/two/model.config": "<model/>", "b/x/y.txt": ""}
    )
    environment = {"GZ_SIM_RESOURCE_PATH": f"{tmp_path / 'a'}:{tmp_path / 'b'}"}
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), environment)
    models_found = finder.models()
    assert (models_found["one"], models_found["two"]) == (tmp_path / "a" / "one", tmp_path / "b" / "two")
    assert {"ground_plane", "sun"} <= set(models_found)
    assert "x" not in models_found


def test_invalid_uri_is_missing(tmp_path):
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {"HOME": str(tmp_path)})
    for address in ("model://", "package://nowhere/a", "https://example.org/a", "ftp://a/b", "a.sdf", "/no/a.sdf", ""):
        file = finder.file(address, tmp_path)
        assert isinstance(file, Missing) or file == tmp_path, address
    assert isinstance(finder.model("", Path(tmp_path)), Missing)


def test_unknown_elements_and_missing_models_are_reported_once(tmp_path):
    missing_include = "<include><uri>model://gone</uri></include>"
    box_model = sdf_text('<model name="box"><static>true</static><mine/></model>')
    write_files(tmp_path, {"box/model.sdf": box_model})
    box = "<include><uri>model://box</uri></include>"
    elements = f'<mine/><mine/><yours/>{missing_include * 2}{box}<model name="m"><static>1</static><mine/></model>'
    world_reading = examine_world_in(tmp_path, elements, GZ_SIM_RESOURCE_PATH=str(tmp_path))
    texts = [
        str(diagnostic.message) for diagnostic in world_reading.diagnostics if diagnostic.code in ("SDF150", "SDF160")
    ]
    assert [text.split(":")[0] for text in texts] == [
        "<mine> in <world> is not read",
        "<yours> in <world> is not read",
        "<mine> in <model> is not read",
        "'model",
    ]


def test_worlds_are_found_by_path_uri_and_name(tmp_path):
    path = tmp_path / "some.world"
    path.write_text("<sdf version='1.6'><world name='w'/></sdf>")
    finder = ResourceFinder(PackageFinder(start=tmp_path, environment={}), {"GZ_SIM_RESOURCE_PATH": str(tmp_path)})
    for name in (str(path), f"file://{path}", "some.world", "some"):
        assert finder.world(name) == path
    assert finder.world("none") is None
    assert finder.world("some/some") is None
