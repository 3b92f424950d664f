"""The versions that a range names, and shallow, hostile or incomplete repositories."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from linkwright.cli import main
from linkwright.diagnostics import LinkwrightError
from linkwright.review import open_versions
from tests.repositories import ARM, MACRO, Repository
from tests.review.conftest import breaking, sentences, subject

PATH = "arm_description/urdf/arm.urdf.xacro"


def arm_with_mass(kilograms: int) -> str:
    return MACRO.replace('mass value="2"', f'mass value="{kilograms}"')


def mass_sentences(result) -> list[str]:
    return [sentence for sentence in sentences(subject(result, PATH)) if "mass" in sentence]


def test_commit_ranges_are_resolved(package, compare):
    package.git("switch", "--quiet", "--create", "feature")
    package.commit({"arm_description/urdf/segment.xacro": arm_with_mass(3)})
    package.git("switch", "--quiet", "main")
    package.commit({PATH: ARM.replace('name="arm"', 'name="robot"')})
    package.git("switch", "--quiet", "feature")
    package.write({"arm_description/urdf/segment.xacro": arm_with_mass(4)})
    assert mass_sentences(compare(package, "main...feature")) == ["link 'upper': inertial mass 2 -> 3 kg"]
    assert "robot 'arm': name robot -> arm" in sentences(subject(compare(package, "main..feature"), PATH))
    assert mass_sentences(compare(package, "feature")) == ["link 'upper': inertial mass 3 -> 4 kg"]
    assert mass_sentences(compare(package, "")) == ["link 'upper': inertial mass 2 -> 4 kg"]
    assert mass_sentences(compare(package, "HEAD~1..")) == ["link 'upper': inertial mass 2 -> 3 kg"]


def test_package_of_a_file_is_its_nearest_folder_with_a_manifest(repository):
    manifest = "<package format='3'><name>a</name></package>"
    repository.commit({"package.xml": manifest, ".hidden/arm/package.xml": manifest, "old/manifest.xml": "<package/>"})
    versions = open_versions(repository.root, "HEAD")
    try:
        assert versions.new.package_of("launch/a.launch.py") == ""
        assert versions.new.package_of(".hidden/arm/urdf/a.urdf") == ".hidden/arm"
        assert versions.new.package_of("old/a.cpp") == ""
        assert versions.old.package_of("old/a.cpp", ("package.xml", "manifest.xml")) == "old"
    finally:
        versions.close()


def test_untracked_files_are_new(package, compare):
    package.write({"arm_description/urdf/b.urdf": "<robot name='b'><link name='b'/></robot>"})
    assert sentences(subject(compare(package), "arm_description/urdf/b.urdf")) == [
        "description added",
        "robot 'b': 1 link (b)",
    ]


def test_ignored_files_do_not_belong_to_the_checked_out_commit(package):
    package.commit({"arm_description/config/a.yaml": "rate: 1\n"})
    package.commit({".gitignore": "config/\n", "arm_description/config/a.yaml": None})
    package.write({"arm_description/config/a.yaml": "rate: 1\n"})
    versions = open_versions(package.root, "HEAD~1..HEAD")
    try:
        assert not versions.new.file("arm_description/config/a.yaml").exists()
    finally:
        versions.close()


def test_review_does_not_change_repository(package, compare):
    package.write({"arm_description/urdf/segment.xacro": arm_with_mass(3)})
    before = package.git("status", "--porcelain=v2", "--branch")
    compare(package, "main")
    assert package.git("status", "--porcelain=v2", "--branch") == before


def test_review_can_be_limited_to_packages(package, compare):
    other = {
        "b/package.xml": "<package format='3'><name>b</name></package>",
        "b/b.urdf": "<robot name='b'><link name='l'/></robot>",
    }
    package.commit(other)
    package.write(
        {"arm_description/urdf/segment.xacro": arm_with_mass(3), "b/b.urdf": "<robot name='b'><link name='m'/></robot>"}
    )
    assert [item.path for item in compare(package, "HEAD", ("b",)).subjects] == ["b/b.urdf"]
    assert [item.path for item in compare(package, "HEAD", ("arm_description/",)).subjects] == [PATH]
    with pytest.raises(LinkwrightError, match="neither version has a package 'c'"):
        compare(package, "HEAD", ("c",))


@pytest.mark.parametrize(("range_text", "code"), [("nowhere..HEAD", "CLI343"), ("--output=x..HEAD", "CLI343")])
def test_missing_commits_are_errors(package, range_text, code):
    with pytest.raises(LinkwrightError) as error:
        open_versions(package.root, range_text)
    assert error.value.diagnostics[0].code == code


def test_shallow_clone_error_hints_at_fetching_base(package, tmp_path):
    base = package.git("rev-parse", "HEAD")
    package.commit({"arm_description/urdf/segment.xacro": arm_with_mass(3)})
    clone = tmp_path / "clone"
    subprocess.run(["git", "clone", "--quiet", "--depth=1", package.root.as_uri(), clone], check=True)
    with pytest.raises(LinkwrightError) as error:
        open_versions(clone, f"{base}..HEAD")
    assert "git fetch --unshallow" in error.value.diagnostics[0].hint


def test_versions_without_common_commit_are_an_error(package):
    package.git("switch", "--quiet", "--orphan", "island")
    package.commit({"b.urdf": "<robot name='b'/>"})
    with pytest.raises(LinkwrightError) as error:
        open_versions(package.root, "main...island")
    assert error.value.diagnostics[0].code == "REV102"


def test_missing_default_branch_is_an_error(tmp_path):
    repository = Repository(tmp_path / "r")
    repository.git("switch", "--quiet", "--create", "trunk")
    repository.commit({"b.urdf": "<robot name='b'/>"})
    with pytest.raises(LinkwrightError) as error:
        open_versions(repository.root, "")
    assert error.value.diagnostics[0].code == "REV101"


def test_folder_outside_repository_is_an_error(tmp_path):
    with pytest.raises(LinkwrightError) as error:
        open_versions(tmp_path, "HEAD")
    assert error.value.diagnostics[0].code == "CLI342"


@pytest.mark.skipif(os.name == "nt", reason="symbolic links of POSIX")
@pytest.mark.parametrize("is_checked_out", [True, False])
@pytest.mark.parametrize("target", ["{outside}/secret.xacro", "../../.git/secret.xacro"])
def test_symlinks_out_of_repository_are_not_followed(package, compare, tmp_path, target, is_checked_out):
    for folder in (tmp_path, package.root / ".git"):
        (folder / "secret.xacro").write_text(MACRO.replace('value="2"', 'value="7.0625"'))
    path = package.root / "arm_description/urdf/segment.xacro"
    path.unlink()
    path.symlink_to(target.format(outside=tmp_path))
    package.commit({})
    if not is_checked_out:
        package.git("switch", "--quiet", "--detach", "HEAD~1")
    result = compare(package, "main~1..main")
    assert "7.0625" not in str(result)
    assert [str(note) for note in result.notes] == [
        "symbolic link 'arm_description/urdf/segment.xacro' points outside the repository and is ignored"
    ]


@pytest.mark.skipif(os.name == "nt", reason="symbolic links of POSIX")
def test_symlink_loops_do_not_stop_review(package, compare):
    (package.root / "arm_description/urdf/a.xacro").symlink_to("b.xacro")
    (package.root / "arm_description/urdf/b.xacro").symlink_to("a.xacro")
    package.commit({"arm_description/urdf/segment.xacro": arm_with_mass(3)})
    assert mass_sentences(compare(package, "HEAD~1..HEAD")) == ["link 'upper': inertial mass 2 -> 3 kg"]


@pytest.mark.skipif(sys.platform != "linux", reason="file names of any bytes")
def test_files_whose_names_are_not_utf8_are_reviewed(package, compare, tmp_path):
    name = os.fsdecode(b"arm_description/urdf/gr\xfcn.urdf")
    package.commit({name: "<robot name='g'><link name='a'/></robot>"})
    package.commit({name: "<robot name='h'><link name='a'/></robot>"})
    assert sentences(subject(compare(package, "HEAD~1..HEAD"), name)) == ["robot 'h': name g -> h"]
    reports = {name: tmp_path / f"report.{name}" for name in ("markdown", "html", "json", "sarif")}
    options = [f"--{name}={path}" for name, path in reports.items()]
    assert main(["review", "--repository", str(package.root), "HEAD~1..HEAD", *options]) == 0
    assert json.loads(reports["json"].read_text("utf-8"))["subjects"][0]["path"] == name
    assert "gr\\udcfcn.urdf" in reports["markdown"].read_text("utf-8")
    assert "gr\\udcfcn.urdf" in reports["html"].read_text("utf-8")


def test_names_that_are_not_utf8_can_be_printed(package):
    environment = {**os.environ, "PYTHONUTF8": "1", "PYTHONIOENCODING": ""}
    program = (
        "import sys; from linkwright.process.standard_streams import accept_any_text; "
        "sys.stdout.reconfigure(errors='strict'); accept_any_text(); print('gr\\udcfcn')"
    )
    result = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, check=True)
    assert result.stdout.strip() == b"gr\\udcfcn"


@pytest.mark.skipif(sys.platform != "linux", reason="file names of any bytes")
def test_links_whose_names_are_not_utf8_are_not_followed(package, compare, tmp_path):
    (tmp_path / "secret.xacro").write_text(MACRO.replace('value="2"', 'value="7.0625"'))
    name = os.fsdecode(b"arm_description/urdf/s\xffgment.xacro")
    (package.root / name).symlink_to(tmp_path / "secret.xacro")
    text = ARM.replace("urdf/segment.xacro", "urdf/$(arg kind)gment.xacro").replace(
        "<xacro:include", '<xacro:arg name="kind" default="s"/><xacro:include', 1
    )
    package.commit({PATH: text})
    package.git("switch", "--quiet", "--detach", "HEAD~1")
    result = compare(package, "main~1..main")
    assert "7.0625" not in str(result)
    assert [str(note) for note in result.notes] == [
        f"symbolic link '{name}' points outside the repository and is ignored"
    ]


@pytest.mark.skipif(os.name == "nt", reason="symbolic links of POSIX")
def test_symlinks_out_of_repository_are_one_note(package, compare, tmp_path):
    for number in range(3):
        (package.root / f"arm_description/urdf/link_{number}.xacro").symlink_to(tmp_path / "other.xacro")
    package.commit({})
    package.git("switch", "--quiet", "--detach", "HEAD~1")
    assert [str(note) for note in compare(package, "main~1..main").notes] == [
        "3 symbolic links, such as 'arm_description/urdf/link_0.xacro', point outside the repository and are ignored"
    ]


def test_submodule_change_is_a_note(package, compare, tmp_path):
    other = Repository(tmp_path / "other")
    other.commit({"a.urdf": "<robot name='a'><link name='a'/></robot>"})
    package.git("submodule", "--quiet", "add", other.root.as_uri(), "vendor")
    package.commit({})
    result = compare(package, "HEAD~1..HEAD")
    assert [str(note) for note in result.notes] == ["submodule 'vendor' added; its files are not compared"]
    old = other.git("rev-parse", "HEAD").strip()
    other.commit({"b.urdf": "<robot name='b'><link name='b'/></robot>"})
    new = other.git("rev-parse", "HEAD").strip()
    package.git("-C", "vendor", "pull", "--quiet")
    (note,) = compare(package).notes
    assert str(note) == "submodule 'vendor' changed; its files are not compared"  # git does not tell the new commit
    package.commit({})
    (note,) = compare(package, "HEAD~1..HEAD").notes
    assert str(note) == f"submodule 'vendor' changed: {old[:7]} -> {new[:7]}; its files are not compared"
    package.git("rm", "--quiet", "vendor")
    package.commit({})
    result = compare(package, "HEAD~1..HEAD")
    assert breaking(result) == ["submodule removed"]
    assert result.notes == []


def test_submodules_without_a_readable_gitmodules_file_are_compared(package, compare, tmp_path):
    """Such a file is a pointer of Git LFS, for example."""
    other = Repository(tmp_path / "other")
    other.commit({"a.urdf": "<robot name='a'><link name='a'/></robot>"})
    package.git("submodule", "--quiet", "add", other.root.as_uri(), "vendor")
    package.commit({})
    package.write({".gitmodules": "version 1\n", "arm_description/urdf/segment.xacro": arm_with_mass(3)})
    package.git("commit", "--quiet", "--all", "--message", "not well-formed")
    result = compare(package, "HEAD~1..HEAD")
    assert mass_sentences(result) == ["link 'upper': inertial mass 2 -> 3 kg"]


@pytest.mark.parametrize("is_used", [False, True])
def test_removed_submodule_that_nothing_uses_breaks_nobody(package, compare, tmp_path, is_used):
    other = Repository(tmp_path / "other")
    other.commit({"a.urdf": "<robot name='a'><link name='a'/></robot>"})
    package.git("submodule", "--quiet", "add", other.root.as_uri(), "vendor")
    manifest = (package.root / "arm_description/package.xml").read_text(encoding="utf-8")
    depend = "  <exec_depend>vendor</exec_depend>\n</package>"
    package.commit({"arm_description/package.xml": manifest.replace("</package>", depend)})
    package.git("rm", "--quiet", "vendor")
    uses = {"arm_description/scripts/load.py": "import vendor\n"} if is_used else {}
    package.commit({"arm_description/package.xml": manifest, **uses})
    result = compare(package, "HEAD~1..HEAD")
    assert ("submodule removed" in breaking(result)) == is_used
    assert "submodule removed" in sentences(subject(result, "vendor"))


def test_removed_submodule_without_an_entry_in_gitmodules_breaks_nobody(package, compare):
    """No clone of the repository has its files."""
    commit = package.git("rev-parse", "HEAD").strip()
    package.git("update-index", "--add", "--cacheinfo", f"160000,{commit},vendor")
    package.git("commit", "--quiet", "--message", "gitlink")
    package.git("rm", "--quiet", "--cached", "vendor")
    package.git("commit", "--quiet", "--message", "no gitlink")
    result = compare(package, "HEAD~1..HEAD")
    assert breaking(result) == []
    assert sentences(subject(result, "vendor")) == ["submodule without an entry in .gitmodules removed"]


@pytest.mark.parametrize("name", ["arm_description", "arm"])
def test_submodule_that_files_replace_is_not_removed(package, compare, tmp_path, name):
    """A package that is renamed at the same time has the files in its new folder."""
    other = Repository(tmp_path / "other")
    other.commit({"tof.h": "#pragma once\n"})
    package.git("submodule", "--quiet", "add", other.root.as_uri(), "arm_description/src/sensor")
    package.commit({"arm_description/src/driver.cpp": '#include "sensor/tof.h"\nint read() { return 1; }\n'})
    package.git("rm", "--quiet", "arm_description/src/sensor")
    if name != "arm_description":
        package.git("mv", "arm_description", name)
        manifest = (package.root / name / "package.xml").read_text(encoding="utf-8")
        package.write({f"{name}/package.xml": manifest.replace("arm_description", name)})
    package.commit({f"{name}/src/sensor/tof.h": "#pragma once\n"})
    result = compare(package, "HEAD~1..HEAD")
    assert "submodule removed" not in breaking(result)
    assert "submodule 'arm_description/src/sensor' replaced by files of the repository" in map(str, result.notes)
    assert [text for found in result.subjects for text in sentences(found) if "included" in text] == []


def lose_contents(repository, commit, path):
    """Remove the contents of a file, which a partial clone may lack."""
    blob = repository.git("rev-parse", f"{commit}:{path}")
    (repository.root / ".git/objects" / blob[:2] / blob[2:]).unlink()
    (repository.root / path).write_bytes(b"")


def test_files_of_partial_clone_are_recognized_as_renamed(package, compare):
    config = "".join(f"key_{number}: {number}\n" for number in range(30))
    package.commit(
        {"arm_description/meshes/a.stl": b"solid a\nendsolid a\n", "arm_description/config/arm.yaml": config}
    )
    commit = package.commit(
        {
            "arm_description/config/arm.yaml": None,
            "arm_description/config/limits.yaml": config.replace("key_7: 7", "key_7: 8"),
            "arm_description/meshes/a.stl": None,
            "arm_description/meshes/link.stl": b"solid a\nendsolid a\n",
            "arm_description/meshes/b.stl": b"solid b\nendsolid b\n",
        }
    )
    for name in ("link", "b"):
        lose_contents(package, commit, f"arm_description/meshes/{name}.stl")
    result = compare(package, "HEAD~1..HEAD")
    assert breaking(result) == [
        "renamed from arm_description/config/arm.yaml",
        "renamed from arm_description/meshes/a.stl",
    ]


def test_missing_file_of_partial_clone_is_a_problem_of_that_file_only(package, compare, tmp_path):
    mesh = package.commit({"arm_description/meshes/a.stl": b"solid a\nendsolid a\n" * 1000})
    package.commit({"arm_description/urdf/segment.xacro": arm_with_mass(3)})
    lose_contents(package, mesh, "arm_description/meshes/a.stl")
    result = compare(package, "HEAD~1..HEAD")
    assert mass_sentences(result) == ["link 'upper': inertial mass 2 -> 3 kg"]
    assert "git cannot check out one file of both versions: 'arm_description/meshes/a.stl'" in map(str, result.notes)


def test_a_file_that_git_cannot_check_out_is_not_a_new_finding(package, compare):
    mesh = package.commit({"arm_description/meshes/a.stl": b"solid a\nendsolid a\n" * 1000})
    visual = '<visual><geometry><mesh filename="package://arm_description/meshes/a.stl"/></geometry></visual>'
    package.commit({"arm_description/urdf/tool.urdf": f'<robot name="t"><link name="t">{visual}</link></robot>'})
    lose_contents(package, mesh, "arm_description/meshes/a.stl")
    found = compare(package, "HEAD~1..HEAD").new_findings
    assert [str(finding.message) for finding in found] == []


def test_new_and_fixed_findings_are_reported(package, compare):
    package.commit({"arm_description/urdf/segment.xacro": MACRO.replace('velocity="1"', 'velocity="0"')})
    text = MACRO.replace('mass value="2"', 'mass value="-1"')
    package.write({"arm_description/urdf/segment.xacro": "\n\n" + text if text.startswith("<robot") else text})
    result = compare(package)
    assert result.new_findings
    assert result.fixed_findings
    assert {finding.code for finding in result.new_findings}.isdisjoint(
        finding.code for finding in result.fixed_findings
    )
    assert all(finding.span.file.startswith("arm_description/") for finding in result.new_findings)


def test_moved_findings_are_neither_new_nor_fixed(package, compare):
    faulty = MACRO.replace('mass value="2"', 'mass value="-1"')
    package.commit({"arm_description/urdf/segment.xacro": faulty})
    moved = faulty.replace("<xacro:macro", "<!-- a\n\n\ncomment -->\n<xacro:macro").replace(
        'effort="10"', 'effort="11"'
    )
    package.write({"arm_description/urdf/segment.xacro": moved})
    result = compare(package)
    assert subject(result, PATH).changes
    assert (result.new_findings, result.fixed_findings) == ([], [])


def test_missing_folder_is_named_instead_of_git(tmp_path):
    with pytest.raises(LinkwrightError) as error:
        open_versions(tmp_path / "nowhere", "HEAD~1..HEAD")
    (diagnostic,) = error.value.diagnostics
    assert (diagnostic.code, str(diagnostic.message).endswith("nowhere' is not a folder")) == ("CLI342", True)


def test_build_files_of_colcon_are_not_checked_out_unless_they_change(repository):
    kept = ["build/b/a.yaml", "build/b/other.yaml", "install/a.yaml", "log/a.yaml", "arm/build/a.yaml"]
    unused = ["build/COLCON_IGNORE", "build/a/a.yaml", "arm/log/COLCON_IGNORE", "arm/log/x/a.yaml"]
    repository.commit({**dict.fromkeys(kept + unused, "a: 1\n"), "install/COLCON_IGNORE": ""})
    repository.commit({"build/b/a.yaml": "a: 2\n"})
    repository.write({"build/b/a.yaml": "a: 3\n"})
    versions = open_versions(repository.root, "HEAD~1..HEAD")
    try:
        for version in (versions.old, versions.new):
            assert [path for path in kept if not version.file(path).is_file()] == []
            assert [path for path in unused if version.file(path).exists()] == ["build/COLCON_IGNORE"]
            assert version.commit.missing_files == []
    finally:
        versions.close()


def test_links_out_of_build_folders_are_still_noted(package, compare, tmp_path):
    package.write({"build/COLCON_IGNORE": ""})
    (package.root / "build/latest").symlink_to(tmp_path)
    package.commit({})
    package.commit({"build/a.yaml": "a: 1\n"})
    notes = [str(note) for note in compare(package, "HEAD~1..HEAD").notes]
    assert notes == ["symbolic link 'build/latest' points outside the repository and is ignored"]


def test_generated_folders_are_no_packages_interfaces_or_descriptions(package, compare, tmp_path):
    """The sources of what is removed with them are still there."""
    share = "arm_description/launch/install/arm/share/arm"
    package.write(
        {
            "arm_description/launch/install/COLCON_IGNORE": "",
            "arm_description/launch/install/.colcon_install_layout": "isolated\n",
            "arm_description/launch/install/_local_setup_util_sh.py": "parser.add_argument('--merged-install')\n",
            f"{share}/package.xml": "<package format='3'><name>arm</name></package>",
            f"{share}/msg/State.msg": "float64 position\n",
            f"{share}/robot.urdf": "<robot name='arm'><link name='base_link'/></robot>",
            "arm_description/launch/log/COLCON_IGNORE": "",
            "arm_description/launch/log/build_1/events.log": "x\n",
            "devel/.catkin": "",
            "devel/_setup_util.py": "a = 1\n",
        }
    )
    (package.root / share / "mesh.stl").symlink_to(tmp_path)
    package.commit({})
    package.git("rm", "-r", "--quiet", "arm_description/launch/install", "arm_description/launch/log")
    package.commit({"devel/_setup_util.py": "a = 2\n", "devel/arm.yaml": "a: 1\n"})
    result = compare(package, "HEAD~1..HEAD")
    folders = "'arm_description/launch/install/', 'arm_description/launch/log/'"
    assert (result.subjects, result.other_files) == ([], [])
    assert list(map(str, result.notes)) == [
        "one generated file of colcon or catkin added, in 'devel/'",
        f"9 generated files of colcon or catkin removed, in {folders}",
        "one generated file of colcon or catkin changed, in 'devel/'",
    ]


def test_file_that_leaves_a_generated_folder_is_added(package, compare):
    package.commit({"build/COLCON_IGNORE": "", "build/.built_by": "colcon\n", "build/a.yaml": "rate: 50\n"})
    package.git("mv", "build/a.yaml", "arm_description/a.yaml")
    package.commit({})
    result = compare(package, "HEAD~1..HEAD")
    assert sentences(subject(result, "arm_description/a.yaml")) == ["parameter file added: rate 50"]
    assert list(map(str, result.notes)) == ["one generated file of colcon or catkin removed, in 'build/'"]


def test_folder_that_becomes_a_submodule_loses_nothing(package, compare, tmp_path):
    """Its files are in the other repository now."""
    part = MACRO.replace('"segment"', '"tool"')
    robot = ARM.replace(
        '<link name="base_link"/>', '<xacro:include filename="../tools/tool.xacro"/><link name="base_link"/>'
    )
    package.commit({"arm_description/tools/tool.xacro": part, "arm_description/urdf/arm.urdf.xacro": robot})
    other = Repository(tmp_path / "other")
    other.commit({"tool.xacro": part})
    package.git("rm", "-r", "--quiet", "arm_description/tools")
    package.git("submodule", "--quiet", "add", other.root.as_uri(), "arm_description/tools")
    package.commit({})
    result = compare(package, "HEAD~1..HEAD")
    assert breaking(result) == []
    assert "submodule 'arm_description/tools' added; its files are not compared" in list(map(str, result.notes))
