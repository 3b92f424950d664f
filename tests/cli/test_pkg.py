"""``linkwright pkg create``.

The tests cover files, output, refusals, and packages for the real build tools.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import warnings
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from catkin_pkg.package import parse_package
from hypothesis import given
from hypothesis import strategies as st

from linkwright.cli import main
from linkwright.packages.creation import package_templates
from linkwright.packages.creation.licenses import license_text, list_known_licenses
from linkwright.packages.creation.request import BUILD_TYPES, Maintainer, PackageRequest
from linkwright.packages.naming import check_package_name, is_email
from tests.places import REPOSITORY
from tests.robots.workspaces import colcon_build, read_sourced_variable

ADA = ("--maintainer-name", "Ada", "--maintainer-email", "ada@example.org")


@pytest.fixture(autouse=True)
def _in_an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def list_files(package: str) -> list[str]:
    return sorted(str(path.relative_to(package)) for path in Path(package).rglob("*") if path.is_file())


def test_pkg_create_matches_tutorial(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["my_robot", "--build-type", "ament_python", "--dependencies", "urdf", "xacro", "--license", "MIT", *ADA]
    assert main(["pkg", "create", *words]) == 0
    assert list_files("my_robot") == [
        "LICENSE",
        "my_robot/__init__.py",
        "package.xml",
        "resource/my_robot",
        "setup.cfg",
        "setup.py",
        "test/test_copyright.py",
        "test/test_flake8.py",
        "test/test_pep257.py",
    ]
    output = capsys.readouterr()
    assert output.err == ""
    assert output.out.splitlines() == [
        "going to create a new package",
        "package name: my_robot",
        f"destination directory: {tmp_path.resolve()}",
        "package format: 3",
        "version: 0.0.0",
        "description: TODO: Package description",
        "maintainer: ['Ada <ada@example.org>']",
        "licenses: ['MIT']",
        "build type: ament_python",
        "dependencies: ['urdf', 'xacro']",
        "creating folder ./my_robot",
        "creating ./my_robot/package.xml",
        "creating source folder",
        "creating folder ./my_robot/my_robot",
        "creating ./my_robot/setup.py",
        "creating ./my_robot/setup.cfg",
        "creating folder ./my_robot/resource",
        "creating ./my_robot/resource/my_robot",
        "creating ./my_robot/my_robot/__init__.py",
        "creating folder ./my_robot/test",
        "creating ./my_robot/test/test_copyright.py",
        "creating ./my_robot/test/test_flake8.py",
        "creating ./my_robot/test/test_pep257.py",
    ]


def test_cmake_package_has_expected_files(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", "create", "arm", "--node-name", "mover", "--library-name", "chain", *ADA]) == 0
    assert list_files("arm") == [
        "CMakeLists.txt",
        "include/arm/chain.hpp",
        "include/arm/visibility_control.h",
        "package.xml",
        "src/chain.cpp",
        "src/mover.cpp",
    ]
    lines = capsys.readouterr().out.splitlines()
    assert lines[lines.index("dependencies: []") + 1 :] == [
        "node_name: mover",
        "library_name: chain",
        "creating folder ./arm",
        "creating ./arm/package.xml",
        "creating source and include folder",
        "creating folder ./arm/src",
        "creating folder ./arm/include/arm",
        "creating ./arm/CMakeLists.txt",
        "creating ./arm/src/mover.cpp",
        "creating ./arm/include/arm/chain.hpp",
        "creating ./arm/src/chain.cpp",
        "creating ./arm/include/arm/visibility_control.h",
    ]
    lists = Path("arm/CMakeLists.txt").read_text(encoding="utf-8")
    assert "find_package(ament_cmake_ros REQUIRED)" in lists
    assert lists.endswith("\nament_package()\n")


def test_empty_cmake_package_keeps_folders() -> None:
    assert main(["pkg", "create", "arm", "--build-type", "cmake", *ADA]) == 0
    assert list_files("arm") == ["CMakeLists.txt", "package.xml"]
    assert Path("arm/src").is_dir()
    assert Path("arm/include/arm").is_dir()


@pytest.mark.parametrize("build_type", BUILD_TYPES)
@pytest.mark.parametrize("package_format", ["2", "3"])
def test_manifest_is_valid_for_colcon(build_type: str, package_format: str) -> None:
    words = ["--build-type", build_type, "--package-format", package_format, "--dependencies", "urdf", "xacro", "urdf"]
    text = 'Arms & <legs> of "Ada"'
    assert main(["pkg", "create", "arm", *words, "--description", text, "--license", "MIT", *ADA]) == 0
    advice: list[str] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # catkin_pkg's own deprecations
        package = parse_package("arm")
        package.validate(warnings=advice)
    assert advice == []
    assert package.name == "arm"
    assert package.package_format == int(package_format)
    assert ET.parse("arm/package.xml").findtext("description") == text
    assert [str(person) for person in package.maintainers] == ["Ada <ada@example.org>"]
    assert list(package.licenses) == ["MIT"]
    assert [dependency.name for dependency in package.build_depends] == ["urdf", "xacro"]
    assert package.get_build_type() == build_type


def test_python_package_has_node_and_library() -> None:
    words = ["--build-type", "ament_python", "--node-name", "talker", "--library-name", "words", *ADA]
    assert main(["pkg", "create", "arm", *words]) == 0
    assert "'talker = arm.talker:main'" in Path("arm/setup.py").read_text(encoding="utf-8")
    assert Path("arm/arm/words/__init__.py").is_file()
    result = subprocess.run([sys.executable, "-m", "arm.talker"], cwd="arm", capture_output=True, text=True, check=True)
    assert result.stdout == "Hello from arm.\n"


def test_node_is_renamed_if_library_has_same_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", "create", "arm", "--node-name", "move", "--library-name", "move", *ADA]) == 0
    assert Path("arm/src/move_node.cpp").is_file()
    output = capsys.readouterr()
    assert "node_name: move_node" in output.out
    assert "PKG209" in output.err


def test_python_package_requires_pytest_for_tests() -> None:
    """Without pytest, `colcon test` runs the tests of unittest, and the package has none."""
    main(["pkg", "create", "arm", "--build-type", "ament_python", *ADA])
    call = ast.parse(Path("arm/setup.py").read_text(encoding="utf-8")).body[-1]
    assert isinstance(call, ast.Expr)
    assert isinstance(call.value, ast.Call)
    options = {keyword.arg: keyword.value for keyword in call.value.keywords}
    assert ast.literal_eval(options["extras_require"]) == {"test": ["pytest"]}


def test_quotes_in_description_survive_in_setup_py() -> None:
    text = """It's "quoted" \\ 机器人"""
    request = PackageRequest(name="arm", maintainer=Maintainer("O'Neil", "o@example.org"), year=2026, description=text)
    call = ast.parse(package_templates.setup_py(request)).body[-1]
    assert isinstance(call, ast.Expr)
    assert isinstance(call.value, ast.Call)
    values = {word.arg: word.value for word in call.value.keywords}
    assert ast.literal_eval(values["description"]) == text
    assert ast.literal_eval(values["maintainer"]) == "O'Neil"


