"""The command-line options of programs in the report of a review."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import SourceText
from linkwright.review.sources.cpp_names import read_cpp
from linkwright.review.sources.names import Detail, NameKind, SourceNames
from linkwright.review.sources.python_names import read_python
from tests.review.conftest import breaking

TCLAP = """#include <tclap/CmdLine.h>
TCLAP::CmdLine cmd("lamp", ' ', "1.0");
TCLAP::ValueArg<std::string> frame("f", "frame", "Frame (default: 'map')", false, "map", "map", cmd);
TCLAP::ValueArg<int> level("l", "level", "Level", true, 0, "number", cmd);
int main(int argc, char** argv) {
  auto color = std::make_shared<TCLAP::SwitchArg>("c", "color", "Color", cmd, false);
  TCLAP::SwitchArg dim("d", "dim", "Dim", cmd, true);
  TCLAP::SwitchArg quiet("q", "", "Quiet", cmd);
}
"""
BOOST = """namespace po = boost::program_options;
int main(int argc, char** argv) {
  po::options_description d("lamp");
  d.add_options()
    ("help,h", "show (this)")
    ("frame,f", po::value<std::string>()->default_value("map"), "frame")
    ("level", po::value<int>(&level)->required(), "level");
}
"""
CXXOPTS = """int main(int argc, char** argv) {
  cxxopts::Options options("lamp", "a lamp");
  options.add_options("light")("f,frame", "frame", cxxopts::value<std::string>()->default_value("map"))("d", "dim");
}
"""
CLI11 = """int main(int argc, char** argv) {
  CLI::App app{"lamp"};
  app.add_option("-f,--frame", frame, "frame")->default_val("map");
  app.add_option<int>("--level", level, "level")
    ->required();
  app.add_flag("!--dim", dim, "dim");
  app.add_option("file", file, "positional")->required();
}
"""
ARGPARSE = """int main(int argc, char** argv) {
  argparse::ArgumentParser program("lamp");
  program.add_argument("-f", "--frame").default_value(std::string("map")).help("frame");
  program.add_argument("--level").required();
  program.add_argument("file");
}
"""
GFLAGS = """DEFINE_string(frame, "map", "frame");
DEFINE_bool(dim, false, "dim");
ABSL_FLAG(int, level, 3, "level");
"""
GETOPT = """static struct option names[] = {
  {"frame", required_argument, 0, 'f'}, {"dim", no_argument, &dim, 1}, {0, 0, 0, 0}};
int main(int argc, char** argv) {
  while ((c = getopt_long(argc, argv, ":f:l:", names, 0)) != -1) {}
}
"""


@pytest.mark.parametrize(
    ("text", "options"),
    [
        (TCLAP, {"--frame": '"map"', "--level": "!", "--color": "false", "--dim": "true", "-q": "false"}),
        (BOOST, {"--help": "", "--frame": '"map"', "--level": "!"}),
        (CXXOPTS, {"--frame": '"map"', "-d": ""}),
        (CLI11, {"--frame": '"map"', "--level": "!", "--dim": ""}),
        (ARGPARSE, {"--frame": 'std::string("map")', "--level": "!"}),
        (GFLAGS, {"--frame": '"map"', "--dim": "false", "--level": "3"}),
        (GETOPT, {"-f": "", "-l": "", "--frame": "", "--dim": ""}),
        ('void f() { app.add_option("file", file); menu.add_flag("dim"); getopt(); }', {}),
        ('struct option names[] = {{"frame", 1, 0, 2}};', {}),
    ],
)
def test_options_of_a_program(text, options):
    names = SourceNames()
    read_cpp(SourceText("lamp.cpp", text), names)
    found = {
        item.name: "!" if (Detail.REQUIRED, "yes") in item.details else item.type
        for item in names.of_kind(NameKind.OPTION)
    }
    assert found == options


@pytest.mark.parametrize(
    ("old", "new", "lines"),
    [
        ("frame,f", "base-link,b", ["command-line option '--frame' (\"map\") renamed to '--base-link' (\"map\")"]),
        ("value<int>(&level)->required()", "value<int>(&level)", []),
    ],
)
def test_a_changed_option_is_told_once(repository, compare, old, new, lines):
    repository.commit({"lamp/package.xml": "<package><name>lamp</name></package>", "lamp/lamp.cpp": BOOST})
    repository.write({"lamp/lamp.cpp": BOOST.replace(old, new)})
    result = compare(repository)
    assert breaking(result) == lines
    (subject,) = result.subjects
    assert len(subject.changes) == 1


@pytest.mark.parametrize("names", ['["frame=", "dim"]', "NAMES"])
def test_options_of_getopt_in_python(names):
    source = f'import getopt\nNAMES = ["frame=", "dim"]\noptions, rest = getopt.getopt(argv, "hf:", {names})\n'
    found = SourceNames()
    read_python(SourceText("lamp.py", source), found)
    assert [item.name for item in found.of_kind(NameKind.OPTION)] == ["-h", "-f", "--frame", "--dim"]
