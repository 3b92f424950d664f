"""The elements of ``package.xml``, formats 2 and 3 (REP 140, REP 149)."""

from __future__ import annotations

from linkwright.packages.readers.package_xml import DEPENDENCY_TAGS
from linkwright.schema import AttributeRule, ElementRule, ValueType

_TEXT = ValueType("text")
_PACKAGE = ValueType("name of a package")
_CONDITION = AttributeRule("condition", ValueType("condition"), "when it applies, such as $ROS_DISTRO == humble")
_VERSIONS = tuple(
    AttributeRule(f"version_{name}", ValueType("version"), meaning)
    for name, meaning in (
        ("gte", "the lowest version"),
        ("lt", "the exclusive upper bound of the version"),
        ("lte", "the highest version"),
        ("gt", "the exclusive lower bound of the version"),
        ("eq", "the only version"),
    )
)
_MEANINGS = {
    "depend": "a package that is needed to build, to use the build and to run",
    "exec_depend": "a package that is needed to run",
    "build_depend": "a package that is needed to build",
    "build_export_depend": "a package that is needed to build other packages against this one",
    "buildtool_depend": "a tool that builds the package, such as ament_cmake",
    "buildtool_export_depend": "a tool that is needed to build other packages against this one",
    "test_depend": "a package that only tests need",
    "doc_depend": "a package that only the documentation needs",
}
USED_DEPENDENCIES = frozenset(_MEANINGS)
"""The dependency tags of formats 2 and 3, which replace ``run_depend`` of format 1."""


def _value(
    tag: str, meaning: str, *attributes: AttributeRule, kind: ValueType = _TEXT, is_repeated: bool = False
) -> ElementRule:
    return ElementRule(tag, meaning, attributes, is_repeated=is_repeated, text=AttributeRule("text", kind, meaning))


_EXPORT = ElementRule(
    "export",
    "facts for build tools and other packages",
    (),
    (
        _value("build_type", "the build system", _CONDITION, kind=ValueType("build type")),
        _value("member_of_group", "a group that the package belongs to", is_repeated=True),
        ElementRule("architecture_independent", "marks a package that does not depend on the architecture"),
        _value("deprecated", "marks a package that should not be used, with the reason"),
        ElementRule("metapackage", "marks a package that only depends on others"),
        ElementRule(
            "gazebo_ros",
            "folders for Gazebo's search",
            (
                AttributeRule("gazebo_model_path", _TEXT, "the folder of models, such as ${prefix}/models"),
                AttributeRule("gazebo_media_path", _TEXT, "the folder of media, such as ${prefix}"),
                AttributeRule("plugin_path", _TEXT, "the folder of plugins, such as ${prefix}/lib"),
            ),
            is_repeated=True,
        ),
    ),
)
PACKAGE = ElementRule(
    "package",
    "a package of ROS",
    (AttributeRule("format", ValueType("2 or 3"), "the version of the format", required=True),),
    (
        _value("name", "the name of the package", kind=ValueType("name")),
        _value("version", "the version, such as 0.1.0", kind=ValueType("version")),
        _value("description", "a description of the package"),
        _value(
            "maintainer",
            "a person who maintains the package",
            AttributeRule("email", ValueType("address"), "the e-mail address", required=True),
            is_repeated=True,
        ),
        _value(
            "license",
            "a license, by its SPDX identifier",
            AttributeRule("file", ValueType("path"), "the file with the text of the license"),
            kind=ValueType("license"),
            is_repeated=True,
        ),
        _value(
            "author",
            "an author of the package",
            AttributeRule("email", ValueType("address"), "the e-mail address"),
            is_repeated=True,
        ),
        _value(
            "url",
            "a page about the package",
            AttributeRule(
                "type", ValueType("website, bugtracker or repository"), "the kind of the page", default="website"
            ),
            is_repeated=True,
        ),
        *(
            _value(tag, meaning, *_VERSIONS, _CONDITION, kind=_PACKAGE, is_repeated=True)
            for tag, meaning in _MEANINGS.items()
        ),
        _value("group_depend", "a group whose packages are all needed", _CONDITION, is_repeated=True),
        _value("member_of_group", "a group that the package belongs to", _CONDITION, is_repeated=True),
        _value(
            "conflict", "a package that cannot be installed with this one", *_VERSIONS, kind=_PACKAGE, is_repeated=True
        ),
        _value("replace", "a package that this one replaces", *_VERSIONS, kind=_PACKAGE, is_repeated=True),
        _EXPORT,
    ),
)
"""The rule of the root element of ``package.xml``."""

PACKAGE_NAME_TAGS = frozenset({*DEPENDENCY_TAGS, "conflict", "replace"})
"""The elements whose text is the name of a package."""
