"""The lines of a review about functions of headers that other packages use."""

from __future__ import annotations

import pytest

from linkwright.review.sources.cpp.functions import read_declared_functions
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

HEADER = """#pragma once
#define ARM_NAME(x) #x
namespace arm
{
class ARM_PUBLIC Driver : public Base<int, double>
{
public:
  explicit Driver(const std::string & name, int rate = 10) : Base(name), rate_{rate} {}
  virtual ~Driver() = default;
  virtual bool move(double angle, std::map<int, double> limits) const = 0;
  void stop();
  int rate() const { return rate_; }
  enum class Mode { FAST, SLOW };

protected:
  void reset(int x);

private:
  void own(int x);
  int rate_{10};
};
double length(const Driver & driver, bool all = false);
using Callback = std::function<void(int)>;
}  // namespace arm
"""
FILES = {
    "a/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "a/CMakeLists.txt": "project(arm)\ninstall(DIRECTORY include/ DESTINATION include)\n",
    "a/include/arm/driver.hpp": HEADER,
}


def test_functions_of_a_header_are_read_with_their_types():
    text = HEADER.replace("// namespace arm", "")
    assert [each[:3] for each in read_declared_functions(text)] == [
        ("Driver::Driver", ("const std::string&", "int = ..."), False),
        ("Driver::move", ("double", "std::map<int,double>"), True),
        ("Driver::stop", (), False),
        ("Driver::rate", (), False),
        ("length", ("const Driver&", "bool = ..."), False),
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("void stop()", "void stop(bool now = true)", ["function 'Driver::stop': () -> (bool = ...)"], False),
        ("void stop()", "void stop(bool now)", ["function 'Driver::stop': () -> (bool)"], True),
        ("void stop();", "void stop();\n  void stop(int time);",
         ["function 'Driver::stop': overloads (int) added"], False),
        ("void stop();", "void stop(int time);\n  void stop(double time);",
         ["function 'Driver::stop': () -> (double) | (int)"], True),
        ("void stop();", "void halt();",
         ["functions added: 'Driver::halt'", "functions removed: 'Driver::stop'"], True),
        ("void stop();", "void stop();\n  void halt();", ["functions added: 'Driver::halt'"], False),
        ("void stop();", "virtual void stop() = 0;", ["function 'Driver::stop': required no -> yes"], True),
        ("void stop();", "void stop();\n  virtual void halt() = 0;", ["functions added: 'Driver::halt'"], True),
        ("double angle,", "float angle,",
         ["function 'Driver::move': (double, std::map<int,double>) -> (float, std::map<int,double>)"], True),
        ("void own(int x)", "void own(int x, int y)", ["code changed in 'Driver'"], False),
        ("void reset(int x)", "void reset(int x, int y)",
         ["protected function 'Driver::reset': (int) -> (int, int)"], True),
        ("int rate() const", "int rate() const override", [], False),
        ("(double angle,", "(double value,", [], False),
        ("class ARM_PUBLIC Driver", "class ARM_PUBLIC ArmDriver", ["class 'Driver' renamed to 'ArmDriver'"], True),
    ],
)  # fmt: skip
def test_changed_functions_of_an_installed_header_are_reported(repository, compare, old, new, expected, is_breaking):
    assert HEADER.count(old) == 1
    repository.commit(FILES)
    repository.write({"a/include/arm/driver.hpp": HEADER.replace(old, new)})
    result = compare(repository)
    assert [sentence for found in result.subjects for sentence in sentences(found)] == expected
    assert bool(breaking(result)) is is_breaking


def test_function_that_moves_to_a_base_class_is_not_removed(repository, compare):
    repository.commit(FILES)
    base = "class Motor {\npublic:\n  void stop();\n};\n"
    text = HEADER.replace("  void stop();\n", "").replace("public Base", "public Motor, public Base")
    repository.commit({"a/include/arm/driver.hpp": text, "a/include/arm/motor.hpp": base})
    assert breaking(compare(repository, "HEAD~1..HEAD")) == []


