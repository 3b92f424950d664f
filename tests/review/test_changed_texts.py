"""The changed lines of long texts in sources, such as templates."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

XML = '<launch>\n  <arg name="ip" default="1.2.3.4"/>\n  <arg name="port" default="1"/>\n</launch>\n'
TEMPLATE = f'T = """{XML}"""\n'
FUNCTION = f'def write(file, name):\n    file.write(f"""{XML}<node name="{{name}}"/>""")\n    return 1\n'


@pytest.fixture
def review_source(repository, compare):
    """Review a replacement in a source, and return its lines."""

    def run(text: str, old: str, new: str, path: str = "arm/write.py"):
        assert old in text
        repository.commit({"arm/package.xml": PACKAGE_XML, path: text})
        repository.write({path: text.replace(old, new)})
        result = compare(repository)
        return [line for found in result.subjects for line in sentences(found)], result

    return run


@pytest.mark.parametrize(
    ("text", "old", "new", "expected"),
    [
        (TEMPLATE, "1.2.3.4", "5.6.7.8",
         'T: `<arg name="ip" default="1.2.3.4"/>` -> `<arg name="ip" default="5.6.7.8"/>`'),
        (TEMPLATE, "</launch>", '<arg name="format" default="288"/>\n</launch>',
         'T: `<arg name="format" default="288"/>` added'),
        (TEMPLATE, '  <arg name="port" default="1"/>\n', "", 'T: `<arg name="port" default="1"/>` removed'),
        (f"import textwrap\n{TEMPLATE.replace('= ', '= textwrap.dedent(').rstrip()})\n", "1.2.3.4", "5.6.7.8",
         'T: `<arg name="ip" default="1.2.3.4"/>` -> `<arg name="ip" default="5.6.7.8"/>`'),
        (FUNCTION, 'default="1"', 'default="2"',
         'write: file.write: `<arg name="port" default="1"/>` -> `<arg name="port" default="2"/>`'),
        (FUNCTION, 'name="{name}"', 'name="{name.lower()}"',
         'write: file.write: `<node name="{name}"/>` -> `<node name="{name.lower()}"/>`'),
    ],
)  # fmt: skip
def test_changed_lines_of_a_text_are_reported(review_source, text, old, new, expected):
    assert review_source(text, old, new)[0] == [f"lines of a text in {expected}"]


def test_location_is_that_of_the_first_changed_line(review_source):
    _, result = review_source(TEMPLATE, 'default="1"', 'default="2"')
    (change,) = result.subjects[0].changes
    assert (change.location.line, change.location.is_old) == (3, False)


def test_code_beside_the_text_is_reported_separately(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/write.py": FUNCTION})
    repository.write({"arm/write.py": FUNCTION.replace("1.2.3.4", "5.6.7.8").replace("return 1", "return file")})
    (found,) = compare(repository).subjects
    assert sentences(found)[1:] == ["in 'write()': `return 1` -> `return file`"]


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (TEMPLATE, "  <arg", "    <arg"),
        (f'"""{XML}"""\n', "1.2.3.4", "5.6.7.8"),
        (f'print("""{XML}""")\n', "1.2.3.4", "5.6.7.8"),
        (f'def f():\n    """{XML}"""\n', "1.2.3.4", "5.6.7.8"),
        (f'raise ValueError("""{XML}""")\n', "1.2.3.4", "5.6.7.8"),
        (f'p.add_argument("--ip", help="""{XML}""")\n', "1.2.3.4", "5.6.7.8"),
    ],
)
def test_layout_and_texts_for_readers_are_not_reported(review_source, text, old, new):
    assert not [line for line in review_source(text, old, new)[0] if line.startswith("lines of a text")]


def test_a_text_with_other_content_is_not_compared_by_lines(review_source):
    lines, _ = review_source(TEMPLATE, XML, "one two three\nfour five six\n")
    assert len(lines) == 1
    assert lines[0].startswith("outside of functions: `T = '<launch>")
    assert lines[0].endswith(r"`T = 'one two three\nfour five six\n'`")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (f'const char* T = R"({XML})";\n', "T"),
        ('void write() { save("first <ip> is 1.2.3.4\\n" "second line\\n"); }\n', "write: save"),
    ],
)
def test_texts_of_cpp_are_compared_by_lines(review_source, text, expected):
    (line,) = review_source(text, "1.2.3.4", "5.6.7.8", "arm/write.cpp")[0]
    assert line.startswith(f"lines of a text in {expected}: `")
    old, _, new = line.partition(" -> ")
    assert ("1.2.3.4" in old, "5.6.7.8" in new) == (True, True)


def test_many_lines_are_counted(review_source):
    lines = "".join(f"added line {number}\n" for number in range(20))
    (line,), _ = review_source(TEMPLATE, "</launch>\n", f"</launch>\n{lines}")
    assert line.endswith("`added line 7` and 12 more added")