def test_destination_directory_is_created(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", "create", "arm", "--destination-directory", "ws/src", "--license", "MIT", *ADA]) == 0
    assert Path("ws/src/arm/package.xml").is_file()
    assert "creating ./ws/src/arm/package.xml" in capsys.readouterr().out


@pytest.mark.parametrize("existing", ["folder", "file"])
def test_existing_folder_is_not_overwritten(existing: str, capsys: pytest.CaptureFixture[str]) -> None:
    place = Path("arm")
    place.mkdir() if existing == "folder" else place.write_text("mine", encoding="utf-8")
    assert main(["pkg", "create", "arm", "--license", "MIT", *ADA]) == 1
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.startswith(f"error[PKG207]: the {existing} './arm' already exists\n   = hint: remove it, or ")
    assert list(place.iterdir()) == [] if existing == "folder" else place.read_text(encoding="utf-8") == "mine"


def test_unwritable_destination_is_reported(capsys: pytest.CaptureFixture[str]) -> None:
    Path("notes").write_text("a file", encoding="utf-8")
    assert main(["pkg", "create", "arm", "--destination-directory", "notes", *ADA]) == 1
    assert "error[PKG208]: cannot create './notes/arm': Not a directory" in capsys.readouterr().err


def test_all_invalid_arguments_are_reported_together(capsys: pytest.CaptureFixture[str]) -> None:
    words = ["my-Robot", "--node-name", "2go", "--library-name", "class", "--dependencies", "urdf,xacro"]
    assert main(["pkg", "create", *words, "--maintainer-email", "ada@home"]) == 1
    errors = capsys.readouterr().err
    for line in (
        "error[PKG201]: 'my-Robot' cannot be the name of a package: it may contain only letters, digits and",
        "did you mean 'my_robot'?",
        "error[PKG203]: '2go' cannot be the name of a node: it must begin with a letter",
        "error[PKG203]: 'class' cannot be the name of a library: it is a Python keyword",
        "error[PKG204]: 'urdf,xacro' cannot be the name of a dependency",
        "error[PKG205]: 'ada@home' is not an e-mail address that colcon accepts",
    ):
        assert line in errors
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("my_robot", None),
        ("r2", None),
        ("My_robot", "PKG202"),
        ("my__robot", "PKG202"),
        ("r", "PKG202"),
        ("", "PKG201"),
        ("2robots", "PKG201"),
        ("my robot", "PKG201"),
        ("机器人", "PKG201"),
        ("../up", "PKG201"),
        ("import", "PKG201"),
    ],
)
def test_package_names_are_checked(name: str, code: str | None) -> None:
    assert [finding.code for finding in check_package_name(name)] == ([code] if code else [])


