"""Define the kinds of reviewed files: their names, their comparisons, and whether removing them is breaking."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path, PurePosixPath

from linkwright.diagnostics import Phrase, phrase
from linkwright.packages.launch_files import is_launch_file_name
from linkwright.packages.manifest import MANIFEST
from linkwright.review.changes import SubjectKind
from linkwright.review.file_pair import FilePair
from linkwright.review.files.arms.semantics import compare_semantics, semantic_contents
from linkwright.review.files.behavior_tree_files import is_tree_file
from linkwright.review.files.behavior_trees import compare_behavior_trees, tree_contents
from linkwright.review.files.build.cmake_files import CMAKE_FILE, compare_cmake_files, read_cmake_facts
from linkwright.review.files.build.contents import build_contents
from linkwright.review.files.build.dependency_lists import (
    REPOSITORY_SUFFIXES,
    REQUIREMENTS,
    compare_repositories,
    compare_requirements,
    repository_contents,
    requirement_contents,
)
from linkwright.review.files.build.facts import BuildFacts
from linkwright.review.files.build.manifests import compare_manifests, manifest_contents
from linkwright.review.files.build.python_settings import (
    PYPROJECT,
    SETUP_CFG,
    compare_pyproject_files,
    compare_setup_cfg_files,
    read_pyproject,
    read_setup_cfg,
)
from linkwright.review.files.build.setup_files import SETUP_FILE, compare_setup_files, read_setup_facts
from linkwright.review.files.gui_files import compare_gui_files, gui_contents, is_gui_file
from linkwright.review.files.interfaces import compare_interfaces, interface_contents
from linkwright.review.files.maps import compare_map_files, compare_maps, map_contents
from linkwright.review.files.meshes import compare_meshes, mesh_contents
from linkwright.review.files.mujoco_files import compare_mujoco_files, is_mujoco_file, mujoco_contents
from linkwright.review.files.parameters.comparing import parameter_contents
from linkwright.review.files.parameters.configurations import YAML_SUFFIXES
from linkwright.review.files.rviz_files import compare_rviz_files, rviz_contents
from linkwright.review.files.worlds.comparing import compare_worlds, is_model, world_contents
from linkwright.review.files.worlds.model_configurations import MODEL_CONFIGURATION, compare_model_configurations
from linkwright.review.files.worlds.templates import TEMPLATE_SUFFIXES
from linkwright.review.given_names import compare_parameters_with_sources
from linkwright.review.launches.contents import launch_contents, started_contents
from linkwright.review.launches.files import compare_launch_files, compare_launch_tests
from linkwright.review.launches.helper_modules import compare_launch_helpers, helper_contents
from linkwright.review.launches.spawned_models import find_spawned_models
from linkwright.review.robots.descriptions import compare_descriptions
from linkwright.review.robots.semantics import SUFFIX, compare_expanded_semantics
from linkwright.review.robots.unpaired_robots import description_contents
from linkwright.review.versions import TEST_FOLDERS, Version


@dataclass(frozen=True)
class KindRule:
    """The rules for recognizing, comparing and reporting files of a kind.

    Attributes:
        kind: the kind of the files.
        compare: the function that compares two versions.
        suffixes: the endings of the names. An ending without a leading dot or underscore is a whole name.
        added: the sentence for an added file.
        removed: the sentence for a removed file.
        removal_reason: the reason why removing or renaming a file is breaking; None if it is not.
        contents: the function that returns the contents of an added or removed file in one line, or None if they are
            unknown.
        shows_removed: whether the line about a removed file contains its contents.
        needs_contents: whether an added or removed file without contents is not reported.
    """

    kind: SubjectKind
    compare: Callable[[FilePair], None]
    suffixes: tuple[str, ...]
    added: Phrase
    removed: Phrase
    removal_reason: Phrase | None = None
    contents: Callable[[Version, str], Phrase | None] | None = None
    shows_removed: bool = False
    needs_contents: bool = False


def _summarize_build_file(read: Callable[[Version, str], BuildFacts], version: Version, path: str) -> Phrase | None:
    """Return the contents of a build file in one line, or None if there are none."""
    return build_contents(read(version, path))


PARAMETERS = KindRule(
    SubjectKind.PARAMETERS,
    compare_parameters_with_sources,
    YAML_SUFFIXES,
    phrase("parameter file added"),
    phrase("parameter file removed"),
    phrase("launch files and users that name the file do not find it"),
    contents=parameter_contents,
    shows_removed=True,
)
SEMANTIC_XACRO = KindRule(
    SubjectKind.SEMANTICS,
    compare_expanded_semantics,
    (SUFFIX,),
    phrase("semantic description added"),
    phrase("semantic description removed"),
    phrase("launch files and programs that name the file do not find it"),
)
_RULES = (
    SEMANTIC_XACRO,
    KindRule(
        SubjectKind.DESCRIPTION,
        compare_descriptions,
        (".urdf", ".xacro"),
        phrase("description added"),
        phrase("description removed"),
        phrase("launch files and descriptions that name the file do not find it"),
        contents=description_contents,
    ),
    KindRule(
        SubjectKind.WORLD,
        partial(compare_worlds, find_spawned_models=find_spawned_models),
        (".sdf", ".world"),
        phrase("world added"),
        phrase("world removed"),
        phrase("launch files and users that name the file do not find it"),
        contents=world_contents,
        shows_removed=True,
    ),
    KindRule(
        SubjectKind.MODEL_CONFIGURATION,
        compare_model_configurations,
        (MODEL_CONFIGURATION,),
        phrase("model configuration added"),
        phrase("model configuration removed"),
        needs_contents=True,  # the model itself is reported
    ),
    KindRule(
        SubjectKind.TEMPLATE,
        partial(compare_worlds, find_spawned_models=find_spawned_models),
        TEMPLATE_SUFFIXES,
        phrase("template of a model or world added"),
        phrase("template of a model or world removed"),
        phrase("build files and programs that name the file do not find it"),
        contents=world_contents,
        shows_removed=True,
    ),
    KindRule(
        SubjectKind.LAUNCH_FILE,
        compare_launch_files,
        (".launch.py", "_launch.py", ".launch.xml", ".launch"),
        phrase("launch file added"),
        phrase("launch file removed"),
        phrase("launch files and users that start the file do not find it"),
        started_contents,
        shows_removed=True,
    ),
    KindRule(
        SubjectKind.INTERFACE,
        compare_interfaces,
        (".msg", ".srv", ".action", ".idl"),
        phrase("interface added"),
        phrase("interface removed"),
        phrase("programs that use the type do not build or start"),
        contents=interface_contents,
        shows_removed=True,
    ),
    KindRule(
        SubjectKind.MANIFEST,
        compare_manifests,
        (MANIFEST,),
        phrase("package added"),
        phrase("package removed"),
        phrase("packages that depend on the package do not build or start"),
        contents=manifest_contents,
    ),
    *(
        KindRule(
            SubjectKind.BUILD,
            compare,
            (name.lower(),),
            phrase("build file added"),
            phrase("build file removed"),
            contents=partial(_summarize_build_file, read),
            shows_removed=True,
            needs_contents=name in (SETUP_CFG, PYPROJECT),
        )
        for name, compare, read in (
            (CMAKE_FILE, compare_cmake_files, read_cmake_facts),
            (SETUP_FILE, compare_setup_files, read_setup_facts),
            (SETUP_CFG, compare_setup_cfg_files, read_setup_cfg),
            (PYPROJECT, compare_pyproject_files, read_pyproject),
        )
    ),
    KindRule(
        SubjectKind.SEMANTICS,
        compare_semantics,
        (".srdf",),
        phrase("semantic description added"),
        phrase("semantic description removed"),
        phrase("launch files and programs that name the file do not find it"),
        contents=semantic_contents,
    ),
    KindRule(
        SubjectKind.RVIZ,
        compare_rviz_files,
        (".rviz",),
        phrase("RViz configuration added"),
        phrase("RViz configuration removed"),
        phrase("launch files and users that name the file do not find it"),
        contents=rviz_contents,
    ),
    KindRule(
        SubjectKind.MAP,
        compare_maps,  # images that no YAML file names
        (".pgm",),
        phrase("image of a map added"),
        phrase("image of a map removed"),
    ),
    PARAMETERS,
    KindRule(
        SubjectKind.DEPENDENCIES,
        compare_repositories,
        REPOSITORY_SUFFIXES,
        phrase("list of repositories added"),
        phrase("list of repositories removed"),
        contents=repository_contents,
    ),
    KindRule(
        SubjectKind.MESH,
        compare_meshes,
        (".stl", ".dae", ".obj", ".glb", ".gltf"),
        phrase("mesh added"),
        phrase("mesh removed"),
        phrase("descriptions that name the file do not find it"),
        contents=mesh_contents,
    ),
)


_REQUIREMENTS = KindRule(
    SubjectKind.DEPENDENCIES,
    compare_requirements,
    (),
    phrase("list of Python packages added"),
    phrase("list of Python packages removed"),
    contents=requirement_contents,
)


def adapt_rule_to_contents(rule: KindRule, version: Version, path: str) -> KindRule:
    """Return the rule for an added or removed file.

    For an SDF file without a world, the rule has the sentences for a model.

    Args:
        rule: the rule for the name of the file.
        version: the version that contains the file.
        path: the path relative to the root of the repository.
    """
    if rule.kind is not SubjectKind.WORLD or not is_model(version, path):
        return rule
    return replace(rule, added=phrase("model added"), removed=phrase("model removed"))


LAUNCH_HELPER = KindRule(
    SubjectKind.LAUNCH_FILE,
    compare_launch_helpers,
    (".py",),
    phrase("functions for launch files added"),
    phrase("functions for launch files removed"),
    phrase("launch files that import the module do not find it"),
    contents=helper_contents,
)
"""The rule for Python modules that make actions for launch files."""


_GUI = KindRule(
    SubjectKind.GUI,
    compare_gui_files,
    (".config",),
    phrase("configuration of Gazebo's window added"),
    phrase("configuration of Gazebo's window removed"),
    phrase("launch files and worlds that name the file do not find it"),
    contents=gui_contents,
)
"""The rule for configurations of Gazebo's window."""


