"""Reports tell each fact once, the most important first, in lines that a reader can take in."""

from __future__ import annotations

import html
import re

import pytest

from linkwright.diagnostics import phrase
from linkwright.review import Change, Effect, Review, Subject, SubjectKind
from linkwright.review.changes import Figure, Location
from linkwright.review.reports import as_data, as_html, as_markdown, as_text
from linkwright.review.reports.sentences import format_change


def make_subject(path, changes, kind=SubjectKind.LAUNCH_FILE, **others):
    return Subject(kind, path, path, path, changes, **others)


def make_code_change(name, path="src/a.cpp"):
    sentence = phrase("code changed in {names}", names=f"'{name}()'")
    return Change(sentence, location=Location(path, 3, 1), is_code=True)


def read(markdown):
    """Return the comment as it is shown."""
    return html.unescape(re.sub("</?code>", "", markdown))


def test_robots_come_first_and_code_last():
    subjects = [
        make_subject("a/CMakeLists.txt", [Change(phrase("library removed"))], SubjectKind.BUILD),
        make_subject("a/src/a.cpp", [make_code_change("spin")], SubjectKind.SOURCE),
        make_subject("a/src/b.cpp", [Change(phrase("topics added"))], SubjectKind.SOURCE),
        make_subject("a/urdf/a.urdf", [Change(phrase("link added"))], SubjectKind.DESCRIPTION),
    ]
    text = as_text(Review("main", "topic", subjects))
    paths = [line for line in text.splitlines() if line.startswith("a/")]
    assert paths == ["a/urdf/a.urdf", "a/src/b.cpp", "a/CMakeLists.txt", "a/src/a.cpp"]


@pytest.mark.parametrize("kind", SubjectKind)
def test_each_kind_of_file_has_a_section(kind):
    review = Review("main", "topic", [make_subject("a/file", [Change(phrase("link added"))], kind)])
    for report in (as_text(review), read(as_markdown(review)), as_html(review)):
        assert "a/file" in report
        assert "link added" in report


def test_summary_does_not_deny_the_files_that_are_listed_above_it():
    files = ["a/arm.service", "a/notes.md"]
    review = Review("main", "topic", other_files=files, file_states={files[0]: phrase("removed")})
    assert as_text(review).splitlines()[-1] == "only 2 other files changed"
    review = Review("main", "topic", other_files=files)
    assert as_text(review).splitlines()[-1] == "nothing that a review compares changed from main to topic"


def test_sources_with_only_other_code_share_a_section():
    subjects = [
        make_subject(f"src/{name}.cpp", [make_code_change(name, f"src/{name}.cpp")], SubjectKind.SOURCE)
        for name in "abc"
    ]
    comment = read(as_markdown(Review("main", "topic", subjects)))
    assert "<details><summary>Only code changed in 3 sources</summary>" in comment
    assert "- src/b.cpp: code changed in 'b()' (line 3)" in comment
    assert "####" not in comment
    assert as_html(Review("main", "topic", subjects)).count("<h2>") == 1
    assert read(as_markdown(Review("main", "topic", subjects[:2]))).count("#### src/") == 2


def test_sentences_that_differ_in_a_name_are_one_line():
    names = ["robot_ip", "port", "reverse_port", "tool_voltage"]
    changes = [
        Change(
            phrase("argument '{name}' removed", name=name),
            Effect.BREAKING,
            phrase("a value that a caller passes for '{name}' has no effect", name=name),
        )
        for name in names
    ]
    comment = read(as_markdown(Review("main", "topic", [make_subject("a.launch.py", changes)])))
    (line,) = [line for line in comment.splitlines() if "argument" in line]
    assert line == (
        "- **argument 'robot_ip' removed; also 'port', 'reverse_port', 'tool_voltage'**: a value that a caller passes "
        "for 'robot_ip' has no effect; likewise for the others (a.launch.py)"
    )


