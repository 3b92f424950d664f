"""Courses are read with all their texts.

Each mistake in their files is one error with its location.
"""

from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.learning.course import find_course, load_course
from linkwright.learning.lesson_text import read_lesson_text

TEXT = """# First

Intro with `code`.

## One {#one}

Body.

```markdown
## Not a step {#no}
```

### Try it

More.

### Look {.hint}

Here.

### How {.hint}

So.

## Two {#two answer=m/s}

Measure.
"""


def write_course(folder: Path, *, en: str = TEXT, zh: str = TEXT, course: str = "", lesson: str = "") -> Path:
    (folder / "a").mkdir(parents=True)
    (folder / "course.toml").write_text(course or 'lessons = ["a"]\ntitle.en = "C"\n', encoding="utf-8")
    (folder / "a" / "lesson.toml").write_text(lesson or 'title.en = "A"\ntitle.zh = "甲"\n', encoding="utf-8")
    (folder / "a" / "lesson.en.md").write_text(en, encoding="utf-8")
    (folder / "a" / "lesson.zh.md").write_text(zh, encoding="utf-8")
    return folder


def test_headings_divide_lesson_into_steps_and_hints(tmp_path):
    (tmp_path / "lesson.md").write_text(TEXT, encoding="utf-8")
    text = read_lesson_text(tmp_path / "lesson.md")
    assert (text.title, text.introduction) == ("First", "Intro with `code`.")
    first, second = text.steps
    assert (first.id, first.title, first.unit, first.line) == ("one", "One", None, 5)
    assert first.body.startswith("Body.\n\n```markdown\n## Not a step {#no}")
    assert first.body.endswith("### Try it\n\nMore.")
    assert first.hints == ("### Look\n\nHere.", "### How\n\nSo.")
    assert (second.id, second.unit, second.hints) == ("two", "m/s", ())


def test_course_has_steps_in_all_languages(tmp_path):
    course = load_course(write_course(tmp_path / "c", zh=TEXT.replace("One", "一")))
    assert [step.address for step in course.steps] == ["a/one", "a/two"]
    assert course.steps[0].title.texts == {"en": "One", "zh": "一"}
    assert course.steps[0].text("zh").title == "一"
    assert course.find_step("two").unit == course.find_step("a/two").unit == "m/s"


@pytest.mark.parametrize(
    ("changes", "code", "part"),
    [
        ({"course": "lessons = ["}, "LEARN104", "not valid TOML"),
        ({"course": 'lessons = []\ntitle.en = "C"'}, "LEARN104", "'lessons'"),
        ({"course": 'lessons = ["b"]\ntitle.en = "C"'}, "LEARN102", "cannot read"),
        ({"course": 'lessons = ["a"]'}, "LEARN104", "'title'"),
        ({"lesson": 'title.xx = "A"'}, "LEARN104", "language 'xx'"),
        ({"lesson": 'title.en = "A"\nneeds = 3'}, "LEARN104", "'needs'"),
        ({"en": "text"}, "LEARN103", "no title"),
        ({"en": "# Title\n"}, "LEARN103", "no steps"),
        ({"en": "# Title\n\n## Step\n"}, "LEARN103", "'Step' has no name"),
        ({"en": "# Title\n\n## Step {#Big}\n"}, "LEARN103", "'Step' has no name"),
        ({"zh": TEXT.replace("#two", "#three")}, "LEARN105", "step 2 differs"),
        ({"zh": TEXT.replace(" answer=m/s", "")}, "LEARN105", "step 2 differs"),
        ({"zh": TEXT.replace("### How {.hint}", "### How")}, "LEARN105", "step 1 differs"),
        ({"zh": TEXT.partition("## Two")[0]}, "LEARN105", "step 2 differs"),
    ],
)
def test_mistake_in_course_file_is_one_error(tmp_path, changes, code, part):
    folder = write_course(tmp_path / "c", **changes)
    with pytest.raises(LinkwrightError) as raised:
        load_course(folder)
    (finding,) = raised.value.diagnostics
    assert finding.code == code
    assert part in finding.message


def test_error_in_lesson_text_has_line(tmp_path):
    folder = write_course(tmp_path / "c", en="# Title\n\nText.\n\n## Step\n")
    with pytest.raises(LinkwrightError) as raised:
        load_course(folder)
    span = raised.value.diagnostics[0].span
    assert span is not None
    assert (Path(span.file).name, span.line) == ("lesson.en.md", 5)


def test_unknown_course_or_step_suggests_similar_name(tmp_path):
    course = load_course(write_course(tmp_path / "c"))
    with pytest.raises(LinkwrightError) as raised:
        course.find_step("tow")
    assert "'two'" in str(raised.value.diagnostics[0].hint)
    with pytest.raises(LinkwrightError) as raised:
        course.find_lessons(["b"])
    assert raised.value.diagnostics[0].code == "LEARN106"
    with pytest.raises(LinkwrightError) as raised:
        find_course("exampel")
    assert "'example'" in str(raised.value.diagnostics[0].hint)