_MUJOCO = KindRule(
    SubjectKind.MUJOCO,
    compare_mujoco_files,
    (".xml",),
    phrase("robot or world of MuJoCo added"),
    phrase("robot or world of MuJoCo removed"),
    phrase("launch files and programs that name the file do not find it"),
    contents=mujoco_contents,
)
"""The rule for robots and worlds of MuJoCo."""


_BEHAVIOR_TREE = KindRule(
    SubjectKind.BEHAVIOR_TREE,
    compare_behavior_trees,
    (".xml",),
    phrase("behavior tree added"),
    phrase("behavior tree removed"),
    phrase("programs and parameter files that name the file do not find it"),
    contents=tree_contents,
    shows_removed=True,
)
"""The rule for XML files that contain behavior trees."""


_CONTENT_RULES = ((is_tree_file, _BEHAVIOR_TREE), (is_gui_file, _GUI), (is_mujoco_file, _MUJOCO))


def find_rule_by_contents(files: Sequence[Path]) -> KindRule | None:
    """Return the rule for a file whose name is not that of a kind, or None if such files are not compared.

    Args:
        files: the versions of the file that exist.
    """
    return next((rule for matches, rule in _CONTENT_RULES if any(map(matches, files))), None)


MAP = KindRule(
    SubjectKind.MAP,
    compare_map_files,
    YAML_SUFFIXES,
    phrase("map added"),
    phrase("map removed"),
    phrase("launch files and users that name the file do not find it"),
    contents=map_contents,
)
"""The rule for the YAML files of maps, with their images."""


