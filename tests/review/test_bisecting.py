"""The search for the commit that changed a robot."""

from __future__ import annotations

import sys

import pytest

from linkwright.cli import main
from tests.repositories import ARM, MACRO, Repository

PATH = "arm_description/urdf/arm.urdf.xacro"
SEGMENT = "arm_description/urdf/segment.xacro"


@pytest.fixture
def history(package, monkeypatch) -> Repository:
    """Create a history of twelve commits.

    The fourth makes the segments longer, the eighth renames the file, and the ninth does not expand.
    """
    monkeypatch.chdir(package.root)
    for number in range(2, 13):
        files: dict[str, str | None] = {"README.md": f"Commit {number}."}
        if number == 4:
            files[SEGMENT] = MACRO.replace("length:=0.5", "length:=0.6")
        if number == 8:
            files |= {PATH: None, "arm_description/urdf/robot.urdf.xacro": ARM}
        if number == 9:
            files["arm_description/urdf/robot.urdf.xacro"] = ARM.replace("</robot>", "${missing}</robot>")
        if number == 10:
            files["arm_description/urdf/robot.urdf.xacro"] = ARM.replace('xyz="0 0 0.2"', 'xyz="0 0 0.3"')
        package.commit(files, f"Commit {number}")
    return package


@pytest.fixture
def bisect(history, capsys):
    def run(*words: str) -> tuple[int, str, str]:
        status = main(["bisect", "arm_description/urdf/robot.urdf.xacro", *words])
        return status, *capsys.readouterr()

    return run


def test_commit_that_changed_joint_is_found_across_renamed_file(bisect):
    status, output, _ = bisect("--", "middle_joint")
    assert status == 0
    assert output.splitlines()[0].endswith("Ann: Commit 4")
    assert "  joint 'middle_joint': origin xyz 0 0 0.5 -> 0 0 0.6 m (moved by 0.1 m)" in output


def test_link_is_moved_by_changed_parent_joint(bisect):
    _, output, _ = bisect("--", "lower")
    assert output.splitlines()[0].endswith("Ann: Commit 4")
    assert "  link 'lower': moved by 0.3 m" in output


def test_commit_that_cannot_be_expanded_is_named_as_candidate(bisect):
    _, output, _ = bisect("tool:=probe", "--", "probe_joint")
    assert output.splitlines()[0].endswith("Ann: Commit 10")
    assert "one commit before it cannot be judged and may be the first" in output


def test_unchanged_link_is_reported_with_status_1(bisect):
    status, output, _ = bisect("--", "base_link")
    assert (status, output) == (1, "'base_link' is the same in all commits\n")


def test_commit_range_limits_bisection(bisect, history):
    assert bisect("--old", "HEAD~3", "--", "middle_joint")[0] == 1
    assert bisect("--new", "HEAD~9", "--", "middle_joint")[0] == 1


def test_command_runs_in_files_of_each_commit(bisect, history):
    program = (
        "import pathlib, sys; sys.exit('0.6' not in pathlib.Path('arm_description/urdf/segment.xacro').read_text())"
    )
    _, output, _ = bisect("--", sys.executable, "-c", program)
    assert output.splitlines()[0].endswith("Ann: Commit 4")
    program = "import pathlib, sys; sys.exit('0.3' in pathlib.Path(sys.argv[1]).read_text())"
    _, output, _ = bisect("--", sys.executable, "-c", program, "FILE")
    assert output.splitlines()[0].endswith("Ann: Commit 10")
    assert history.git("status", "--porcelain") == ""


def test_command_can_skip_commit(bisect):
    program = """import pathlib, sys
text = pathlib.Path(sys.argv[1]).read_text()
sys.exit(125 if 'missing' in text else '0.3' in text)"""
    _, output, _ = bisect("--", sys.executable, "-c", program, "FILE")
    assert output.splitlines()[0].endswith("Ann: Commit 10")
    assert "cannot be judged" in output


def test_change_on_merged_branch_is_found(history, bisect):
    history.git("switch", "--quiet", "--create", "heavy", "HEAD~2")
    text = MACRO.replace("length:=0.5", "length:=0.6").replace('mass value="2"', 'mass value="3"')
    history.commit({SEGMENT: text}, "Heavier")
    history.git("switch", "--quiet", "main")
    history.git("merge", "--quiet", "--no-edit", "heavy")
    assert bisect("--", "upper")[1].splitlines()[0].endswith("Ann: Heavier")


@pytest.mark.parametrize(
    ("words", "status", "message"),
    [
        (["--", "midle_joint"], 1, "did you mean 'middle_joint'?"),
        (["--", "no_such_program", "FILE"], 1, "error[REV112]"),
        (["--old", "nowhere", "--", "lower"], 1, "error[CLI343]"),
        (["--old", "--output=x", "--", "lower"], 2, "usage"),
        (["tool:=probe"], 2, "pass a link, a joint or a command after --"),
    ],
)
def test_invalid_arguments_are_errors(bisect, words, status, message):
    result = bisect(*words)
    assert result[0] == status
    assert message in result[2]
    assert "Traceback" not in result[2]


