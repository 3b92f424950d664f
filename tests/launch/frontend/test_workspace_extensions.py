"""Tags from packages in the workspace that are not on Python's path."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from launch import LaunchContext
from launch.frontend import Parser
from linkwright.diagnostics import LinkwrightError
from linkwright.launch.model.markup.expose import action_parse_methods, substitution_parse_methods
from linkwright.packages import PackageFinder, use_finder

MANIFEST = """<package format="3"><name>{}</name><version>0.0.1</version><description>d</description>
<maintainer email="a@b.c">a</maintainer><license>MIT</license><export><build_type>ament_python</build_type></export>
</package>"""
MODULE = """
from launch import Action, SomeSubstitutionsType, Substitution
from launch.frontend import expose_action, expose_substitution

@expose_action("{name}")
class Wave(Action):
    @classmethod
    def parse(cls, entity, parser):
        _, kwargs = super().parse(entity, parser)
        cls.hands = entity.get_attr("hands", data_type=int)
        return cls, kwargs

@expose_substitution("{name}-text")
class Text(Substitution):
    @classmethod
    def parse(cls, data):
        return cls, {{}}

    def perform(self, context):
        return "waved"
"""
IN_SETUP = {
    "setup.py": """
from setuptools import setup
setup(name="{0}", packages=["{0}"], entry_points={{
    "console_scripts": [], "launch.frontend.launch_extension": ["{0} = {0}.tags"]}})
""",
    "setup.cfg": """
[options.entry_points]
launch.frontend.launch_extension =
    {0} = {0}.tags
""",
    "pyproject.toml": """
[project.entry-points."launch.frontend.launch_extension"]
{0} = "{0}.tags"
""",
}


@pytest.fixture(autouse=True)
def _restored_tables() -> Iterator[None]:
    before = [(table, dict(table)) for table in (action_parse_methods, substitution_parse_methods)]
    modules = set(sys.modules)
    yield
    for table, entries in before:
        table.clear()
        table.update(entries)
    for name in set(sys.modules) - modules:
        if name.startswith("waving"):
            del sys.modules[name]


def read_launch(text: str, folder: Path, **environment: str) -> list[object]:
    with use_finder(PackageFinder(start=folder, environment=environment)):
        root, parser = Parser.load(io.StringIO(text))
        return list(parser.parse_description(root).entities)


@pytest.mark.parametrize("file", IN_SETUP)
def test_tag_of_source_package_is_found(tmp_path: Path, write: Callable[[str, str], Path], file: str) -> None:
    name = f"waving_{file.partition('.')[2]}"
    write(f"src/{name}/package.xml", MANIFEST.format(name))
    write(f"src/{name}/{file}", IN_SETUP[file].format(name))
    write(f"src/{name}/{name}/__init__.py", "")
    write(f"src/{name}/{name}/tags.py", MODULE.format(name=f"wave_{name}"))
    action, log = read_launch(
        f'<launch><wave_{name} hands="2"/><log_info message="$(wave_{name}-text)"/></launch>', tmp_path
    )
    assert (type(action).__name__, action.hands) == ("Wave", 2)
    assert [part.perform(LaunchContext()) for part in log.msg] == ["waved"]


def test_tag_of_built_package_outside_python_path_is_found(tmp_path: Path, write: Callable[[str, str], Path]) -> None:
    name, site = "waving_built", "install/waving_built/lib/python3.11/site-packages"
    write(f"install/{name}/share/{name}/package.xml", MANIFEST.format(name))
    write(f"install/{name}/share/ament_index/resource_index/packages/{name}", "")
    write(
        f"{site}/{name}-0.0.1-py3.11.egg-info/entry_points.txt",
        f"[launch.frontend.launch_extension]\n{name} = {name}\n",
    )
    write(f"{site}/{name}/__init__.py", MODULE.format(name="wave_built"))
    prefix = str(tmp_path / "install" / name)
    (action,) = read_launch('<launch><wave_built hands="1"/></launch>', tmp_path, AMENT_PREFIX_PATH=prefix)
    assert action.hands == 1


def test_failing_extension_module_is_reported_and_tag_stays_unknown(
    tmp_path: Path, write: Callable[[str, str], Path]
) -> None:
    name = "waving_wrong"
    write(f"src/{name}/package.xml", MANIFEST.format(name))
    write(f"src/{name}/setup.py", IN_SETUP["setup.py"].format(name))
    write(f"src/{name}/{name}/__init__.py", "")
    write(f"src/{name}/{name}/tags.py", "1 / 0")
    with (
        pytest.warns(UserWarning, match="Failed to load the launch extension: waving_wrong.tags"),
        pytest.raises(LinkwrightError, match="no action has the tag 'wave_wrong'"),
    ):
        read_launch('<launch><wave_wrong hands="1"/></launch>', tmp_path)