@given(st.text())
def test_accepted_name_is_an_identifier_and_plain_folder(name: str) -> None:
    if not any(finding.code == "PKG201" for finding in check_package_name(name)):
        assert name.isidentifier()
        assert name.isascii()
        assert Path(name).name == name


def test_python_package_cannot_be_named_test(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", "create", "test", "--build-type", "ament_python", *ADA]) == 1
    assert "error[PKG206]" in capsys.readouterr().err
    assert main(["pkg", "create", "test", "--build-type", "ament_cmake", *ADA]) == 0


@pytest.mark.parametrize("address", ["ada@example.org", "a.b+c@sub.example.museum", "lll@todo.todo"])
def test_email_addresses_accepted_by_colcon(address: str) -> None:
    assert is_email(address)


@pytest.mark.parametrize(
    "address", ["ada", "ada@home", "ada@home.x", "@example.org", "a b@example.org", "艾达@例子.中国"]
)
def test_email_addresses_rejected_by_colcon(address: str) -> None:
    assert not is_email(address)


def test_maintainer_comes_from_git(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    Path("gitconfig").write_text("[user]\n\tname = Grace\n\temail = grace@example.org\n", encoding="utf-8")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(Path("gitconfig").resolve()))
    assert main(["pkg", "create", "arm"]) == 0
    assert "maintainer: ['Grace <grace@example.org>']" in capsys.readouterr().out


@pytest.mark.parametrize("email", ["", "\temail = grace@laptop\n"], ids=["none", "one that colcon refuses"])
def test_maintainer_falls_back_to_login_with_invalid_git_email(
    email: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("gitconfig").write_text(f"[user]\n{email}", encoding="utf-8")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", str(Path("gitconfig").resolve()))
    monkeypatch.setenv("GIT_CONFIG_NOSYSTEM", "1")
    monkeypatch.setenv("LOGNAME", "DOMAIN\\grace")
    assert main(["pkg", "create", "arm"]) == 0
    assert r"maintainer: ['DOMAIN\\grace <DOMAIN-grace@todo.todo>']" in capsys.readouterr().out


def test_maintainer_falls_back_to_login_without_git(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(Path.cwd()))
    monkeypatch.setenv("LOGNAME", "grace")
    assert main(["pkg", "create", "arm"]) == 0
    assert "maintainer: ['grace <grace@todo.todo>']" in capsys.readouterr().out


def test_licenses_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", "create", "--license", "?"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "Supported licenses:"
    assert {"Apache-2.0", "BSD-3-Clause", "MIT"} <= set(lines[1:])
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize("identifier", list_known_licenses())
def test_license_texts_are_complete(identifier: str) -> None:
    text = license_text(identifier, year=2026, holder="Ada")
    assert text is not None
    assert "<year> <holder>" not in text
    if identifier.startswith(("MIT", "BSD")):
        assert "Copyright (c) 2026 Ada\n" in text
    if identifier.startswith("LGPL"):
        assert "GNU LESSER GENERAL PUBLIC LICENSE" in text
        assert "TERMS AND CONDITIONS" in text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([], "the package has no license yet, so no LICENSE is written"),
        (["--license", "mit"], "Linkwright has no text for the license 'mit'"),
        (["--license", "Proprietary"], "Linkwright has no text for the license 'Proprietary'"),
    ],
)
def test_license_without_text_causes_warning(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["pkg", "create", "arm", *words, *ADA]) == 0
    assert f"warning[PKG210]: {message}" in capsys.readouterr().err
    assert not Path("arm/LICENSE").exists()
    if words:
        assert f"<license>{words[1]}</license>" in Path("arm/package.xml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "words",
    [[], ["make"], ["create"], ["create", "arm", "--build-type", "meson"], ["create", "arm", "--package-format", "1"]],
)
def test_invalid_usage_is_rejected(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pkg", *words]) == 2
    assert capsys.readouterr().err.startswith("usage: linkwright pkg")
    assert list(Path().iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("options", [(), ("--symlink-install",)], ids=["copied", "symlinked"])
def test_colcon_builds_created_package(options: tuple[str, ...], tmp_path: Path) -> None:
    words = ["my_robot", "--build-type", "ament_python", "--dependencies", "urdf", "xacro", "--license", "MIT"]
    destination = ["--node-name", "hello", "--destination-directory", "src"]
    assert main(["pkg", "create", *words, *destination, *ADA]) == 0
    colcon_build(tmp_path, "my_robot", *options)
    prefix = tmp_path / "install" / "my_robot"
    assert read_sourced_variable(tmp_path, "AMENT_PREFIX_PATH") == str(prefix)
    assert (prefix / "share" / "my_robot" / "package.xml").is_file()
    assert (prefix / "lib" / "my_robot" / "hello").is_file()


def _read_setup_arguments(text: str) -> dict[str, str]:
    calls = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Call)]
    (call,) = [call for call in calls if ast.unparse(call.func) == "setup"]
    return {str(keyword.arg): ast.unparse(keyword.value) for keyword in call.keywords}


def test_bundled_packages_declare_tests_like_created_packages() -> None:
    request = PackageRequest(name="p", maintainer=Maintainer("Ada", "ada@example.org"), year=2026)
    expected = _read_setup_arguments(package_templates.setup_py(request))
    texts = {path: path.read_text(encoding="utf-8") for top in ("courses", "robots") for path in _find_setup_files(top)}
    for page in sorted((REPOSITORY / "docs").rglob("tutorial*.md")):
        blocks = re.findall(r"```python[^\n]*\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)
        texts.update({page / str(index): text for index, text in enumerate(blocks) if "\nsetup(\n" in text})
    assert len(texts) > 40
    for path, text in texts.items():
        arguments = _read_setup_arguments(text)
        assert "tests_require" not in arguments, path
        assert arguments["extras_require"] == expected["extras_require"], path


def _find_setup_files(top: str) -> list[Path]:
    return sorted((REPOSITORY / top).rglob("setup.py"))