def make_removed(kind, names, reason):
    sentence = phrase("{kind} removed: {names}", kind=kind, names=names)
    return Change(sentence, Effect.BREAKING, reason, Location("src/a.cpp", 3, 1, is_old=True))


@pytest.mark.parametrize(
    ("new_path", "expected"),
    [
        (
            None,
            [
                "! publishers removed: '/map'; nodes removed: 'mapper'; parameters removed: 'rate'",
                (
                    "  breaking: programs that use the name '/map' do not find it; "
                    "a value that is set for 'rate' has no effect; likewise for the others"
                ),
            ],
        ),
        (
            "src/a.cpp",
            [
                "! publishers removed: '/map'",
                "  breaking: programs that use the name '/map' do not find it",
                "! nodes removed: 'mapper'",
                "  breaking: programs that use the name 'mapper' do not find it",
                "! parameters removed: 'rate'",
                "  breaking: a value that is set for 'rate' has no effect",
            ],
        ),
    ],
)
def test_what_a_removed_source_offered_is_one_breaking_change(new_path, expected):
    changes = [
        make_removed("publishers", "'/map'", phrase("programs that use the name '{name}' do not find it", name="/map")),
        make_removed("nodes", "'mapper'", phrase("programs that use the name '{name}' do not find it", name="mapper")),
        make_removed("parameters", "'rate'", phrase("a value that is set for '{name}' has no effect", name="rate")),
        Change(phrase("timers removed")),
    ]
    subject = Subject(SubjectKind.SOURCE, "src/a.cpp", "src/a.cpp", new_path, changes)
    review = Review("main", "topic", [subject])
    lines = [line[2:] for line in as_text(review).splitlines() if line.startswith(("  ! ", "    breaking"))]
    assert lines == expected
    assert as_text(review).count("\n  - timers removed") == 1
    summary = "1 breaking change, 2 changes," if new_path is None else "3 breaking changes, 4 changes,"
    assert summary in as_text(review)


def test_two_sentences_that_differ_in_a_name_stay_apart():
    changes = [Change(phrase("argument '{name}' added", name=name)) for name in ("a", "b")]
    text = as_text(Review("main", "topic", [make_subject("a.launch.py", changes)]))
    assert "argument 'a' added\n  - argument 'b' added" in text


def test_same_part_that_several_files_lose_is_one_breaking_change():
    subjects = [
        make_subject(
            f"config/{robot}.yaml",
            [
                Change(
                    phrase("{parameter} removed: {items}", parameter="dh", items=f"a {robot}"),
                    Effect.BREAKING,
                    phrase("programs that read '{name}' from the file do not find it", name="dh"),
                )
            ],
            SubjectKind.PARAMETERS,
        )
        for robot in ("ur3", "ur5")
    ]
    comment = read(as_markdown(Review("main", "topic", subjects)))
    assert (
        "- **dh removed**: programs that read 'dh' from the file do not find it (config/ur3.yaml, config/ur5.yaml)"
        in comment
    )
    page = html.unescape(as_html(Review("main", "topic", subjects)))
    assert "dh removed: a ur3" in page
    assert "dh removed: a ur5" in page


def test_breaking_change_with_different_arguments_is_listed_once():
    reason = phrase("controllers no longer keep '{name}' within limits", name="wrist")
    subjects = [
        Subject(
            SubjectKind.DESCRIPTION,
            path,
            path,
            path,
            [Change(phrase("joint '{name}' changed", name="wrist"), Effect.BREAKING, reason, cases=cases)],
            cases=("type:=a", "type:=b"),
        )
        for path, cases in (("a.urdf.xacro", ("type:=a",)), ("b.urdf.xacro", ("type:=a", "type:=b")))
    ]
    comment = read(as_markdown(Review("main", "topic", subjects)))
    assert comment.count("joint 'wrist' changed") == 1
    assert "(a.urdf.xacro, b.urdf.xacro)" in comment


