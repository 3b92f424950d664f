"""Find plugins of packages that a parameter file needs for the first time and that no ``package.xml`` names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from linkwright.diagnostics import Phrase, phrase
from linkwright.lint.dependencies import is_covered
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.review.files.yaml_values import YamlValue
from linkwright.review.versions import Version, Versions
from linkwright.xacro.cache import read_document

_CLASS = re.compile(r"(?P<package>[a-z][a-z0-9]*(?:_[a-z0-9]+)+)(?:/|::)(?:\w+::)*[A-Z]\w*")
"""The class of a plugin, such as ``nav2_smac_planner/SmacPlanner2D``.

The namespace of a class without an underscore is often not the package.
"""
_CLASS_PARAMETER = re.compile(r"(^|[._])(plugin|type|kinematics_solver|planning_plugin|base_\w+_planner)$")
_PLUGIN = re.compile(r"(^|[._])plugin$")
_OTHER_NAMES = frozenset(
    {
        *("cached_ik_kinematics_plugin", "chomp_interface", "default_planner_request_adapters", "fake_components"),
        *("kdl_kinematics_plugin", "lma_kinematics_plugin", "mock_components", "occupancy_map_monitor"),
        *("ompl_interface", "srv_kinematics_plugin"),
    }
)
"""The first names of classes that belong to packages with other names."""
_SUFFIXES = (".yaml", ".yml", ".launch", ".xml", ".xacro", ".py", ".cpp", ".hpp", ".h", ".repos", ".rosinstall")


@dataclass(frozen=True)
class PluginPackages:
    """The packages of the plugins that a parameter file loads.

    Attributes:
        versions: the repository before and after the change.
        path: the path of the parameter file in the new version.
    """

    versions: Versions
    path: str

    def find_change_reason(self, parameter: str, old: YamlValue, new: YamlValue) -> Phrase | None:
        """Return the reason why another class of a plugin is breaking, or None if it is not."""
        package = _find_package(parameter, new)
        if package is None or package in (_find_package(parameter, old), *_split(old.text)):
            return None
        return self._find_reason(package)

    def find_addition_reason(self, values: Mapping[str, YamlValue]) -> Phrase | None:
        """Return the reason why added values are breaking, or None if they are not.

        An added controller, which has a type, may not be started.
        """
        plugins = {name: value for name, value in values.items() if _PLUGIN.search(name)}
        packages = dict.fromkeys(_find_package(name, value) for name, value in plugins.items())
        reasons = (self._find_reason(package) for package in packages if package is not None)
        return next((reason for reason in reasons if reason is not None), None)

    def _find_reason(self, package: str) -> Phrase | None:
        """Return the reason why a package is missing, or None if it is not certainly missing."""
        if self._is_declared(package) or self._is_named_before(package):
            return None
        return phrase("package.xml does not name '{name}', without which the plugin is not loaded", name=package)

    def _is_declared(self, package: str) -> bool:
        """Return whether a package of the new version is the package, or depends on it."""
        version = self.versions.new
        manifests = [_read_manifest(version, path) for path in version.paths((MANIFEST,))]
        if package in version.shares or not manifests or version.package_of(self.path) is None:
            return True
        return any(
            "$" in "".join(dependency.name for dependency in manifest.dependencies)
            or is_covered(package, manifest, version.finder(version.root))
            for manifest in manifests
        )

    def _is_named_before(self, package: str) -> bool:
        """Return whether a file of the old version already names the package."""
        word = re.compile(rf"(?<![\w]){re.escape(package)}(?![\w])")
        old = self.versions.old
        return any(word.search(old.text(path)) for path in old.paths(_SUFFIXES))


def _find_package(parameter: str, value: YamlValue) -> str | None:
    """Return the package of the plugin that a value names; None for other values."""
    match = _CLASS.fullmatch(value.text) if _CLASS_PARAMETER.search(parameter) else None
    return None if match is None or match["package"] in _OTHER_NAMES else match["package"]


def _split(text: str) -> list[str]:
    return re.split(r"/|::", text)


def _read_manifest(version: Version, path: str) -> Manifest:
    return Manifest(read_document(str(version.file(path))))