LAUNCH_FILE = next(rule for rule in _RULES if rule.kind is SubjectKind.LAUNCH_FILE)
"""The rule for launch files, including XML files that other launch files include."""


LAUNCH_TEST = KindRule(
    SubjectKind.LAUNCH_FILE,
    compare_launch_tests,
    (".test",),
    phrase("test added"),
    phrase("test removed"),
    contents=launch_contents,
    shows_removed=True,
)
"""The rule for launch files that tests of ROS 1 run."""


def may_help_launch_files(path: str) -> bool:
    """Return whether a path can be a module with functions for launch files."""
    pure_path = PurePosixPath(path)
    return pure_path.suffix == ".py" and pure_path.name != "setup.py" and TEST_FOLDERS.isdisjoint(pure_path.parts)


def find_rule(path: str) -> KindRule | None:
    """Return the rule for a file, or None if such files are not compared.

    Args:
        path: the path relative to the root of the repository.
    """
    name = PurePosixPath(path).name.lower()
    is_test = name.startswith("test_") and name.endswith(".py")
    if is_test and not TEST_FOLDERS.isdisjoint(PurePosixPath(path).parts):
        return None  # a test with launch_testing
    if is_launch_file_name(name):
        return LAUNCH_FILE
    if REQUIREMENTS.fullmatch(name):
        return _REQUIREMENTS
    return next((rule for rule in _RULES if any(_matches_suffix(name, suffix) for suffix in rule.suffixes)), None)


def _matches_suffix(name: str, suffix: str) -> bool:
    return name.endswith(suffix) if suffix.startswith((".", "_")) else name == suffix


REPOSITORIES = next(rule for rule in _RULES if rule.suffixes == REPOSITORY_SUFFIXES)
"""The rule for lists of repositories, also in YAML files with other names."""