def test_newest_commit_that_cannot_be_expanded_is_an_error(bisect):
    status, _, errors = bisect("--new", "HEAD~3", "--", "lower")
    assert status == 1
    assert "missing" in errors


def test_renamed_link_is_found_with_its_motion(history, capsys, bisect):
    probe = ARM.replace('"probe', '"probe_link').replace('xyz="0 0 0.2"', 'xyz="0 0 0.4"')
    history.commit({"arm_description/urdf/robot.urdf.xacro": probe}, "Renamed")
    _, output, _ = bisect("tool:=probe", "--", "probe_link")
    assert output.splitlines()[0].endswith("Ann: Renamed")
    assert "moved by 0.1 m" in output


def test_new_root_link_moves_no_other(history, bisect):
    foot = """<link name="foot"/><joint name="foot_joint" type="fixed"><parent link="foot"/><child link="base_link"/>
    <origin xyz="0 0 0.3"/></joint><link name="base_link"/>"""
    text = ARM.replace('<link name="base_link"/>', foot)
    history.commit({"arm_description/urdf/robot.urdf.xacro": text}, "Lifted")
    assert bisect("--", "lower")[1].splitlines()[0].endswith("Ann: Commit 4")


def test_an_oldest_commit_of_another_branch_is_refused_with_the_common_commit(bisect, history):
    common = history.git("rev-parse", "HEAD~4")
    history.git("switch", "--quiet", "--create", "side", common)
    history.commit({"README.md": "Side."}, "Side")
    history.git("switch", "--quiet", "main")
    status, output, errors = bisect("--old", "side", "--", "middle_joint")
    assert (status, output) == (1, "")
    assert "error[REV114]: commit 'side' is not in the history of 'HEAD'" in errors
    assert f"`--old {common[:9]} --new HEAD`" in errors


def test_swapped_ends_are_named(bisect):
    status, _, errors = bisect("--old", "HEAD", "--new", "HEAD~2", "--", "middle_joint")
    assert status == 1
    assert "'HEAD~2' is the older one: `--old HEAD~2 --new HEAD`" in errors


def test_commits_without_a_common_history_are_refused(bisect, history):
    history.git("switch", "--quiet", "--orphan", "island")
    history.commit({"arm_description/urdf/robot.urdf.xacro": ARM, SEGMENT: MACRO}, "Island")
    history.git("switch", "--quiet", "main")
    assert "error[REV114]" in bisect("--old", "island", "--", "middle_joint")[2]


def test_the_first_commit_of_a_file_is_that_of_the_newest_commit(bisect, history):
    history.git("switch", "--quiet", "--create", "side", "HEAD~2")
    history.commit({SEGMENT: MACRO.replace("length:=0.5", "length:=0.9")}, "Longer")
    history.git("switch", "--quiet", "main")
    assert bisect("--new", "side", "--", "middle_joint")[1].splitlines()[0].endswith("Ann: Longer")


def test_file_with_letters_of_other_languages_is_followed_across_a_new_name(package, monkeypatch, capsys):
    monkeypatch.chdir(package.root)
    package.commit({PATH: None, "arm_description/urdf/grün ärm.urdf.xacro": ARM}, "Renamed")
    package.commit({PATH: ARM, "arm_description/urdf/grün ärm.urdf.xacro": None}, "Renamed again")
    package.commit({SEGMENT: MACRO.replace("length:=0.5", "length:=0.6")}, "Longer")
    package.commit({PATH: None, "arm_description/urdf/臂.urdf.xacro": ARM}, "Renamed at last")
    package.commit({"README.md": "Later"}, "Later")
    assert main(["bisect", "arm_description/urdf/臂.urdf.xacro", "--", "middle_joint"]) == 0
    assert capsys.readouterr().out.splitlines()[0].endswith("Ann: Longer")


def test_end_of_history_that_cannot_be_judged_is_named(history, bisect):
    commit = history.git("log", "--format=%h", "--grep=Commit 9")
    status, _, errors = bisect("--old", commit, "--", "middle_joint")
    assert status == 1
    assert f"error[REV113]: the oldest commit cannot be judged: {commit} " in errors
    assert "= hint: name a later commit that can be judged: `--old COMMIT`" in errors
    _, _, errors = bisect("--", sys.executable, "-c", "import sys; sys.exit(125)")
    assert "error[REV113]: the newest commit cannot be judged: " in errors
    assert "= hint: name an earlier commit that can be judged: `--new COMMIT`" in errors