def test_changes_in_common_with_an_earlier_file_are_counted():
    common = [Change(phrase("speed 1 -> 2")), Change(phrase("gain 3 -> 4"))]
    subjects = [
        make_subject("a.yaml", [*common, Change(phrase("rate 5 -> 6"))], SubjectKind.PARAMETERS),
        make_subject("b.yaml", [*common, Change(phrase("rate 7 -> 8"))], SubjectKind.PARAMETERS),
        make_subject("c.yaml", [common[0], Change(phrase("rate 9 -> 10"))], SubjectKind.PARAMETERS),
    ]
    review = Review("main", "topic", subjects)
    text = as_text(review)
    assert "b.yaml\n  - rate 7 -> 8\n  - 2 of the 3 changes of a.yaml, but not: rate 5 -> 6\n" in text
    assert "c.yaml\n  - speed 1 -> 2\n" in text
    assert "0 breaking changes, 8 changes" in text
    assert [len(subject["changes"]) for subject in as_data(review)["subjects"]] == [3, 3, 2]


@pytest.mark.parametrize(
    ("count", "line"),
    [(2, "b.yaml\n  - common 0 -> 1\n  - common 1 -> 2\n"), (4, "b.yaml\n  - 4 of the 7 changes of a.yaml\n")],
)
def test_few_changes_in_common_with_a_file_that_has_many_others_are_listed(count, line):
    """A reader cannot tell which they are."""
    common = [Change(phrase(f"common {number} -> {number + 1}")) for number in range(count)]
    others = [Change(phrase(f"other {number} -> {number + 1}")) for number in range(3)]
    subjects = [
        make_subject("a.yaml", [*common, *others], SubjectKind.PARAMETERS),
        make_subject("b.yaml", common, SubjectKind.PARAMETERS),
    ]
    assert line in as_text(Review("main", "topic", subjects))


def test_long_arguments_are_not_repeated_in_successive_lines():
    cases = ("", "tower:=true camera:=front namespace:=robot_in_the_hall")
    changes = [Change(phrase(f"mass {number} -> 9"), cases=cases[1:]) for number in range(2)]
    subjects = [make_subject("a.urdf.xacro", [*changes, Change(phrase("height 1 -> 2"))], cases=cases)]
    text = as_text(Review("main", "topic", subjects))
    assert f"mass 0 -> 9 (with {cases[1]})\n  - mass 1 -> 9 (with the same arguments)\n  - height 1 -> 2\n" in text


def test_equal_figures_of_a_robot_and_an_included_one_are_shown_once():
    change = Change(phrase("link 'arm' added"), location=Location("arm.urdf", 3, 1))
    figures = [Figure(phrase("mass"), "1", "2", "kg")]
    subjects = [make_subject(path, [change], figures=figures) for path in ("all.urdf.xacro", "arm.urdf")]
    text = as_text(Review("main", "topic", subjects))
    assert text.count("mass: 1 -> 2 kg") == 1
    assert "  = the same in one more file: arm.urdf\n" in text


def test_file_with_only_breaking_changes_has_no_section_of_its_own():
    change = Change(phrase("argument '{name}' removed", name="speed"), Effect.BREAKING, phrase("callers fail"))
    subjects = [make_subject(path, [change]) for path in ("a.launch.py", "b.launch.py")]
    comment = read(as_markdown(Review("main", "topic", subjects)))
    assert "the same in" not in comment
    assert "#### a.launch.py" not in comment
    assert "(a.launch.py, b.launch.py)" in comment


def test_long_lines_are_cut_and_the_page_and_data_have_the_rest():
    items = ", ".join(f"parameter p{number} {number}" for number in range(200))
    review = Review(
        "main", "topic", [make_subject("a.launch.py", [Change(phrase("node added: {items}", items=items))])]
    )
    (line,) = [line for line in read(as_markdown(review)).splitlines() if "node added" in line]
    assert len(line) < 320
    assert re.search(r"parameter p\d+ \d+, \.\.\.$", line)
    assert "p199" not in as_text(review)
    assert as_data(review)["subjects"][0]["changes"][0]["text"].endswith("p199 199")
    page = as_html(review)
    summary, rest = re.search("<details class='long'><summary>(.*?)</summary>(.*?)</details>", page).groups()
    assert "p199" not in summary
    assert rest.endswith("p199 199")