def test_many_functions_with_other_arguments_are_one_line(repository, compare):
    names = ["open", "close", "move", "hold"]
    lines = "".join(f"  void {name}(int x);\n" for name in names)
    text = f"class Gripper {{\npublic:\n{lines}}};\n"
    repository.commit({**FILES, "a/include/arm/driver.hpp": text})
    repository.write({"a/include/arm/driver.hpp": text.replace("int", "Pose")})
    assert breaking(compare(repository)) == [
        "functions with other arguments: Gripper::open, Gripper::close, Gripper::move, Gripper::hold"
    ]


@pytest.mark.parametrize(
    ("change", "merged"),
    [
        ((" const;", ";"), "functions that are no longer const: "),
        (("bool ", "Result "), "functions with other results: "),
    ],
)
def test_many_functions_with_the_same_other_change_are_one_line(repository, compare, change, merged):
    names = ["open", "close", "move", "hold"]
    lines = "".join(f"  bool {name}(int x) const;\n" for name in names)
    text = f"class Gripper {{\npublic:\n{lines}}};\n"
    repository.commit({**FILES, "a/include/arm/driver.hpp": text})
    repository.write({"a/include/arm/driver.hpp": text.replace(*change).replace("open(int x)", "open(char * x)")})
    assert sorted(breaking(compare(repository))) == [
        "function 'Gripper::open': (int) -> (char*)",
        merged + "Gripper::open, Gripper::close, Gripper::move, Gripper::hold",
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("int rate() const {", "int rate() {", ["function 'Driver::rate': const yes -> no"]),
        ("int rate() const {", "int rate();\n  int rate() const {", []),
        ("void stop();", "void stop() const;", []),
    ],
)
def test_a_function_that_constant_objects_no_longer_have_is_breaking(repository, compare, old, new, expected):
    repository.commit(FILES)
    assert old in HEADER
    repository.write({"a/include/arm/driver.hpp": HEADER.replace(old, new)})
    assert breaking(compare(repository)) == expected


def test_the_definition_of_a_method_behind_its_class_is_no_function_of_its_own(repository, compare):
    text = "#pragma once\nclass Route {\npublic:\n  template <typename T>\n  T get(int id) const;\n};\n"
    definition = "template <typename T>\ninline\nT Route::get(int id) const\n{\n  return T(id);\n}\n"
    repository.commit({**FILES, "a/include/arm/driver.hpp": text + definition})
    repository.write({"a/include/arm/driver.hpp": "#pragma once\nclass Route {\npublic:\n};\n"})
    (line,) = [line for line in breaking(compare(repository)) if "removed" in line]
    assert line == "functions removed: 'Route::get' (int)"


MEMBERS = """#pragma once
class Arm : public Node {
  void f(const std::map<int, double> & a);
  std::vector<std::pair<int, int>> items_;
  double rate_{10.0};
  int n_[3];
};
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("  int n_[3];\n", "  int n_[3];\n  std::shared_ptr<Foo<int>> foo_;\n", "code changed in 'Arm' (added: foo_)"),
        ("items_;\n  double rate_{10.0};\n", "items_;\n", "code changed in 'Arm' (removed: rate_)"),
        ("void f(", "void g(", "code changed in 'Arm' (added: g; removed: f)"),
        ("int n_[3]", "int n_[3], *m_, k_ = f(1, 2)", "code changed in 'Arm' (added: m_, k_)"),
        ("int n_[3]", "long n_[3]", "code changed in 'Arm'"),
    ],
)
def test_a_changed_class_is_told_with_the_members_that_come_and_go(repository, compare, old, new, expected):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/src/arm.hpp": MEMBERS})
    assert old in MEMBERS
    repository.write({"a/src/arm.hpp": MEMBERS.replace(old, new)})
    assert sentences(compare(repository).subjects[0]) == [expected]
