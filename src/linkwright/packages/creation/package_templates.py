"""The contents of the files of a new package, for Python packages and for all build types."""

from __future__ import annotations

from html import escape

from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.packages.creation.request import PackageRequest

INITIAL_VERSION = "0.0.0"
LINTERS = ("copyright", "flake8", "pep257")

_SCHEMA = "http://download.ros.org/schema/package_format{format}.xsd"
_LINTER_BODIES = {
    "copyright": """\
from ament_copyright.main import main
import pytest


# Remove the skip once every source file names its copyright holder and license.
@pytest.mark.skip(reason='The generated files have no copyright header yet.')
@pytest.mark.copyright
@pytest.mark.linter
def test_copyright():
    assert main(argv=['.', 'test']) == 0, 'Files without a copyright header or license'
""",
    "flake8": """\
from ament_flake8.main import main_with_errors
import pytest


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8():
    status, errors = main_with_errors(argv=[])
    assert status == 0, '\\n'.join([f'{len(errors)} findings about code style:', *errors])
""",
    "pep257": """\
from ament_pep257.main import main
import pytest


@pytest.mark.pep257
@pytest.mark.linter
def test_pep257():
    assert main(argv=['.', 'test']) == 0, 'Docstrings that do not follow PEP 257'
""",
}


def manifest(request: PackageRequest) -> str:
    """Return the text of ``package.xml``."""
    schema = _SCHEMA.format(format=request.package_format)
    maintainer = request.maintainer
    lines = [
        '<?xml version="1.0"?>',
        f'<?xml-model href="{schema}" schematypens="http://www.w3.org/2001/XMLSchema"?>',
        f'<package format="{request.package_format}">',
        f"  <name>{request.name}</name>",
        f"  <version>{INITIAL_VERSION}</version>",
        f"  <description>{_escape(request.description)}</description>",
        f'  <maintainer email="{escape(maintainer.email)}">{_escape(maintainer.name)}</maintainer>',
        f"  <license>{_escape(request.license)}</license>",
        "",
    ]
    for tag, names in (
        ("buildtool_depend", _list_build_tools(request)),
        ("depend", request.dependencies),
        ("test_depend", _list_test_dependencies(request)),
    ):
        if names:
            lines += [*(f"  <{tag}>{name}</{tag}>" for name in names), ""]
    lines += [
        "  <export>",
        f"    <build_type>{request.build_type}</build_type>",
        "  </export>",
        "</package>",
    ]
    return "\n".join(lines) + "\n"


def setup_py(request: PackageRequest) -> str:
    """Return the text of ``setup.py``."""
    scripts = f"            '{request.node} = {request.name}.{request.node}:main',\n" if request.node else ""
    return f"""\
from setuptools import find_packages, setup

package_name = {request.name!r}

setup(
    name=package_name,
    version={INITIAL_VERSION!r},
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={request.maintainer.name!r},
    maintainer_email={request.maintainer.email!r},
    description={request.description!r},
    license={request.license!r},
    extras_require={{'test': ['pytest']}},
    entry_points={{
        'console_scripts': [
{scripts}        ],
    }},
)
"""


def setup_cfg(request: PackageRequest) -> str:
    """Return ``setup.cfg``, which installs executables where ``ros2 run`` searches for them."""
    scripts = f"$base/lib/{request.name}"
    return f"[develop]\nscript_dir={scripts}\n[install]\ninstall_scripts={scripts}\n"


def linter_test(linter: str) -> str:
    """Return the source of a test that runs one of ament's linters on the package."""
    return _LINTER_BODIES[linter]


def node_py(request: PackageRequest) -> str:
    """Return the source of the executable's module."""
    return f"""\
def main():
    print('Hello from {request.name}.')


if __name__ == '__main__':
    main()
"""


def _escape(value: str) -> str:
    return escape(value, quote=False)


def _list_build_tools(request: PackageRequest) -> tuple[str, ...]:
    if request.build_type != "ament_cmake":
        return ()
    # ament_cmake_ros builds libraries as shared libraries unless the user overrides this.
    return ("ament_cmake_ros",) if request.library_name else ("ament_cmake",)


def _list_test_dependencies(request: PackageRequest) -> tuple[str, ...]:
    if request.build_type == "ament_cmake":
        return ("ament_lint_auto", "ament_lint_common")
    if request.build_type == "ament_python":
        return (*(f"ament_{linter}" for linter in LINTERS), "python3-pytest")
    return ()