def test_new_findings_follow_the_breaking_changes(package, compare):
    path = "arm_description/urdf/bad.urdf"
    package.commit({path: '<robot name="a"><link name="b"/></robot>'})
    package.commit({path: '<robot name="a"><link name="b"/><link name="c"/></robot>'})
    review = compare(package, "HEAD~1..HEAD")
    comment = as_markdown(review)
    assert review.new_findings
    assert comment.index("#### New findings") < comment.index("bad.urdf</code>\n\n-")


def test_changes_of_an_action_are_one_line_of_the_comment():
    entry = phrase("node '{name}'", name="arm/drive")
    changes = [
        Change(phrase("{entry}: {change}", entry=entry, change=phrase("parameter {name} added", name=name)))
        for name in ("speed", "gain")
    ]
    review = Review("main", "topic", [make_subject("a.launch.py", changes)])
    assert "- node 'arm/drive': parameter speed added; parameter gain added\n" in read(as_markdown(review))
    assert "0 breaking changes, 2 changes" in as_markdown(review)


def test_long_types_are_cut_to_their_difference_in_the_comment_only():
    types = "double, double, const std::string&, unsigned int, unsigned int, boost::shared_ptr<tf::Listener>"
    values = {"old": f"({types}, int, bool)", "new": f"({types}, long, bool)"}
    change = Change(phrase("function '{name}': {old} -> {new}", name="f", **values))
    review = Review("main", "topic", [make_subject("a.hpp", [change], SubjectKind.SOURCE)])
    (line,) = [line for line in read(as_markdown(review)).splitlines() if "function" in line]
    assert re.search(r"\.\.\. .*int, bool\) -> \.\.\. .*long, bool\)", line)
    assert "const std::string" not in line
    assert values["new"] in html.unescape(as_html(review))


def test_many_breaking_changes_are_folded():
    changes = [
        Change(
            phrase("topic '{name}': type {old} -> {new}", name=name, old=name, new="B"), Effect.BREAKING, phrase("x")
        )
        for name in map(str, range(20))
    ]
    comment = as_markdown(Review("main", "topic", [make_subject("a.cpp", changes, SubjectKind.SOURCE)]))
    start, rest = comment.split("<details><summary>4 more breaking changes</summary>")
    assert start.count("- **") == 16
    assert rest.count("- **") == 4


def test_lines_below_a_fold_are_not_part_of_it():
    """Markdown ends a block of HTML only at an empty line."""
    changes = [Change(phrase("value {number}", number=number)) for number in range(20)]
    subjects = [make_subject(path, changes) for path in ("a.yaml", "b.yaml")]
    comment = as_markdown(Review("main", "topic", subjects))
    assert "</details>\n\n- the same in one more file: b.yaml" in comment


def test_robots_with_only_the_changes_of_a_shared_file_are_one_section():
    location = Location("shared.xacro", 3, 1)
    changes = [
        Change(
            phrase(
                "{subject} '{name}': {property} {old} -> {new}",
                subject="joint",
                name=name,
                property="limit",
                old=1,
                new=2,
            ),
            location=location,
        )
        for name in ("shoulder",)
    ]
    subjects = [make_subject(f"{name}.urdf.xacro", changes, SubjectKind.DESCRIPTION) for name in ("a", "b", "c")]
    review = Review("main", "topic", subjects)
    text = as_text(review)
    assert "= the same in 2 more files: b.urdf.xacro, c.urdf.xacro" in text
    assert "0 breaking changes, 1 change," in text


def make_shared_change(*names: str, name: str = "j") -> Change:
    sentence = phrase(
        "{subject} '{name}': {property} {old} -> {new}", subject="joint", name=name, property="p", old=1, new=2
    )
    return Change(sentence, location=Location("shared.xacro", 3, 1), other_names=names)


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("joint2", "joint3"), "= the same in one more file: b.urdf.xacro"),
        (("joint2",), "= the same in one more file: b.urdf.xacro"),
        (("joint2", "joint3", "joint4"), "- the same change in a shared file as in a.urdf.xacro, here also 'joint4'"),
        (("left", "right", "middle"), "- joint 'j': p 1 -> 2; also 'left', 'right', 'middle'"),
    ],
)
def test_other_names_of_a_change_to_a_shared_file_are_named(names, expected):
    changes = {"a": make_shared_change("joint2", "joint3"), "b": make_shared_change(*names)}
    kind = SubjectKind.DESCRIPTION
    subjects = [make_subject(f"{name}.urdf.xacro", [change], kind) for name, change in changes.items()]
    assert f"  {expected}\n" in as_text(Review("main", "topic", subjects))


def test_the_first_name_of_a_repeated_change_is_named_if_the_other_file_has_the_rest():
    changes = {"a": make_shared_change(name="right"), "b": make_shared_change("right", name="left")}
    kind = SubjectKind.DESCRIPTION
    subjects = [make_subject(f"{name}.urdf.xacro", [change], kind) for name, change in changes.items()]
    assert "as in a.urdf.xacro, here also 'left'\n" in as_text(Review("main", "topic", subjects))


@pytest.mark.parametrize(
    ("first", "names", "expected"),
    [
        ("a.joint1.max", ("a.joint2.max", "a.joint3.max", "a.joint4.max"), "'joint2' to 'joint4'"),
        ("a.joint1.max", ("a.joint2.max", "a.joint2.min"), "'a.joint2.max', 'a.joint2.min'"),
        ("a.joint1.max", ("b.joint1.max",), "'b'"),
        ("joint1.max", ("joint2.max",), "'joint2.max'"),
        ("a.x.max", ("a.arm_8.max", "a.arm_9.max", "a.arm_10.max", "a.leg_11.max"), "'arm_8' to 'arm_10', 'leg_11'"),
    ],
)
def test_other_parameters_are_named_by_what_differs(first, names, expected):
    change = Change(phrase("{parameter} {old} -> {new}", parameter=first, old=1, new=2), other_names=names)
    assert str(format_change(change)) == f"{first} 1 -> 2; also {expected}"


def test_place_in_the_old_version_is_marked():
    change = Change(phrase("link removed"), location=Location("a.urdf", 3, 1, is_old=True))
    assert "    a.urdf:3:1 (old)\n" in as_text(Review("main", "topic", [make_subject("a.urdf", [change])]))


def make_value_changes(name: str) -> list[Change]:
    return [
        Change(phrase("{parameter} {old} -> {new}", parameter=f"{name}_arm.{key}", old=1, new=2), location=None)
        for key in ("rate", "gain")
    ]


def test_sections_that_differ_in_a_word_of_the_path_are_one_with_the_words():
    names = {
        "config/left.yaml": "left",
        "config/right.yaml": "right",
        "sim/right.yaml": "right",
        "config/b.yaml": "left",
    }
    subjects = [
        make_subject(path, make_value_changes(name), SubjectKind.PARAMETERS) for path, name in names.items()
    ] + [make_subject("config/up.yaml", make_value_changes("other"), SubjectKind.PARAMETERS)]
    lines = as_text(Review("main", "topic", subjects)).splitlines()
    assert [line for line in lines if line in {subject.path for subject in subjects}] == [
        "config/left.yaml",
        "config/up.yaml",
    ]
    renamed = " (with 'right' instead of 'left')"
    alike = f"config/right.yaml{renamed}, sim/right.yaml{renamed}, config/b.yaml"
    assert f"  = the same in 3 more files: {alike}" in lines
    assert lines[-1].startswith("0 breaking changes, 10 changes,")
